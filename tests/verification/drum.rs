//! A strip drawn over a drum.

use std::f64::consts::{FRAC_PI_2, PI};

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::Factor;

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{
    Side, Statics, Touching, drum, growing, problem, rest_on, side_edges, traction,
};

const RADIUS: f64 = 10.0;
const THICKNESS: f64 = 0.1;
/// Straight part before and behind the drum.
const TAIL: f64 = 2.0;
/// Force per width that holds the strip back.
const HOLD: f64 = 5.0;

pub const EYTELWEIN: Case = Case {
    name: "friction_drum",
    title: "Contact: a strip drawn over a drum",
    text: "A strip of 0.1 mm, free of stress when it lies on a quarter of a drum of 10 mm, is held back by T₁ = 5 N/mm and drawn by 0.02 mm, so that it slips everywhere. \
The rope formula is T₂/T₁ = exp(μ θ). A strip with its middle at R + h/2 carries the friction on its face with a transverse force; equilibrium at constant curvature gives \
the exponent k = μ (1-δ)/(1 + δ μ k) with δ = h/(2R + h), 0.5 % below μ. Tolerance: h/R of the exponent for the rope formula, which neglects the thickness; 0.05 % for the second, which leaves out the ends of the contact.",
    quick: true,
    two_ranks: true,
    run: eytelwein,
};

/// From arc length and height on the straight strip to the strip on the drum.
fn wrapped([along, up]: [f64; 2]) -> [f64; 2] {
    let (arc, radius) = (RADIUS * FRAC_PI_2, RADIUS + up);
    if along < TAIL {
        return [-radius, along - TAIL];
    }
    if along > TAIL + arc {
        return [along - TAIL - arc, radius];
    }
    let (sin, cos) = (PI - (along - TAIL) / RADIUS).sin_cos();
    [radius * cos, radius * sin]
}

fn eytelwein(world: &SimpleCommunicator) -> Result<Answer> {
    let arc = RADIUS * FRAC_PI_2;
    let constants = Constants::elastic();
    let mut rows = Vec::new();
    for friction in [0.1, 0.1342, 0.3] {
        // 10 elements on each tail, 100 on the drum.
        let place = |i: f64| {
            if i < 10.0 {
                TAIL * i / 10.0
            } else if i < 110.0 {
                TAIL + arc * (i - 10.0) / 100.0
            } else {
                TAIL + arc + TAIL * (i - 110.0) / 10.0
            }
        };
        let mesh = SheetMesh::new(120.0, THICKNESS, 120, 1).mapped(|[i, y]| wrapped([place(i), y]));
        let mut strip = problem(mesh.clone(), &constants, Quadrature::Reduced);
        let ramp = Factor(vec![(0.0, 0.0), (1.0, 1.0)]);
        let tension = |_: [f64; 2]| [0.0, -HOLD / THICKNESS];
        strip.loads = traction(&mesh, Side::Left, tension, &ramp);
        let end: Vec<usize> = side_edges(&mesh, Side::Right).concat();
        let draw = Factor(vec![(1.0, 0.0), (2.0, 0.02)]);
        strip.supports = end.iter().map(|&n| growing(n, 0, 1.0)).collect();
        for support in &mut strip.supports {
            support.factor = draw.clone();
        }
        rest_on(&mut strip, drum(RADIUS), 6);
        strip.contact_compliance = 5e-5;
        strip.friction_coefficient = friction;
        strip.friction_compliance = 5e-4;
        let mut statics = Statics::new(world, strip, Touching::All, 1e-11)?;
        for step in 1..=30 {
            statics.advance(0.1 * f64::from(step).min(20.0))?;
        }
        let forces = statics.internal_forces()?;
        let drawn: f64 = end.iter().map(|&n| forces[n][0]).sum();
        let touching: Vec<_> = statics
            .contacts()?
            .into_iter()
            .filter(|point| point.state.is_closed())
            .collect();
        let sticking = touching.iter().filter(|point| !point.state.slips()).count();
        let delta = THICKNESS / (2.0 * RADIUS + THICKNESS);
        let exponent = (0..50).fold(friction, |k, _| {
            friction * (1.0 - delta) / (1.0 + delta * friction * k)
        });
        let label = format!("μ = {friction}");
        rows.push(Row::relative(
            format!("T₂/T₁, {label}"),
            drawn / HOLD,
            (friction * FRAC_PI_2).exp(),
            THICKNESS / RADIUS * friction * FRAC_PI_2,
            "Euler 1769, Eytelwein 1808: exp(μ θ)",
        ));
        rows.push(Row::relative(
            format!("T₂/T₁ with the strip's thickness, {label}"),
            drawn / HOLD,
            (exponent * FRAC_PI_2).exp(),
            5e-4,
            "equilibrium of a strip of constant curvature",
        ));
        rows.push(Row::absolute(
            format!("points that stick, {label}"),
            sticking as f64,
            0.0,
            0.0,
            "all of it slips",
        ));
    }
    Ok(rows.into())
}
