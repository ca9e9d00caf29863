//! Cook's membrane: linear, in plane stress and nearly incompressible, and elastic-plastic at finite strains.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::material::Hardening;
use ssnp155::mesh::SheetMesh;

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Side, Statics, Touching, held, nodes_where, problem, traction, with_time};

/// Displacement upwards of the middle and of the upper corner of the right side, mm, of the panel with `n` x `n`
/// elements, clamped on the left, under a shear stress (MPa) on the right in equal steps.
fn tip(
    world: &SimpleCommunicator,
    (constants, quadrature): (&Constants, Quadrature),
    n: usize,
    (stress, steps): (f64, u32),
) -> Result<[f64; 2]> {
    let side = 2.0 * n as f64;
    let mesh = SheetMesh::new(side, side, n, n).mapped(|[i, j]| {
        let (x, up) = (i / side, j / side);
        [48.0 * x, 44.0 * x + up * (44.0 - 28.0 * x)]
    });
    let mut panel = problem(mesh.clone(), constants, quadrature);
    for node in nodes_where(&mesh, |x| x[0] == 0.0) {
        panel.supports.extend([held(node, 0), held(node, 1)]);
    }
    panel.loads = traction(&mesh, Side::Right, |_| [0.0, stress], &with_time());
    let mut statics = Statics::new(world, panel, Touching::All, 1e-10)?;
    for step in 1..=steps {
        statics.advance(f64::from(step) / f64::from(steps))?;
    }
    let values = statics.values()?;
    let up = |height: f64| {
        let nodes = nodes_where(&mesh, |[x, y]| x == 48.0 && (y - height).abs() < 1e-9);
        nodes.first().map(|node| values[2 * node + 1])
    };
    let found = up(52.0).zip(up(60.0)).ok_or("no node at the tip")?;
    Ok(found.into())
}

pub const LINEAR: Case = Case {
    name: "cook_linear",
    title: "Elements: Cook's membrane, linear",
    text: "A tapered panel, (0, 0), (48, 44), (48, 60), (0, 44) mm, clamped on the left and sheared on the right, so that elements are distorted and the clamped corners singular. The load is reduced until strains are 1e-4. \
First in plane stress, E = 1 and ν = 1/3 under a unit force: in the plane this is plane strain with ν' = ν/(1+ν) and E' = E (1+2ν)/(1+ν)², which the program solves; the reference is the middle of the right side. \
Then nearly incompressible plane strain, ν = 0.4999 and a shear modulus of 0.375; the reference, of the same point, is for ν = 0.499975: the volume changes by 1 - 2ν of a strain at most. \
The singular corner decides on the order, which the theory of smooth solutions does not give: so the reference is met by what 16, 32 and 64 elements a side extrapolate to (Aitken), and each refinement must change less than 2/3 of the one before. Tolerance of the limit: 0.2 %, half a unit of the published digits and ten times that for the extrapolation.",
    quick: true,
    two_ranks: true,
    run: linear,
};

fn linear(world: &SimpleCommunicator) -> Result<Answer> {
    /// Share of the unit force that is applied.
    const SMALL: f64 = 1e-4;
    const STRESS: &str = "Cook 1974; fine meshes: 23.96 (Simo and Rifai 1990)";
    const STRAIN: &str = "fine meshes, extrapolated: 16.4326 (examples of Krysl's FAESOR)";
    let elastic = Constants::elastic();
    let mut rows = Vec::new();
    for (poisson, young, reference, name, source) in [
        (0.25, 0.9375, 23.96, "plane stress", STRESS),
        (0.4999, 0.75 * 1.4999, 16.4326, "ν = 0.4999", STRAIN),
    ] {
        let constants = Constants {
            poisson,
            ..Constants::elastic()
        };
        let load = SMALL * elastic.young / young / 16.0;
        for quadrature in [Quadrature::Reduced, Quadrature::Full] {
            let mut found = [0.0; 3];
            for (n, found) in [16, 32, 64].into_iter().zip(&mut found) {
                *found = tip(world, (&constants, quadrature), n, (load, 1))?[0] / SMALL;
            }
            let [coarse, middle, fine] = found;
            let limit = fine - (fine - middle).powi(2) / (fine - 2.0 * middle + coarse);
            let label = format!("{name}, {quadrature:?} integration");
            rows.push(Row::relative(
                format!("displacement, mm; {label}, extrapolated"),
                limit,
                reference,
                2e-3,
                source,
            ));
            rows.push(Row::absolute(
                format!("change from 32 to 64 over that from 16 to 32 elements; {label}"),
                (fine - middle) / (middle - coarse),
                0.0,
                2.0 / 3.0,
                "convergence",
            ));
        }
    }
    Ok(rows.into())
}

pub const PLASTIC: Case = Case {
    name: "cook_plastic",
    title: "Elements: Cook's membrane, elastic-plastic at finite strains",
    text: "The same panel in plane strain with the material of Simo and Armero: E = 206.9, ν = 0.29, yield stress 0.45 + 0.12924 p + 0.265 (1 - exp(-16.93 p)), here as a table of 400 points, under a force of 5 N per mm. \
Plastic flow is isochoric, and the corner rises by 7 mm, and the whole section yields. There is no closed solution. Published fine meshes of other finite elements end at 6.92 to 6.94 mm (a finite-volume solution, the tutorial of solids4foam, at 7.4, which is not compared); elements, steps and table are not the same there, so tolerance 1 %. \
By itself the solution must converge: from 16 to 32 elements it must change by less than 2/3 of what it does from 8 to 16 (1/4 without the singular corner), and both integrations must meet to 0.5 %. The load has 20 steps.",
    quick: true,
    two_ranks: false,
    run: plastic,
};

fn plastic(world: &SimpleCommunicator) -> Result<Answer> {
    const YOUNG: f64 = 206.9;
    let point = |i: i32| {
        // From 1e-6 to 1.5 in equal ratios, and zero.
        let p = 1e-6 * ((f64::from(i) / 400.0 * 1.5e6_f64.ln()).exp() - 1.0);
        let stress = 0.45 + 0.12924 * p + 0.265 * (1.0 - (-16.93 * p).exp());
        (p + stress / YOUNG, stress)
    };
    let points: Vec<(f64, f64)> = (0..=400).map(point).collect();
    let constants = Constants {
        young: YOUNG,
        poisson: 0.29,
        hardening: Hardening::from_points(&points, YOUNG)?,
    };
    let mut rows = Vec::new();
    let mut finest = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        let found = [8, 16, 32].map(|n| {
            tip(world, (&constants, quadrature), n, (0.3125, 20)).map(|[_, corner]| corner)
        });
        let [a, b, c] = found;
        let (a, b, c) = (a?, b?, c?);
        rows.push(Row::relative(
            format!("displacement of the corner, mm; 32 x 32 elements, {quadrature:?} integration"),
            c,
            6.93,
            1e-2,
            "problem: Simo and Armero 1992; fine meshes: 6.92 to 6.94 (examples of Krysl's FAESOR)",
        ));
        rows.push(Row::absolute(
            format!(
                "change from 16 to 32 over that from 8 to 16 elements, {quadrature:?} integration"
            ),
            (c - b) / (b - a),
            0.0,
            2.0 / 3.0,
            "convergence",
        ));
        finest.push(c);
    }
    rows.push(Row::relative(
        "displacement of the corner, mm; Reduced beside Full integration",
        finest[0],
        finest[1],
        5e-3,
        "the other integration",
    ));
    Ok(rows.into())
}
