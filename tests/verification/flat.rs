//! Contact patch test: uniform pressure between a distorted block and a flat tool.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::system::Factor;

use crate::flow::{Constants, bisect};
use crate::patch::distorted;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{
    Side, Statics, Touching, flat, held, nodes_where, problem, rest_on, traction,
};

pub const PRESSURE: Case = Case {
    name: "contact_patch",
    title: "Contact: patch test with uniform pressure",
    text: "A distorted elastic block with edges of different length rests on a flat tool, under a dead pressure p of 2 % of Young's modulus on its top. \
The weights of the contact points integrate quadratic functions exactly, so every point must carry exactly p, and penetrate by compliance · p; \
the block is strained uniformly, E/(1-ν²) ln λ = -p λ. Tolerance: the convergence of Newton's method.",
    quick: true,
    two_ranks: true,
    run: pressed,
};

fn pressed(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str =
        "patch test of Taylor and Papadopoulos 1991; closed form in Hencky elasticity";
    const COMPLIANCE: f64 = 5e-5;
    let constants = Constants::elastic();
    let pressure = 0.02 * constants.young;
    let strain = bisect(-0.5, 0.0, |e| {
        constants.plane_modulus() * e / e.exp() + pressure
    });
    let ratio = -constants.poisson / (1.0 - constants.poisson);
    let stretch = [(ratio * strain).exp_m1(), strain.exp_m1()];
    let mut rows = Vec::new();
    for (quadrature, points) in [
        (Quadrature::Reduced, 3),
        (Quadrature::Reduced, 6),
        (Quadrature::Full, 6),
        (Quadrature::Reduced, 12),
    ] {
        let mesh = distorted(4, 3)
            .mapped(|[x, y]| [x * (0.7 + 0.1 * x), y])
            .straightened();
        let mut block = problem(mesh.clone(), &constants, quadrature);
        let growing = Factor(vec![(0.0, 0.0), (1.0, 1.0)]);
        block.loads = traction(&mesh, Side::Top, |_| [0.0, -pressure], &growing);
        let on_axis = nodes_where(&mesh, |x| x[0] == 0.0);
        block.supports = on_axis.iter().map(|&n| held(n, 0)).collect();
        rest_on(&mut block, flat(0.0), points);
        block.contact_compliance = COMPLIANCE;
        let mut statics = Statics::new(world, block, Touching::All, 1e-13)?;
        for step in 1..=2 {
            statics.advance(f64::from(step) / 2.0)?;
        }
        let label = format!("{points} points per edge, {quadrature:?} integration");
        let contacts = statics.contacts()?;
        let worst = |value: &dyn Fn(usize) -> f64, count: usize| {
            (0..count).map(|i| value(i).abs()).fold(0.0, f64::max)
        };
        rows.push(Row::absolute(
            format!("largest error of a pressure over p; {label}"),
            worst(&|i| contacts[i].pressure / pressure - 1.0, contacts.len()),
            0.0,
            1e-9,
            SOURCE,
        ));
        let deepest = worst(&|i| contacts[i].gap, contacts.len());
        rows.push(Row::relative(
            format!("largest penetration, mm; {label}"),
            deepest,
            COMPLIANCE * pressure,
            1e-9,
            "compliance · p",
        ));
        let values = statics.values()?;
        let error = |i: usize| {
            let [x, y] = mesh.nodes[i / 2];
            let exact = if i % 2 == 0 {
                stretch[0] * x
            } else {
                stretch[1] * y - COMPLIANCE * pressure
            };
            values[i] - exact
        };
        rows.push(Row::absolute(
            format!("largest error of a displacement, mm; {label}"),
            worst(&error, 2 * mesh.nodes.len()),
            0.0,
            1e-10,
            SOURCE,
        ));
    }
    Ok(rows.into())
}
