//! Blocks on a flat tool with friction: stick, slip and reversal.

use mpi::topology::SimpleCommunicator;
use ssnp155::contact::{ContactLocation, ContactRule};
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::{Factor, NodalValue, Problem};

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Side, Statics, Touching, flat, nodes_where, problem, rest_on, traction};

const PRESSURE: f64 = 100.0;
/// Contact points per edge.
const POINTS: usize = 6;
const CONTACT_COMPLIANCE: f64 = 5e-5;

/// Elastic and without lateral strain, so that the pressure alone leaves no friction behind.
fn without_poisson() -> Constants {
    Constants {
        poisson: 0.0,
        ..Constants::elastic()
    }
}

/// A block of `length` x 1 mm under PRESSURE from time 1 on, its nodes `pushed` moved in x by the factor.
fn block(mesh: &SheetMesh, friction: (f64, f64), pushed: &[usize], path: &[(f64, f64)]) -> Problem {
    let constants = without_poisson();
    let mut block = problem(mesh.clone(), &constants, Quadrature::Reduced);
    let press = Factor(vec![(0.0, 0.0), (1.0, 1.0)]);
    block.loads = traction(mesh, Side::Top, |_| [0.0, -PRESSURE], &press);
    block.supports = pushed
        .iter()
        .map(|&node| NodalValue {
            node,
            component: 0,
            value: 1.0,
            factor: Factor(path.to_vec()),
        })
        .collect();
    rest_on(&mut block, flat(0.0), POINTS);
    block.contact_compliance = CONTACT_COMPLIANCE;
    (block.friction_coefficient, block.friction_compliance) = friction;
    block
}

pub const RIGID: Case = Case {
    name: "friction_cycle",
    title: "Contact: stick, slip and reversal of a block that does not deform along the tool",
    text: "A block under a uniform pressure p = 100 MPa, all its nodes moved along the tool: 0 → 0.01 → -0.01 → 0.01 mm in steps of 0.001 mm. The friction traction is that of a spring \
of the friction compliance (1e-4 mm/MPa) with a slider at μ p = 30 MPa in series: stick up to 0.003 mm, 0.006 mm after a reversal. Tolerance: the convergence of Newton's method.",
    quick: true,
    two_ranks: true,
    run: cycle,
};

fn cycle(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "spring and slider in series (Simo and Laursen 1992), closed form";
    const FRICTION: (f64, f64) = (0.3, 1e-4);
    const LENGTH: f64 = 4.0;
    let mesh = SheetMesh::new(LENGTH, 1.0, 4, 2);
    let all: Vec<usize> = (0..mesh.nodes.len()).collect();
    let path = [(1.0, 0.0), (11.0, 0.01), (31.0, -0.01), (51.0, 0.01)];
    let model = block(&mesh, FRICTION, &all, &path);
    let mut statics = Statics::new(world, model, Touching::All, 1e-13)?;
    statics.advance(1.0)?;
    let limit = FRICTION.0 * PRESSURE;
    let moved = Factor(path.to_vec());
    let (mut exact, mut worst, mut wrong) = (0.0_f64, 0.0_f64, 0.0);
    let mut marks = Vec::new();
    for step in 1..=50 {
        let t = 1.0 + f64::from(step);
        statics.advance(t)?;
        exact = (exact - (moved.at(t) - moved.at(t - 1.0)) / FRICTION.1).clamp(-limit, limit);
        let points = statics.contacts()?;
        for point in &points {
            worst = worst.max((point.friction - exact).abs());
            let slips = exact.abs() > limit * (1.0 - 1e-9);
            wrong += f64::from(u8::from(point.state.slips() != slips));
        }
        if [2, 10, 11, 30, 31, 50].contains(&step) {
            let quantity = format!(
                "friction traction on the block at {:.3} mm, step {step}, MPa",
                moved.at(t)
            );
            marks.push(Row::absolute(
                quantity,
                points[0].friction,
                exact,
                1e-9,
                SOURCE,
            ));
        }
    }
    let stick = limit * FRICTION.1;
    // Each reversal begins with a branch from one limit to the other, whose work is zero.
    let friction_work = limit * (0.5 * stick + (0.01 - stick) + 2.0 * (0.02 - 2.0 * stick));
    let work = LENGTH * (friction_work + 0.5 * CONTACT_COMPLIANCE * PRESSURE * PRESSURE);
    let mut rows = marks;
    rows.extend([
        Row::absolute(
            "largest error of a friction traction, MPa",
            worst,
            0.0,
            1e-9,
            SOURCE,
        ),
        Row::absolute(
            "points with the wrong state of slip",
            wrong,
            0.0,
            0.0,
            SOURCE,
        ),
        Row::relative(
            "work of friction and of the contact compliance, mJ per mm",
            statics.measures()?.contact_energy(),
            work,
            1e-9,
            SOURCE,
        ),
    ]);
    Ok(rows.into())
}

pub const DEFORMABLE: Case = Case {
    name: "friction_block",
    title: "Contact: an elastic bar pushed along a tool",
    text: "A bar of 40 x 1 mm without lateral strain (ν = 0) under a uniform pressure, pushed at its left face. First slip spreads from there: with the shear-lag length λ = √(E' h ε) of the friction compliance ε, a slip zone of length s \
needs the force T = μ p (s + λ) and the push u = μ p (ε + λ s/(E' h) + s²/(2 E' h)). The bar theory neglects the bar's shear (h/(3G) beside ε, 1.3 %) and its tilting moment (μ h/2 beside s, 0.25 %); tolerance 1 %. \
Then all of it slips and the push must be μ times the load, in both directions; tolerance: the convergence of Newton's method.",
    quick: true,
    two_ranks: true,
    run: bar,
};

fn bar(world: &SimpleCommunicator) -> Result<Answer> {
    const FRICTION: (f64, f64) = (0.1, 1e-3);
    const LENGTH: f64 = 40.0;
    let mesh = SheetMesh::new(LENGTH, 1.0, 80, 2);
    let left = nodes_where(&mesh, |x| x[0] == 0.0);
    let stiffness = without_poisson().plane_modulus();
    let limit = FRICTION.0 * PRESSURE;
    let lag = (stiffness * FRICTION.1).sqrt();
    let push = |zone: f64| limit * (FRICTION.1 + (lag * zone + 0.5 * zone * zone) / stiffness);
    let zones = [2.0, 5.0, 10.0];
    let mut path = vec![(1.0, 0.0)];
    path.extend(
        zones
            .iter()
            .zip(2..)
            .map(|(&zone, t)| (f64::from(t), push(zone))),
    );
    let far = 0.4;
    path.extend([(5.0, far), (7.0, -far)]);
    let model = block(&mesh, FRICTION, &left, &path);
    let mut statics = Statics::new(world, model, Touching::All, 1e-12)?;
    statics.advance(1.0)?;
    let force = |statics: &Statics| -> Result<f64> {
        let forces = statics.internal_forces()?;
        let internal: f64 = left.iter().map(|&n| forces[n][0]).sum();
        // The left corner also carries its share of the first edge's friction.
        let edge = LENGTH / mesh.nx as f64;
        let friction: f64 = ContactRule::new(ContactLocation::Points, POINTS)
            .samples(false, false)
            .iter()
            .zip(statics.contacts()?)
            .map(|(sample, point)| sample.shape[0] * sample.weight * edge * point.friction)
            .sum();
        Ok(internal - friction)
    };
    let mut rows = Vec::new();
    for (zone, t) in zones.iter().zip(2..) {
        for part in 1..=4 {
            statics.advance(f64::from(t) - 1.0 + 0.25 * f64::from(part))?;
        }
        rows.push(Row::relative(
            format!(
                "force at a push of {:.5} mm (slip zone {zone} mm), N",
                push(*zone)
            ),
            force(&statics)?,
            limit * (zone + lag),
            1e-2,
            "shear lag with a slip zone (bar theory), closed form",
        ));
    }
    for (t, sign, name) in [(5.0, 1.0, "to the right"), (7.0, -1.0, "to the left")] {
        let from = t - 1.0 - if sign < 0.0 { 1.0 } else { 0.0 };
        for part in 1..=10 {
            statics.advance(from + (t - from) * f64::from(part) / 10.0)?;
        }
        let quantity = format!("force when all of it slips {name}, N");
        let source = "Coulomb: μ times the load";
        let (ours, exact) = (force(&statics)?, sign * limit * LENGTH);
        rows.push(Row::relative(quantity, ours, exact, 1e-8, source));
    }
    Ok(rows.into())
}
