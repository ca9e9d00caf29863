//! Cantilevers: plane elasticity at small, the elastica at large deflections.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::Factor;

use crate::flow::{Constants, bisect, runge_kutta};
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Side, Statics, Touching, growing, held, nodes_where, problem, traction};

pub const CANTILEVER: Case = Case {
    name: "beam_cantilever",
    title: "Elements: cantilever under an end load",
    text: "10 x 1 mm, plane strain, strains of 1e-6. The root follows the displacements of the exact plane solution and the end carries its parabolic shear stress, \
so the tip's deflection is exact, shear included. Beside it the Euler-Bernoulli value with E/(1-ν²), which neglects shear: \
its difference from the exact one, 0.9 %, is not ours. Tolerance: the discretisation with one element (2e-3) and four (1e-4) through the depth.",
    quick: true,
    two_ranks: true,
    run: cantilever,
};

fn cantilever(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Timoshenko and Goodier 1970, article 21; Augarde and Deeks 2008";
    const LENGTH: f64 = 10.0;
    const DEPTH: f64 = 1.0;
    let constants = Constants::elastic();
    let young = constants.plane_modulus();
    let nu = constants.poisson / (1.0 - constants.poisson);
    let inertia = DEPTH.powi(3) / 12.0;
    // The largest strain is load · length · depth / (2 E I).
    let load = 1e-6 * young * inertia / (LENGTH * 0.5 * DEPTH);
    let bending = load / (6.0 * young * inertia);
    let exact = |x: f64, y: f64| {
        [
            bending
                * y
                * ((6.0 * LENGTH - 3.0 * x) * x + (2.0 + nu) * (y * y - 0.25 * DEPTH * DEPTH)),
            -bending
                * (3.0 * nu * y * y * (LENGTH - x)
                    + (4.0 + 5.0 * nu) * 0.25 * DEPTH * DEPTH * x
                    + (3.0 * LENGTH - x) * x * x),
        ]
    };
    let mut rows = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        for (nx, ny, tolerance) in [(10, 1, 2e-3), (40, 4, 1e-4)] {
            let mesh = SheetMesh::new(LENGTH, DEPTH, nx, ny);
            let mut model = problem(mesh.clone(), &constants, quadrature);
            let shear = |[_, y]: [f64; 2]| {
                let y = y - 0.5 * DEPTH;
                [
                    0.0,
                    -load / (2.0 * inertia) * (0.25 * DEPTH * DEPTH - y * y),
                ]
            };
            let always = Factor(vec![(0.0, 1.0)]);
            model.loads = traction(&mesh, Side::Right, shear, &always);
            for node in nodes_where(&mesh, |x| x[0] == 0.0) {
                let u = exact(0.0, mesh.nodes[node][1] - 0.5 * DEPTH);
                model.supports.push(growing(node, 0, u[0]));
                model.supports.push(growing(node, 1, u[1]));
            }
            let mut statics = Statics::new(world, model, Touching::All, 1e-14)?;
            statics.advance(1.0)?;
            let tip = nodes_where(&mesh, |x| x[0] == LENGTH && x[1] == 0.5 * DEPTH)
                .first()
                .copied()
                .ok_or("no node at the tip")?;
            let deflection = statics.displacement(tip)?[1];
            let quantity =
                format!("tip deflection, mm; {nx} x {ny} elements, {quadrature:?} integration");
            let expected = exact(LENGTH, 0.0)[1];
            rows.push(Row::relative(
                quantity, deflection, expected, tolerance, SOURCE,
            ));
            if (ny, quadrature) == (4, Quadrature::Reduced) {
                rows.push(Row::relative(
                    "tip deflection, mm; the same",
                    deflection,
                    -load * LENGTH.powi(3) / (3.0 * young * inertia),
                    1e-2,
                    "Euler-Bernoulli: P L³ / (3 E' I), without shear",
                ));
            }
        }
    }
    Ok(rows.into())
}

pub const ELASTICA: Case = Case {
    name: "beam_elastica",
    title: "Elements: large deflections of a thin strip",
    text: "Cantilever of 100 x 1 mm, elastic, with a dead end load P up to P L²/(E' I) = 10; 50 x 1 elements. The reference is the inextensible elastica, solved by shooting \
(it meets the published 0.3017, 0.4935 and 0.8106 L). Neglected there: stretch and shear, of the order (h/L)² times the load, up to 1e-3. Tolerance: that.",
    quick: true,
    two_ranks: true,
    run: elastica,
};

/// Deflection and shortening of the tip over the length, for α = P L² / (E' I):
/// θ'' = -α cos θ, θ(0) = 0, θ'(1) = 0.
fn tip_of_elastica(load: f64) -> [f64; 2] {
    // State: angle, curvature, x, y along the strip of length one.
    let shoot = |curvature: f64| {
        let mut state = [0.0, curvature, 0.0, 0.0];
        for _ in 0..2000 {
            state = runge_kutta(&state, 1.0 / 2000.0, |s| {
                [s[1], -load * s[0].cos(), s[0].cos(), s[0].sin()]
            });
        }
        state
    };
    let curvature = bisect(0.0, load, |c| shoot(c)[1]);
    let [_, _, x, y] = shoot(curvature);
    [y, 1.0 - x]
}

fn elastica(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Bisshopp and Drucker 1945, solved by shooting";
    const LENGTH: f64 = 100.0;
    let constants = Constants::elastic();
    let unit = constants.plane_modulus() / 12.0 / (LENGTH * LENGTH);
    let mesh = SheetMesh::new(LENGTH, 1.0, 50, 1);
    let mut model = problem(mesh.clone(), &constants, Quadrature::Reduced);
    let growing = Factor(vec![(0.0, 0.0), (10.0, 10.0)]);
    model.loads = traction(&mesh, Side::Right, |_| [0.0, unit], &growing);
    let root = nodes_where(&mesh, |x| x[0] == 0.0);
    model.supports = root.iter().map(|&n| held(n, 0)).collect();
    model.supports.push(held(root[root.len() / 2], 1));
    let tip = nodes_where(&mesh, |x| x == [LENGTH, 0.5])[0];
    let mut statics = Statics::new(world, model, Touching::All, 1e-11)?;
    let mut rows = Vec::new();
    for step in 1..=20 {
        let load = 0.5 * f64::from(step);
        statics.advance(load)?;
        if [1.0, 2.0, 10.0].contains(&load) {
            let [y, shortening] = tip_of_elastica(load);
            let [ux, uy] = statics.displacement(tip)?;
            for (name, ours, exact) in [
                ("deflection", uy / LENGTH, y),
                ("shortening", -ux / LENGTH, shortening),
            ] {
                let quantity = format!("{name} of the tip over the length at P L²/(E' I) = {load}");
                rows.push(Row::relative(quantity, ours, exact, 1e-3, SOURCE));
            }
        }
    }
    Ok(rows.into())
}
