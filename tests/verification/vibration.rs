//! Motion in time: frequency, order, damping and energy of the generalized-alpha method.

use std::f64::consts::{PI, TAU};

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::Problem;

use crate::flow::Constants;
use crate::motion::{DENSITY, Start, integrate};
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{held, nodes_where, problem};

/// Displacement and velocity of a node, and kinetic and elastic energy of all, after a step.
#[derive(Clone, Copy)]
struct Instant {
    u: [f64; 2],
    v: [f64; 2],
    energy: f64,
}

/// Lets the model swing from the displacements `start` at rest; gives what `node` does.
fn swing(
    world: &SimpleCommunicator,
    model: Problem,
    start: impl Fn([f64; 2]) -> [f64; 2],
    node: usize,
    radius: f64,
    steps: (f64, usize),
) -> Result<Vec<Instant>> {
    let start = Start {
        displacement: &start,
        velocity: &|_| [0.0; 2],
    };
    integrate(world, model, &start, radius, steps, move |now| {
        let measures = now.measures()?;
        let (u, v) = (now.u.read()?, now.rates.velocity.read()?);
        Ok(Instant {
            u: [u[2 * node], u[2 * node + 1]],
            v: [v[2 * node], v[2 * node + 1]],
            energy: measures.kinetic_energy + measures.strain_energy,
        })
    })
}

const BAR_LENGTH: f64 = 10.0;
const BAR_AMPLITUDE: f64 = 1e-4;

/// A bar fixed at its left end that can move along x only, and the circular frequency of its first mode.
fn bar() -> (Problem, f64) {
    let constants = Constants::elastic();
    let nu = constants.poisson;
    let modulus = constants.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let mesh = SheetMesh::new(BAR_LENGTH, 1.0, 10, 1);
    let mut model = problem(mesh.clone(), &constants, Quadrature::Reduced);
    model.density = DENSITY;
    model.supports = (0..mesh.nodes.len()).map(|n| held(n, 1)).collect();
    model
        .supports
        .extend(mesh.symmetry_nodes.iter().map(|&n| held(n, 0)));
    (model, 0.5 * PI / BAR_LENGTH * (modulus / DENSITY).sqrt())
}

/// The bar's free end, with displacement and velocity over ω, both over the amplitude.
fn swing_bar(
    world: &SimpleCommunicator,
    radius: f64,
    per_period: usize,
    periods: usize,
) -> Result<(Vec<[f64; 2]>, Vec<f64>)> {
    let (model, omega) = bar();
    let tip = model.mesh.symmetry_nodes.len();
    let tip = nodes_where(&model.mesh, |x| x[0] == BAR_LENGTH)[tip / 2];
    let mode = |x: [f64; 2]| [BAR_AMPLITUDE * (0.5 * PI * x[0] / BAR_LENGTH).sin(), 0.0];
    let dt = TAU / omega / per_period as f64;
    let instants = swing(world, model, mode, tip, radius, (dt, per_period * periods))?;
    Ok((
        instants
            .iter()
            .map(|i| [i.u[0] / BAR_AMPLITUDE, i.v[0] / omega / BAR_AMPLITUDE])
            .collect(),
        instants.iter().map(|i| i.energy).collect(),
    ))
}

/// Mean angle per step of a swinging value, from its first to its last change of sign.
fn angle_per_step(values: &[f64]) -> f64 {
    let crossings: Vec<f64> = values
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(k, pair)| k as f64 + pair[0] / (pair[0] - pair[1]))
        .collect();
    let last = crossings.len() - 1;
    PI * last as f64 / (crossings[last] - crossings[0])
}

pub const BAR: Case = Case {
    name: "dynamics_bar",
    title: "Dynamics: longitudinal vibration of a bar",
    text: "First mode of a bar fixed at one end, in uniaxial strain, 10 elements: ω = π c/(2 L), c² = E(1-ν)/((1+ν)(1-2ν)ρ). With a spectral radius of 1 the method is the trapezoidal rule, whose frequency is \
(2/dt) atan(ω dt/2): tolerance 1e-5 with that, and 1e-4 without, at 200 steps per period. The order is that of the error in displacement and velocity after two periods, from 80 to 160 steps per period; \
radius 1 keeps the energy (after the start, whose first step is damped).",
    quick: true,
    two_ranks: false,
    run: frequency_and_order,
};

fn frequency_and_order(world: &SimpleCommunicator) -> Result<Answer> {
    let (_, omega) = bar();
    let per_period = 200;
    let step_angle = TAU / per_period as f64;
    let (motion, energy) = swing_bar(world, 1.0, per_period, 5)?;
    let displacement: Vec<f64> = motion.iter().map(|m| m[0]).collect();
    let angle = angle_per_step(&displacement);
    let computed = omega * angle / step_angle;
    let discrete = omega * 2.0 * (0.5 * step_angle).atan() / step_angle;
    let mut rows = vec![
        Row::relative(
            "circular frequency, radius 1, 1/ms",
            computed,
            omega,
            1e-4,
            "wave equation: π c/(2 L)",
        ),
        Row::relative(
            "circular frequency, radius 1, 1/ms",
            computed,
            discrete,
            1e-5,
            "trapezoidal rule: (2/dt) atan(ω dt/2)",
        ),
    ];
    let change = |energy: &[f64]| {
        let from = energy[1];
        energy[1..]
            .iter()
            .map(|e| (e / from - 1.0).abs())
            .fold(0.0, f64::max)
    };
    rows.push(Row::absolute(
        "largest relative change of the energy in 5 periods, radius 1",
        change(&energy),
        0.0,
        1e-6,
        "Hughes 1987, section 9.1: the trapezoidal rule keeps it",
    ));
    for radius in [1.0, 0.9, 0.5, 0.0] {
        let error = |per_period: usize| -> Result<f64> {
            let (motion, _) = swing_bar(world, radius, per_period, 2)?;
            let [u, v] = motion[motion.len() - 1];
            Ok((u - 1.0).hypot(v))
        };
        let order = (error(80)? / error(160)?).log2();
        rows.push(Row::absolute(
            format!("order in time, radius {radius}"),
            order,
            2.0,
            0.1,
            "Chung and Hulbert 1993",
        ));
    }
    Ok(rows.into())
}

pub const DAMPING: Case = Case {
    name: "dynamics_damping",
    title: "Dynamics: algorithmic damping",
    text: "The same bar with 20 and 8 steps per period. After the start the end's displacement obeys u(n+1) = 2 r cos θ u(n) - r² u(n-1) with r exp(±iθ) the complex eigenvalues of the \
amplification matrix of the generalized-alpha method; the third one dies out. Tolerance: the first mode of the mesh (1e-5) and the third eigenvalue.",
    quick: true,
    two_ranks: false,
    run: damping,
};

/// Modulus and angle of the complex eigenvalues of the amplification matrix of (u, dt v, dt² a).
fn amplification(radius: f64, step_angle: f64) -> [f64; 2] {
    let alpha_m = (2.0 - radius) / (1.0 + radius);
    let alpha_f = 1.0 / (1.0 + radius);
    let gamma = 0.5 + alpha_m - alpha_f;
    let beta = 0.25 * (1.0 + alpha_m - alpha_f).powi(2);
    let w = step_angle * step_angle;
    // (1-αm) a0 + αm a1 + w ((1-αf) u0 + αf u1) = 0 with Newmark's u1 and v1.
    let step = |[u, v, a]: [f64; 3]| {
        let predicted = u + v + (0.5 - beta) * a;
        let rest = (1.0 - alpha_m) * a + w * ((1.0 - alpha_f) * u + alpha_f * predicted);
        let next = -rest / (alpha_m + w * alpha_f * beta);
        [
            predicted + beta * next,
            v + (1.0 - gamma) * a + gamma * next,
            next,
        ]
    };
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(step);
    let m = |i: usize, j: usize| columns[j][i];
    let trace = m(0, 0) + m(1, 1) + m(2, 2);
    let minor = |i: usize, j: usize| m(i, i) * m(j, j) - m(i, j) * m(j, i);
    let minors = minor(0, 1) + minor(1, 2) + minor(0, 2);
    let determinant = m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1))
        - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
        + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
    let characteristic = |x: f64| ((x - trace) * x + minors) * x - determinant;
    let real = crate::flow::bisect(-1.0, 1.0, characteristic);
    // The other two have the sum trace - real and the product minors - real (trace - real).
    let sum = trace - real;
    let modulus = (minors - real * sum).sqrt();
    [modulus, (0.5 * sum / modulus).acos()]
}

fn damping(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "amplification matrix of Chung and Hulbert 1993";
    let mut rows = Vec::new();
    for (radius, per_period) in [(0.0, 20), (0.0, 8), (0.5, 20), (0.9, 20), (1.0, 20)] {
        let (motion, _) = swing_bar(world, radius, per_period, 2)?;
        // Fit the recurrence to what comes late, when the third eigenvalue has died out.
        let u: Vec<f64> = motion.iter().map(|m| m[0]).collect();
        let late = &u[u.len() / 2..];
        let (mut a, mut b) = ([[0.0; 2]; 2], [0.0; 2]);
        for three in late.windows(3) {
            let known = [three[1], three[0]];
            for i in 0..2 {
                b[i] += known[i] * three[2];
                (0..2).for_each(|j| a[i][j] += known[i] * known[j]);
            }
        }
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        let first = (b[0] * a[1][1] - b[1] * a[0][1]) / det;
        let second = (a[0][0] * b[1] - a[1][0] * b[0]) / det;
        let modulus = (-second).sqrt();
        let angle = (0.5 * first / modulus).acos();
        let exact = amplification(radius, TAU / per_period as f64);
        let label = format!("radius {radius}, {per_period} steps per period");
        let quantity = format!("factor of the amplitude per step, {label}");
        rows.push(Row::relative(quantity, modulus, exact[0], 1e-4, SOURCE));
        let quantity = format!("angle per step, {label}");
        rows.push(Row::relative(quantity, angle, exact[1], 1e-4, SOURCE));
    }
    Ok(rows.into())
}

pub const BEAM: Case = Case {
    name: "dynamics_beam",
    title: "Dynamics: bending vibration of a cantilever",
    text: "50 x 1 mm, 25 x 1 elements, let go from the first mode of Euler and Bernoulli with an end deflection of 0.05 mm: ω = 1.8751² √(E' I/(ρ h L⁴)). 200 steps per period, radius 1. \
Neglected there: shear and rotary inertia, of the order of 5 (h/L)² = 0.2 %. Tolerance: that.",
    quick: true,
    two_ranks: false,
    run: beam,
};

fn beam(world: &SimpleCommunicator) -> Result<Answer> {
    const LENGTH: f64 = 50.0;
    const ROOT: f64 = 1.875_104_068_711_961;
    let constants = Constants::elastic();
    let mesh = SheetMesh::new(LENGTH, 1.0, 25, 1);
    let tip = nodes_where(&mesh, |x| x == [LENGTH, 0.5])[0];
    let mut model = problem(mesh.clone(), &constants, Quadrature::Reduced);
    model.density = DENSITY;
    model.supports = mesh.symmetry_nodes.iter().map(|&n| held(n, 0)).collect();
    model.supports.push(held(mesh.symmetry_nodes[1], 1));
    let omega = (ROOT / LENGTH).powi(2) * (constants.plane_modulus() / (12.0 * DENSITY)).sqrt();
    let ratio = (ROOT.cosh() + ROOT.cos()) / (ROOT.sinh() + ROOT.sin());
    // The mode is 2 at the tip.
    let mode = |[x, y]: [f64; 2]| {
        let z = ROOT * x / LENGTH;
        let value = z.cosh() - z.cos() - ratio * (z.sinh() - z.sin());
        let slope = ROOT / LENGTH * (z.sinh() + z.sin() - ratio * (z.cosh() - z.cos()));
        [-0.025 * slope * (y - 0.5), 0.025 * value]
    };
    let per_period = 200;
    let dt = TAU / omega / per_period as f64;
    let instants = swing(world, model, mode, tip, 1.0, (dt, 2 * per_period))?;
    let deflection: Vec<f64> = instants.iter().map(|i| i.u[1]).collect();
    let computed = angle_per_step(&deflection) / dt;
    Ok(vec![Row::relative(
        "circular frequency, 1/ms",
        computed,
        omega,
        2e-3,
        "Euler-Bernoulli: (1.8751/L)² √(E' h²/(12 ρ))",
    )]
    .into())
}
