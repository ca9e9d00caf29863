//! `-dry_run`: says what would be solved, draws it, and stops.

use std::io::stdout;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::error::RunError;
use super::recorder;
use super::step_size::landmarks;
use crate::case::{Case, CaseError, Dynamics, ToolFile};
use crate::contact::ContactLocation;
use crate::output::monitor::Monitor;
use crate::output::{OutputDir, plot};
use crate::system::{Problem, SubdomainSize, System};
use crate::text::{COLUMNS, number, wrapped};

/// Memory of a rank without any unknowns, alone and among others, and for n log2 n with n the unknowns it owns (the
/// factors of a plane mesh grow so), bytes: fitted to the peaks of resident memory of short runs with 3 924, 9 882,
/// 29 962 and 100 722 unknowns on one rank (71, 99, 212 and 669 MB: 5 % off at most), and of 9 882 on 2 and 4 ranks and
/// 100 722 on 2 (83, 75 and 373 MB per rank: 7 % off at most).
const MEMORY_ALONE: f64 = 50e6;
const MEMORY_AMONG_OTHERS: f64 = 60e6;
const MEMORY_PER_UNKNOWN: f64 = 372.0;

/// Columns of the names of what is said.
const LABEL: usize = 12;

/// Shows the model and draws it as `model.svg` and `.png`; nothing else is written. Collective.
///
/// # Errors
/// If the mesh cannot be split or the sketch not be written.
pub(super) fn describe(case: &Case, comm: &SimpleCommunicator) -> Result<(), RunError> {
    let system = System::new(Problem::new(case), comm.duplicate())?;
    let folder = OutputDir::create(&case.output.dir, comm)?;
    if comm.rank() == 0 {
        let [die, punch] = recorder::right_halves([Some(&case.die()), Some(&case.punch())]);
        plot::model(folder.model_figure(), case, &die, &punch)?;
    }
    let shares = SubdomainSize::of_all(&system);
    let tools = tools(case)?;
    let mut text = String::from("dry run: the model, nothing is solved\n\n");
    for (name, value) in facts(case, tools, &system, &shares, &landmarks(case)?) {
        for (index, line) in wrapped(&value, COLUMNS - LABEL - 2).iter().enumerate() {
            let name = if index == 0 { name } else { "" };
            text.push_str(&format!("{name:<LABEL$}  {line}\n"));
        }
    }
    text.push_str(&table(&shares));
    text.push_str(&format!(
        "\nsketch        {}\n",
        folder.model_figure().display()
    ));
    Monitor::new(comm.rank(), stdout(), case.loading.motion()).show(&text);
    Ok(())
}

/// A line of the description: what it is about, and what is to be said.
type Fact = (&'static str, String);

fn facts(
    case: &Case,
    tools: Vec<Fact>,
    system: &System,
    shares: &[SubdomainSize],
    landmarks: &[f64],
) -> Vec<Fact> {
    let mut facts = vec![sheet(case)];
    facts.extend(tools);
    facts.extend(material(case));
    facts.push(("loading", loading(case)));
    facts.push(("steps", steps(case, landmarks)));
    let points = shares.iter().map(|share| share.contact_points).sum();
    facts.push(("contact", contact(case, points)));
    facts.push(("friction", friction(case)));
    facts.extend(mesh(case, system));
    facts.push(("memory", memory(shares)));
    let end = number(case.loading.motion().end());
    facts.push(("ends at", format!("t = {end} ms")));
    facts
}

fn sheet(case: &Case) -> Fact {
    let sheet = &case.sheet;
    let text = format!(
        "{} x {} x {} mm; its right half is modelled, in plane strain",
        sheet.length, sheet.thickness, sheet.width
    );
    ("sheet", text)
}

fn tools(case: &Case) -> Result<Vec<Fact>, CaseError> {
    let tools = &case.tools;
    let half_length = case.sheet.half_length();
    let punch = match &tools.punch_file {
        Some(file) => {
            let touch = file.outline.first_touch(half_length);
            format!("{}, touches first {}", from_file(file), along(touch.x))
        }
        None => format!(
            "radius {} mm, touches first at (0, {}) mm",
            tools.punch_radius, case.sheet.thickness
        ),
    };
    let die = match &tools.die_file {
        Some(file) => {
            let touch = file.outline.first_touch(half_length);
            format!("{}, holds the sheet {}", from_file(file), along(touch.x))
        }
        None => format!(
            "cavity of radius {} mm, shoulder of radius {} mm, flat from x = {} mm on, {} mm deep",
            tools.die_radius,
            tools.die_shoulder_radius,
            tools.die_edge(),
            tools.die_edge()
        ),
    };
    let clearance = if tools.from_file() {
        let least = case.least_gap()?;
        format!(
            "at least {:.3} mm between the tools for a sheet of {} mm, at a stroke of {} mm at ({:.3}, {:.3}) mm",
            least.gap,
            case.sheet.thickness,
            number(least.stroke),
            least.at[0],
            least.at[1]
        )
    } else {
        format!(
            "{} mm between punch and cavity for a sheet of {} mm",
            number(tools.die_radius - tools.punch_radius),
            case.sheet.thickness
        )
    };
    Ok(vec![
        ("punch", punch),
        ("die", die),
        ("clearance", clearance),
    ])
}

/// What a file says about its tool.
fn from_file(file: &ToolFile) -> String {
    let corners = file.outline.corners().len();
    let out = file.outline.bends().iter().filter(|bend| bend.turn > 0.0);
    let sharpest = out.map(|bend| bend.radius).fold(f64::INFINITY, f64::min);
    let convex = match sharpest {
        f64::INFINITY => "none of them sticks out".to_owned(),
        0.0 => "one that sticks out is sharp".to_owned(),
        radius => format!("sharpest radius that sticks out {} mm", number(radius)),
    };
    format!("{corners} corners of {}, {convex}", file.path)
}

fn along([from, to]: [f64; 2]) -> String {
    if from == to {
        format!("at x = {} mm", number(from))
    } else {
        format!("from x = {} to {} mm", number(from), number(to))
    }
}

fn material(case: &Case) -> [Fact; 2] {
    let material = &case.material;
    let yields = |p: f64| format!("{:.1}", material.hardening.yield_stress(p).0);
    [
        (
            "material",
            format!(
                "E = {} MPa, Poisson's ratio {}, density {} g/mm3",
                number(material.young_modulus),
                material.poisson_ratio,
                material.density
            ),
        ),
        (
            "hardening",
            format!(
                "{}; yields at {} MPa, at {} after 5 %, {} after 20 %",
                material.hardening_in_words(),
                number(material.hardening.initial()),
                yields(0.05),
                yields(0.2)
            ),
        ),
    ]
}

fn loading(case: &Case) -> String {
    let loading = &case.loading;
    let back = if loading.unload_fraction > 0.0 {
        format!(
            ", back by {} mm in {} ms",
            number(loading.unload_fraction * loading.stroke),
            loading.time_unload
        )
    } else {
        String::new()
    };
    let kind = match loading.dynamics {
        Dynamics::Slow => "with inertia",
        Dynamics::None => "static",
    };
    format!(
        "down by {} mm in {} ms{back}; {kind}",
        loading.stroke, loading.time_load
    )
}

fn steps(case: &Case, landmarks: &[f64]) -> String {
    let stepping = &case.stepping;
    format!(
        "first {} ms, then {} to {} ms; {} times are hit exactly, so there are at least {} steps",
        number(stepping.dt_initial),
        number(stepping.dt_min),
        number(stepping.dt_max),
        landmarks.len(),
        least_steps(landmarks, stepping.dt_max)
    )
}

fn contact(case: &Case, points: usize) -> String {
    let (sizes, spacing) = (&case.discretisation, number(case.contact_spacing()));
    let places = match sizes.contact_location {
        ContactLocation::Points => {
            let per_edge = sizes.contact_points_per_edge;
            format!("{per_edge} per edge, {spacing} mm apart")
        }
        ContactLocation::Nodes => format!("at the nodes, {spacing} mm apart"),
        ContactLocation::Closest => "one per edge that moves along it".to_owned(),
    };
    let compliance = sizes.contact_compliance;
    format!("{points} points on both faces, {places}; compliance {compliance} mm/MPa")
}

fn friction(case: &Case) -> String {
    let friction = &case.friction;
    if friction.coefficient > 0.0 {
        format!(
            "coefficient {}, elastic slip {} mm/MPa",
            friction.coefficient, friction.compliance
        )
    } else {
        "none".to_owned()
    }
}

fn mesh(case: &Case, system: &System) -> [Fact; 2] {
    let problem = system.local().problem();
    let mesh = &problem.mesh;
    let displacements = 2 * mesh.nodes.len();
    [
        (
            "mesh",
            format!(
                "{} x {} = {} elements of {} x {} mm, {} nodes, {} Gauss points",
                mesh.nx,
                mesh.ny,
                mesh.elements.len(),
                number(case.element_length()),
                number(case.sheet.thickness / mesh.ny as f64),
                mesh.nodes.len(),
                problem.quadrature.point_count() * mesh.elements.len()
            ),
        ),
        (
            "unknowns",
            format!(
                "{}: {displacements} displacements, {} of contact",
                system.unknown_count(),
                system.unknown_count() - displacements
            ),
        ),
    ]
}

fn memory(shares: &[SubdomainSize]) -> String {
    let (least, ranks) = match shares.len() {
        1 => (MEMORY_ALONE, "1 rank".to_owned()),
        ranks => (MEMORY_AMONG_OTHERS, format!("{ranks} ranks together")),
    };
    let of = |share: &SubdomainSize| {
        let unknowns = share.unknowns.max(2) as f64;
        (least + MEMORY_PER_UNKNOWN * unknowns * unknowns.log2()) / 1e6
    };
    let sum: f64 = shares.iter().map(of).sum();
    format!("about {sum:.0} MB on {ranks} (peak of resident memory; measured runs lie within 10 %)")
}

/// The number of steps of at most `longest` (ms) that hit all of these times.
fn least_steps(landmarks: &[f64], longest: f64) -> usize {
    let starts = std::iter::once(&0.0).chain(landmarks);
    let pieces = starts.zip(landmarks).map(|(start, end)| end - start);
    pieces
        .map(|length| (length / longest - 1e-9).ceil().max(1.0) as usize)
        .sum()
}

fn table(shares: &[SubdomainSize]) -> String {
    let mut text = format!(
        "\n{:>6}{:>10}{:>8}{:>14}{:>16}{:>10}\n",
        "rank", "elements", "nodes", "shared nodes", "contact points", "unknowns"
    );
    for (rank, share) in shares.iter().enumerate() {
        text.push_str(&format!(
            "{rank:>6}{:>10}{:>8}{:>14}{:>16}{:>10}\n",
            share.elements, share.nodes, share.shared_nodes, share.contact_points, share.unknowns
        ));
    }
    text
}
