//! A rigid cylinder pressed on an elastic block that is almost a half-plane.

use std::f64::consts::PI;
use std::sync::Arc;

use mpi::topology::SimpleCommunicator;
use ssnp155::contact::{ContactLocation, ContactRule};
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::Tool;
use ssnp155::tool::{Motion, PunchMotion, punch};

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Statics, Touching, held, nodes_where, problem};
use crate::svg::Chart;

pub const CYLINDER: Case = Case {
    name: "contact_hertz",
    title: "Contact: Hertz, a rigid cylinder on an elastic half-plane",
    text: "A cylinder of 1000 mm pressed by a motion on a block of 100 x 100 mm (half of it, by symmetry) that is held at its bottom, plane strain, elastic, without friction; the contact is about 1 mm wide, \
32 edges with 6 points each, and the mesh grows away from it. Half width and peak pressure belong to the computed force: a² = 4 P R/(π E*), p₀ = 2 P/(π a), E* = E/(1-ν²); so the depth of the block, \
which decides the approach in two dimensions, does not enter, and its effect on the pressure is of the order (a/H)² = 1e-4. The compliance of the contact is small here (1e-8 mm/MPa, E*/(k a) = 8e-4). \
Peak and half width are also those of an ellipse fitted to the points. The pressure falls to zero with infinite slope, which an edge cannot follow: points nearer to the end than two edges are left out of fit and comparison, and drawn. Tolerance: a third of an edge (1 %) for the end of the contact, 0.5 % for the fit, 1 % of the peak for each pressure.",
    quick: true,
    two_ranks: true,
    run: cylinder,
};

pub const RADIUS: f64 = 1000.0;
pub const SIZE: f64 = 100.0;
const COMPLIANCE: f64 = 1e-8;
/// PETSc's option for the ordering of the direct solver.
pub const ORDERING: &str = "condensed_pc_factor_mat_ordering_type";
/// Length of an edge in the contact.
pub const EDGE: f64 = 1.0 / 32.0;

/// Ends of elements: `fine` of length `h`, then each longer by `growth` than the one before, to SIZE.
pub fn knots(h: f64, fine: usize, growth: f64) -> Vec<f64> {
    let mut knots: Vec<f64> = (0..=fine).map(|i| h * i as f64).collect();
    let (mut length, mut end) = (h, h * fine as f64);
    while end < SIZE {
        length *= growth;
        end += length;
        knots.push(end);
    }
    // Spread what is too long or too short over the coarse part.
    let (from, to) = (h * fine as f64, end);
    for knot in &mut knots[fine..] {
        *knot = from + (*knot - from) * (SIZE - from) / (to - from);
    }
    knots
}

pub fn between(knots: &[f64], at: f64) -> f64 {
    let i = (at as usize).min(knots.len() - 2);
    knots[i] + (knots[i + 1] - knots[i]) * (at - i as f64)
}

fn cylinder(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Hertz 1882; Johnson 1985, eqs. 4.43-4.45";
    let constants = Constants::elastic();
    let (across, down) = (knots(EDGE, 40, 1.25), knots(EDGE, 16, 1.3));
    let (nx, ny) = (across.len() - 1, down.len() - 1);
    let mesh = SheetMesh::new(nx as f64, ny as f64, nx, ny)
        .mapped(|[i, j]| [between(&across, i), SIZE - between(&down, ny as f64 - j)]);
    let mut block = problem(mesh.clone(), &constants, Quadrature::Reduced);
    block.supports = mesh.symmetry_nodes.iter().map(|&n| held(n, 0)).collect();
    for node in nodes_where(&mesh, |x| x[1] == 0.0) {
        block.supports.extend([held(node, 0), held(node, 1)]);
    }
    block.contact_rule = ContactRule::new(ContactLocation::Points, 6);
    block.contact_compliance = COMPLIANCE;
    block.upper_tool = Some(Arc::new(Tool {
        profile: punch(RADIUS, SIZE, RADIUS),
        motion: Motion::Down(PunchMotion {
            stroke: 2.6e-3,
            unload_fraction: 0.0,
            time_load: 1.0,
            time_unload: 1.0,
        }),
    }));
    // The default ordering is for sheets, long and thin; this block is as high as wide.
    petsc::options::set(ORDERING, "nd")?;
    let mut statics = Statics::new(world, block, Touching::Innermost, 1e-12)?;
    petsc::options::clear(ORDERING)?;
    for step in 1..=4 {
        statics.advance(f64::from(step) / 4.0)?;
    }
    let force = 2.0 * statics.measures()?.punch_force;
    let modulus = constants.plane_modulus();
    let half_width = (4.0 * force * RADIUS / (PI * modulus)).sqrt();
    let peak = 2.0 * force / (PI * half_width);
    let hertz = |x: f64| peak * (1.0 - (x / half_width).powi(2)).max(0.0).sqrt();
    let points: Vec<[f64; 2]> = statics
        .contacts()?
        .iter()
        .map(|point| [point.reference[0], point.pressure])
        .collect();
    let inner: Vec<[f64; 2]> = points
        .iter()
        .copied()
        .filter(|[x, _]| *x < half_width - 2.0 * EDGE)
        .collect();
    let [fit_peak, fit_width] = ellipse(&inner);
    let largest = inner
        .iter()
        .map(|&[x, p]| (p - hertz(x)).abs() / peak)
        .fold(0.0, f64::max);
    let carrying = points.iter().filter(|[_, p]| *p > 1e-6 * peak);
    let end = carrying.map(|[x, _]| *x).fold(0.0, f64::max);
    let outside = points.iter().filter(|[x, _]| *x > 1.05 * half_width);
    let stray = outside.map(|[_, p]| p.abs()).fold(0.0, f64::max);
    let rows = vec![
        Row::relative(
            "peak pressure of the fitted ellipse, MPa",
            fit_peak,
            peak,
            5e-3,
            SOURCE,
        ),
        Row::relative(
            "half width of the fitted ellipse, mm",
            fit_width,
            half_width,
            5e-3,
            SOURCE,
        ),
        Row::relative("last point that carries, mm", end, half_width, 1e-2, SOURCE),
        Row::absolute(
            "largest error of a pressure over the peak, more than two edges inside the end",
            largest,
            0.0,
            1e-2,
            SOURCE,
        ),
        Row::absolute(
            "largest pressure outside 1.05 a, MPa",
            stray,
            0.0,
            1e-9,
            SOURCE,
        ),
    ];
    let scaled = |[x, p]: [f64; 2]| [x / half_width, p / peak];
    let chart = Chart {
        title: "Rigid cylinder on an elastic half-plane: contact pressure",
        x_label: "distance from the middle over the half width",
        y_label: "pressure over the peak",
        end: [1.2, 1.2],
        tick: [0.2, 0.2],
        curve: (
            "Hertz, for the same force",
            (0..=600)
                .map(|i| 1.2 * half_width * f64::from(i) / 600.0)
                .map(|x| scaled([x, hertz(x)]))
                .collect(),
        ),
        dots: (
            "contact points",
            points
                .iter()
                .map(|&p| scaled(p))
                .filter(|p| p[0] <= 1.2)
                .collect(),
        ),
    };
    Ok(Answer {
        rows,
        pictures: vec![(
            "verification-hertz",
            "Contact pressure against the distance from the middle",
            chart.svg()?,
        )],
    })
}

/// Peak and half width of the ellipse that fits best: p² is linear in x².
pub fn ellipse(points: &[[f64; 2]]) -> [f64; 2] {
    let n = points.len() as f64;
    let squares = || points.iter().map(|[x, p]| [x * x, p * p]);
    let mean = [0, 1].map(|k| squares().map(|s| s[k]).sum::<f64>() / n);
    let product: f64 = squares().map(|s| (s[0] - mean[0]) * (s[1] - mean[1])).sum();
    let spread: f64 = squares().map(|s| (s[0] - mean[0]).powi(2)).sum();
    let slope = -product / spread;
    let at_zero = mean[1] + slope * mean[0];
    [at_zero.sqrt(), (at_zero / slope).sqrt()]
}
