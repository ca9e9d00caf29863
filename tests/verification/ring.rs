//! Contact patch test on a curved tool: a ring pressed on a drum.

use std::f64::consts::FRAC_PI_2;

use mpi::topology::SimpleCommunicator;
use ssnp155::element::{Quadrature, edge_shape};
use ssnp155::mesh::SheetMesh;
use ssnp155::system::{Factor, NodalValue};

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{
    Side, Statics, Touching, drum, held, nodes_where, problem, rest_on, side_edges,
};

pub const PRESSED: Case = Case {
    name: "contact_ring",
    title: "Contact: patch test on a curved tool",
    text: "A quarter of a ring of 1 mm, elastic, lies on a rigid drum of 10 mm under a dead pressure of 10 MPa on its outer face; edges of different length, both ends held in symmetry. \
Every contact point must carry the same pressure, that of Lamé's ring whose inner face gives way by the compliance times the pressure. \
The edges are parabolas: between their nodes they are R α⁴/32 nearer to the drum, with α half the angle of the longest edge. \
Tolerance: twice that over the penetration, and 3e-4 for strains of 1e-4, which Lamé's solution neglects.",
    quick: true,
    two_ranks: true,
    run: pressed,
};

/// The longer edge of two over their mean.
const LONGER: f64 = 1.2;
const RADIUS: f64 = 10.0;
const THICKNESS: f64 = 1.0;
const COMPLIANCE: f64 = 5e-5;
/// Pressure on the outer face, MPa: strains of 1e-4.
const PRESSURE: f64 = 10.0;

/// Lamé's ring in plane strain under `PRESSURE` outside, on a drum that gives way by the compliance times the pressure:
/// the pressure on the drum.
fn pressure_on_the_drum(constants: &Constants) -> f64 {
    let (a, b) = (RADIUS, RADIUS + THICKNESS);
    let shear = constants.shear_modulus();
    let nu = constants.poisson;
    // u = A r + B/r and σ_r = 2G (A/(1-2ν) - B/r²), with σ_r(b) = -PRESSURE and u(a) = COMPLIANCE σ_r(a).
    let stress = |r: f64| [2.0 * shear / (1.0 - 2.0 * nu), -2.0 * shear / (r * r)];
    let (outer, inner) = (stress(b), stress(a));
    let face = [a - COMPLIANCE * inner[0], 1.0 / a - COMPLIANCE * inner[1]];
    let det = outer[0] * face[1] - outer[1] * face[0];
    let [big_a, big_b] = [-PRESSURE * face[1] / det, PRESSURE * face[0] / det];
    -(inner[0] * big_a + inner[1] * big_b)
}

/// Consistent nodal loads of the pressure on the outer face with its curved edges.
fn outer_pressure(mesh: &SheetMesh, factor: &Factor) -> Vec<NodalValue> {
    let mut loads = Vec::new();
    for edge in side_edges(mesh, Side::Top) {
        let x = edge.map(|n| mesh.nodes[n]);
        for (xi, weight) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let slope = [xi - 0.5, xi + 0.5, -2.0 * xi];
            let along = [0, 1].map(|k| (0..3).map(|a| slope[a] * x[a][k]).sum::<f64>());
            // The face is on the left of its edges from left to right.
            let push = [PRESSURE * along[1], -PRESSURE * along[0]];
            for (n, &node) in edge_shape(xi).into_iter().zip(&edge) {
                loads.extend([0, 1].map(|component| NodalValue {
                    node,
                    component,
                    value: n * push[component] * weight / 9.0,
                    factor: factor.clone(),
                }));
            }
        }
    }
    loads
}

/// Largest error of a contact pressure as a share of the exact one.
fn worst_pressure(
    world: &SimpleCommunicator,
    along: usize,
    points: usize,
    quadrature: Quadrature,
) -> Result<f64> {
    let constants = Constants::elastic();
    // From x = 0 round to y = 0, every other edge half as long again as its neighbours.
    let pairs = along as f64 / 2.0;
    let turned = |[s, y]: [f64; 2]| {
        let (pair, part) = ((s * pairs).floor(), 2.0 * (s * pairs).fract());
        let in_pair = if part < 1.0 {
            LONGER * part
        } else {
            LONGER + (2.0 - LONGER) * (part - 1.0)
        };
        let (sin, cos) = (FRAC_PI_2 * (1.0 - (pair + 0.5 * in_pair) / pairs)).sin_cos();
        let radius = RADIUS + y;
        let place = [radius * cos, radius * sin];
        place.map(|x| if x.abs() < 1e-12 { 0.0 } else { x })
    };
    let mesh = SheetMesh::new(1.0, THICKNESS, along, 2).mapped(turned);
    let mut ring = problem(mesh.clone(), &constants, quadrature);
    for (component, other) in [(0, 1), (1, 0)] {
        let on_axis = nodes_where(&mesh, |x| x[component] == 0.0 && x[other] > 0.0);
        ring.supports
            .extend(on_axis.iter().map(|&n| held(n, component)));
    }
    ring.loads = outer_pressure(&mesh, &Factor(vec![(0.0, 0.0), (1.0, 1.0)]));
    rest_on(&mut ring, drum(RADIUS), points);
    ring.contact_compliance = COMPLIANCE;
    let mut statics = Statics::new(world, ring, Touching::All, 1e-13)?;
    statics.advance(1.0)?;
    let exact = pressure_on_the_drum(&constants);
    let errors = statics.contacts()?.into_iter();
    let errors = errors.map(|point| (point.pressure / exact - 1.0).abs());
    Ok(errors.fold(0.0, f64::max))
}

fn pressed(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Lamé 1852; Timoshenko and Goodier 1970, article 28";
    let mut rows = Vec::new();
    for (points, quadrature) in [
        (3, Quadrature::Reduced),
        (6, Quadrature::Reduced),
        (6, Quadrature::Full),
    ] {
        for along in [20, 40, 80] {
            let half_angle = LONGER * FRAC_PI_2 / f64::from(along) / 2.0;
            let edge = RADIUS * half_angle.powi(4) / 32.0;
            let error = worst_pressure(world, along as usize, points, quadrature)?;
            rows.push(Row::absolute(
                format!("largest error of a pressure over p; {along} edges, {points} points per edge, {quadrature:?} integration"),
                error,
                0.0,
                2.0 * edge / (COMPLIANCE * PRESSURE) + 3e-4,
                SOURCE,
            ));
        }
    }
    Ok(rows.into())
}
