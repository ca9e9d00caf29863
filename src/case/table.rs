//! The option table: every option of ours, declared once.
//!
//! Constants of hardening laws are declared with their laws, in `src/material/hardening/`.
//! To add another option: an entry here, a field in `model.rs` with the line in `read.rs` that reads
//! it, a line in `inputs/ssnp155.opts`, and `UPDATE_DOCS=1 cargo test --test case_docs` for docs/options.md.

use std::ops::Bound;
use std::sync::LazyLock;

use super::hardening::{self, Law};
use super::inverse::{OptionalPath, OptionalReal, SoughtList};
use super::kind::{Choice, Flag, Integer, List, Path, Real};
use super::kind_paths::TwoPaths;
use super::kind_resuming::{Restarting, WallTime};
use super::model::Dynamics;
use super::option::{Described, Group, Opt};
use super::sensitivity::Parameters;
use super::tool_file::ToolFile;
use crate::contact::ContactLocation;

/// The value of -hardening_file that means the table compiled into the program.
pub(crate) const BENCHMARK_TABLE: &str = "benchmark";

/// The value of -punch_profile and -die_profile that means the benchmark's own.
pub(crate) const BENCHMARK_TOOL: &str = "benchmark";

fn tool_path(file: &Option<ToolFile>) -> String {
    let path = file.as_ref().map(|file| file.path.clone());
    path.unwrap_or_else(|| BENCHMARK_TOOL.to_owned())
}

macro_rules! option_table {
    ($($option:ident: $kind:ty { $($field:tt)* })*) => {
        $(pub(crate) static $option: Opt<$kind> = Opt { $($field)* };)*
        /// Every option, in the order of the listings: those below, then the constants of the hardening laws.
        pub(crate) static TABLE: LazyLock<Vec<&'static dyn Described>> = LazyLock::new(|| {
            let mut options: Vec<&'static dyn Described> = vec![$(&$option),*];
            options.extend(hardening::constants().map(|constant| constant as &dyn Described));
            options
        });
    };
}

option_table! {
    SHEET_LENGTH: Real {
        name: "sheet_length", unit: "mm", default: "120", group: Group::Sheet, kind: Real::positive(1e5),
        meaning: "Length of the whole sheet; by symmetry half of it is modelled.",
        value: |case| case.sheet.length,
    }
    SHEET_THICKNESS: Real {
        name: "sheet_thickness", unit: "mm", default: "1", group: Group::Sheet, kind: Real::positive(1e5),
        meaning: "Thickness of the sheet.",
        value: |case| case.sheet.thickness,
    }
    SHEET_WIDTH: Real {
        name: "sheet_width", unit: "mm", default: "30", group: Group::Sheet, kind: Real::positive(1e5),
        meaning: "Width of the sheet; the reported force is that of the whole sheet of this width.",
        value: |case| case.sheet.width,
    }
    PUNCH_RADIUS: Real {
        name: "punch_radius", unit: "mm", default: "23.5", group: Group::Tools, kind: Real::positive(1e5),
        meaning: "Radius of the punch; its sides are vertical above the centre of the arc.",
        value: |case| case.tools.punch_radius,
    }
    DIE_RADIUS: Real {
        name: "die_radius", unit: "mm", default: "25", group: Group::Tools, kind: Real::positive(1e5),
        meaning: "Radius of the die's cavity.",
        value: |case| case.tools.die_radius,
    }
    DIE_SHOULDER_RADIUS: Real {
        name: "die_shoulder_radius", unit: "mm", default: "4", group: Group::Tools, kind: Real::positive(1e5),
        meaning: "Radius of the shoulder between the die's cavity and its flat.",
        value: |case| case.tools.die_shoulder_radius,
    }
    PUNCH_PROFILE: Path {
        name: "punch_profile", unit: "", default: BENCHMARK_TOOL, group: Group::Tools, kind: Path,
        meaning: "Outline of the punch, a CSV file with the columns x_mm,y_mm,radius_mm (docs/tools.md), in place of -punch_radius; \
                  the word benchmark means the benchmark's punch.",
        value: |case| tool_path(&case.tools.punch_file),
    }
    DIE_PROFILE: Path {
        name: "die_profile", unit: "", default: BENCHMARK_TOOL, group: Group::Tools, kind: Path,
        meaning: "Outline of the die likewise, in place of -die_radius and -die_shoulder_radius.",
        value: |case| tool_path(&case.tools.die_file),
    }
    STROKE: Real {
        name: "stroke", unit: "mm", default: "28.5", group: Group::Loading, kind: Real::positive(1e5),
        meaning: "Travel of the punch from its first touch of the sheet to the lowest point.",
        value: |case| case.loading.stroke,
    }
    UNLOAD_FRACTION: Real {
        name: "unload_fraction", unit: "", default: "0.1", group: Group::Loading,
        kind: Real(Bound::Included(0.0), Bound::Included(1.0)),
        meaning: "Share of the stroke by which the punch moves back; with 0 the run ends at full stroke.",
        value: |case| case.loading.unload_fraction,
    }
    TIME_LOAD: Real {
        name: "time_load", unit: "ms", default: "900", group: Group::Loading, kind: Real::positive(1e9),
        meaning: "Time in which the punch moves down, at constant speed.",
        value: |case| case.loading.time_load,
    }
    TIME_UNLOAD: Real {
        name: "time_unload", unit: "ms", default: "100", group: Group::Loading, kind: Real::positive(1e9),
        meaning: "Time in which the punch moves back, at constant speed.",
        value: |case| case.loading.time_unload,
    }
    DYNAMICS: Choice<Dynamics> {
        name: "dynamics", unit: "", default: "slow", group: Group::Loading,
        kind: Choice(&[("slow", Dynamics::Slow), ("none", Dynamics::None)]),
        meaning: "With the inertia of the sheet (slow), or static (none).",
        value: |case| case.loading.dynamics,
    }
    YOUNG_MODULUS: Real {
        name: "young_modulus", unit: "MPa", default: "70500", group: Group::Material, kind: Real::positive(1e8),
        meaning: "Young's modulus; the first point of a hardening table must lie on this elastic line.",
        value: |case| case.material.young_modulus,
    }
    POISSON_RATIO: Real {
        name: "poisson_ratio", unit: "", default: "0.342", group: Group::Material,
        kind: Real(Bound::Included(0.0), Bound::Excluded(0.5)),
        meaning: "Poisson's ratio.",
        value: |case| case.material.poisson_ratio,
    }
    DENSITY: Real {
        name: "density", unit: "g/mm3", default: "2.7e-3", group: Group::Material, kind: Real::positive(1e3),
        meaning: "Density; used with -dynamics slow.",
        value: |case| case.material.density,
    }
    HARDENING: Law {
        name: "hardening", unit: "", default: "table", group: Group::Material, kind: Law,
        meaning: "Hardening law: the flow stress sigma against the equivalent plastic strain p. A law's constants begin with \
                  its name; docs/theory.md has the formulas.",
        value: |case| case.material.hardening_law,
    }
    HARDENING_FILE: Path {
        name: "hardening_file", unit: "", default: BENCHMARK_TABLE, group: Group::Material, kind: Path,
        meaning: "With -hardening table: table of total logarithmic strain and true stress in MPa; the word benchmark \
                  means the benchmark's own table, which is part of the program.",
        value: |case| case.material.hardening_file.clone(),
    }
    FRICTION_COEFFICIENT: Real {
        name: "friction_coefficient", unit: "", default: "0", group: Group::Friction,
        kind: Real(Bound::Included(0.0), Bound::Included(10.0)),
        meaning: "Coulomb's coefficient of friction between sheet and tools; 0.1342 in the benchmark with friction.",
        value: |case| case.friction.coefficient,
    }
    FRICTION_COMPLIANCE: Real {
        name: "friction_compliance", unit: "mm/MPa", default: "5e-4", group: Group::Friction,
        kind: Real::positive(1.0),
        meaning: "Elastic slip per friction traction: how far a sticking point moves along the tool.",
        value: |case| case.friction.compliance,
    }
    SHEET_NX: Integer {
        name: "sheet_nx", unit: "", default: "170", group: Group::Discretisation, kind: Integer(1, 10_000),
        meaning: "Elements along half the sheet.",
        value: |case| case.discretisation.nx,
    }
    SHEET_NY: Integer {
        name: "sheet_ny", unit: "", default: "5", group: Group::Discretisation, kind: Integer(1, 500),
        meaning: "Elements through the thickness.",
        value: |case| case.discretisation.ny,
    }
    QUADRATURE: Choice<usize> {
        name: "quadrature", unit: "", default: "2", group: Group::Discretisation, kind: Choice(&[("2", 2), ("3", 3)]),
        meaning: "Gauss points per direction in an element; 2 is reduced integration of the quadratic element.",
        value: |case| case.discretisation.points_along,
    }
    QUADRATURE_THICKNESS: Choice<Option<usize>> {
        name: "quadrature_thickness", unit: "", default: "same", group: Group::Discretisation,
        kind: Choice(&[
            ("same", None),
            ("2", Some(2)),
            ("3", Some(3)),
            ("4", Some(4)),
            ("5", Some(5)),
            ("7", Some(7)),
            ("10", Some(10)),
            ("15", Some(15)),
        ]),
        meaning: "Gauss points through the thickness in an element, in place of -quadrature's: more of them see better where the bent \
                  sheet begins to yield, which decides the angle after release.",
        value: |case| case.discretisation.points_through,
    }
    CONTACT_LOCATION: Choice<ContactLocation> {
        name: "contact_location", unit: "", default: "points", group: Group::Discretisation,
        kind: Choice(&[
            ("points", ContactLocation::Points),
            ("nodes", ContactLocation::Nodes),
            ("closest", ContactLocation::Closest),
        ]),
        meaning: "Contact at -contact_points_per_edge equally spaced points, at the nodes, or where each edge is closest to \
                  the tool; docs/contact.md compares them.",
        value: |case| case.discretisation.contact_location,
    }
    CONTACT_POINTS_PER_EDGE: Integer {
        name: "contact_points_per_edge", unit: "", default: "6", group: Group::Discretisation, kind: Integer(1, 24),
        meaning: "Contact points on each element edge of the sheet's surfaces; too few make the force a saw-tooth. With \
                  -contact_location points.",
        value: |case| case.discretisation.contact_points_per_edge,
    }
    CONTACT_COMPLIANCE: Real {
        name: "contact_compliance", unit: "mm/MPa", default: "5e-5", group: Group::Discretisation,
        kind: Real::positive(1.0),
        meaning: "Compliance of the tools' surface: how far it yields elastically per contact pressure; 5e-5 is a stiffness of 2e4 MPa/mm.",
        value: |case| case.discretisation.contact_compliance,
    }
    PENETRATION_LIMIT: Real {
        name: "penetration_limit", unit: "mm", default: "5e-3", group: Group::Discretisation,
        kind: Real::positive(1e5),
        meaning: "Deepest penetration, at the contact points and between them, that the verdict accepts.",
        value: |case| case.discretisation.penetration_limit,
    }
    DT_INITIAL: Real {
        name: "dt_initial", unit: "ms", default: "1", group: Group::Stepping, kind: Real::positive(1e9),
        meaning: "First time step.",
        value: |case| case.stepping.dt_initial,
    }
    DT_MIN: Real {
        name: "dt_min", unit: "ms", default: "1e-6", group: Group::Stepping, kind: Real::positive(1e9),
        meaning: "The run fails when a step would have to be shorter than this.",
        value: |case| case.stepping.dt_min,
    }
    DT_MAX: Real {
        name: "dt_max", unit: "ms", default: "9", group: Group::Stepping, kind: Real::positive(1e9),
        meaning: "Longest time step.",
        value: |case| case.stepping.dt_max,
    }
    FIXED_STEPS_LOAD: Integer {
        name: "fixed_steps_load", unit: "", default: "0", group: Group::Stepping, kind: Integer(0, 1_000_000),
        meaning: "Number of equal steps down; a step is shortened only where its solve is refused or a value is reported. \
                  With 0 the steps grow and shrink.",
        value: |case| case.stepping.fixed_steps_load,
    }
    FIXED_STEPS_UNLOAD: Integer {
        name: "fixed_steps_unload", unit: "", default: "0", group: Group::Stepping, kind: Integer(0, 1_000_000),
        meaning: "The same for the travel back.",
        value: |case| case.stepping.fixed_steps_unload,
    }
    REPORT_STROKES: List {
        name: "report_strokes", unit: "mm", default: "1,2,5,8,10,12,15,16,18,20,22,24,26,28", group: Group::Stepping,
        kind: List(1e5),
        meaning: "Travels of the punch, going down, at which a step ends exactly; those beyond the stroke are left out.",
        value: |case| case.stepping.report_strokes.clone(),
    }
    REPORT_RETURNS: List {
        name: "report_returns", unit: "mm", default: "none", group: Group::Stepping, kind: List(1e5),
        meaning: "Travels of the punch, going back, at which a step ends exactly; those beyond the way back are left out.",
        value: |case| case.stepping.report_returns.clone(),
    }
    EXTRAPOLATE: Flag {
        name: "extrapolate", unit: "", default: "true", group: Group::Stepping, kind: Flag,
        meaning: "Start each Newton solve from displacements and contact extrapolated from the last steps.",
        value: |case| case.stepping.extrapolate,
    }
    NEWTON_TOLERANCE: Real {
        name: "newton_tolerance", unit: "mm", default: "1e-9", group: Group::Stepping, kind: Real::positive(1e-3),
        meaning: "Newton stops when the norm of the scaled residual (forces divided by Young's modulus) is below this.",
        value: |case| case.stepping.newton_tolerance,
    }
    NEWTON_MAX_ITERATIONS: Integer {
        name: "newton_max_iterations", unit: "", default: "20", group: Group::Stepping, kind: Integer(1, 1000),
        meaning: "A solve that needs more iterations is refused and repeated with a shorter step.",
        value: |case| case.stepping.newton_max_iterations,
    }
    MONITOR_ITERATIONS: Flag {
        name: "monitor_iterations", unit: "", default: "false", group: Group::Output, kind: Flag,
        meaning: "Shows every Newton iteration: residual norm, points in contact and how many of them changed.",
        value: |case| case.output.iterations,
    }
    DRY_RUN: Flag {
        name: "dry_run", unit: "", default: "false", group: Group::Output, kind: Flag,
        meaning: "Shows the model (sizes, steps, unknowns, memory, shares of the ranks), draws it as model.svg, and solves \
                  nothing.",
        value: |case| case.output.dry_run,
    }
    QUIET: Flag {
        name: "quiet", unit: "", default: "false", group: Group::Output, kind: Flag,
        meaning: "Shows only warnings, the verdicts and the last words; run.log has all.",
        value: |case| case.output.quiet,
    }
    COMPARE: TwoPaths {
        name: "compare", unit: "", default: "none", group: Group::Output, kind: TwoPaths,
        meaning: "Runs nothing, and puts two runs side by side: the page comparison.html in -output_dir, from the summary.json and \
                  history.csv of their output folders.",
        value: |case| case.output.compare.clone(),
    }
    OUTPUT_DIR: Path {
        name: "output_dir", unit: "", default: "results", group: Group::Output, kind: Path,
        meaning: "Directory for everything the run writes; made if it is missing.",
        value: |case| case.output.dir.clone(),
    }
    OUTPUT_EVERY: Integer {
        name: "output_every", unit: "", default: "1", group: Group::Output, kind: Integer(0, 1_000_000),
        meaning: "Number of accepted steps from one saving of the fields to the next; 0 saves them at the ends of loading and unloading only.",
        value: |case| case.output.every,
    }
    SENSITIVITY: Parameters {
        name: "sensitivity", unit: "", default: "none", group: Group::Output, kind: Parameters,
        meaning: "Parameters by which the run is differentiated: the derivatives of force, angle and displacement go to \
                  sensitivity.csv.",
        value: |case| case.output.sensitivity.clone(),
    }
    CHECKPOINT_EVERY: Integer {
        name: "checkpoint_every", unit: "", default: "0", group: Group::Resuming, kind: Integer(0, 1_000_000),
        meaning: "Number of accepted steps from one checkpoint to the next; 0 counts no steps.",
        value: |case| case.resuming.checkpoint_every,
    }
    CHECKPOINT_MINUTES: Real {
        name: "checkpoint_minutes", unit: "min", default: "10", group: Group::Resuming,
        kind: Real(Bound::Included(0.0), Bound::Included(1e6)),
        meaning: "Time on the clock from one checkpoint to the next; 0 does not look at the clock.",
        value: |case| case.resuming.checkpoint_minutes,
    }
    WALL_LIMIT: WallTime {
        name: "wall_limit", unit: "", default: "none", group: Group::Resuming, kind: WallTime,
        meaning: "Time on the clock before which the run writes a checkpoint and ends.",
        value: |case| case.resuming.wall_limit,
    }
    RESTART: Restarting {
        name: "restart", unit: "", default: "no", group: Group::Resuming, kind: Restarting,
        meaning: "Resumes from the newest checkpoint in -output_dir (newest, or no value), or from the one with this path.",
        value: |case| case.resuming.restart.clone(),
    }
    OVERWRITE: Flag {
        name: "overwrite", unit: "", default: "false", group: Group::Resuming, kind: Flag,
        meaning: "Replaces an interrupted run in -output_dir and its checkpoints, which is refused otherwise.",
        value: |case| case.resuming.overwrite,
    }
    IDENTIFY: OptionalPath {
        name: "identify", unit: "", default: "none", group: Group::Inverse, kind: OptionalPath,
        meaning: "Measured force against stroke, a CSV file with the columns stroke_mm,force_N,uncertainty_N: -parameters are \
                  identified from it; docs/identification.md.",
        value: |case| case.inverse.identify.clone(),
    }
    DESIGN: OptionalReal {
        name: "design", unit: "", default: "none", group: Group::Inverse,
        kind: OptionalReal(Real(Bound::Excluded(0.0), Bound::Excluded(180.0))),
        meaning: "Wanted angle between the arms in degrees after the punch is withdrawn: -parameters are changed until the sheet has it; \
                  docs/identification.md.",
        value: |case| case.inverse.design,
    }
    PARAMETERS: SoughtList {
        name: "parameters", unit: "", default: "none", group: Group::Inverse, kind: SoughtList,
        meaning: "What -identify or -design may change, and between what; the search starts from the values of these options.",
        value: |case| case.inverse.parameters.clone(),
    }
    MOST_RUNS: Integer {
        name: "most_runs", unit: "", default: "15", group: Group::Inverse, kind: Integer(1, 999),
        meaning: "Runs after which -identify or -design gives up.",
        value: |case| case.inverse.most_runs,
    }
    DESIGN_TOLERANCE: Real {
        name: "design_tolerance", unit: "deg", default: "0.05", group: Group::Inverse, kind: Real::positive(10.0),
        meaning: "How far the angle of a design may be from the wanted one.",
        value: |case| case.inverse.tolerance,
    }
    DESIGN_REFINEMENT: Integer {
        name: "design_refinement", unit: "", default: "2", group: Group::Inverse, kind: Integer(1, 8),
        meaning: "A found design is run again, and corrected, with this number of elements in the place of each, in both \
                  directions; 1 leaves this out.",
        value: |case| case.inverse.refinement,
    }
}
