//! A bar that hits a wall.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;

use crate::flow::Constants;
use crate::motion::{DENSITY, Start, integrate};
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{flat, held, problem, rest_on};

const HEIGHT: f64 = 10.0;
const WIDTH: f64 = 0.2;
const SPEED: f64 = 1.0;

pub const WALL: Case = Case {
    name: "dynamics_impact",
    title: "Dynamics: a bar hits a wall",
    text: "A bar of 10 mm in uniaxial strain flies against a rigid wall at v = 1 mm/ms. It stays for 2 L/c with the pressure ρ c v and leaves with -v. \
Spectral radius 0 as in a simulation, 8 steps per element for 2 L/c, contact compliance 1e-7 mm/MPa. The front is a jump, which a method of second order smears with order 2/3: so much velocity and energy is lost. \
The momentum must balance exactly and the energy must not grow. Tolerance: 1 % for the pressure between the fronts, 2 % for the time.",
    quick: false,
    two_ranks: false,
    run: wall,
};

/// What is watched after a step: pressure, mean velocity, energy.
struct Watched {
    pressure: f64,
    velocity: f64,
    energy: f64,
}

fn impact(world: &SimpleCommunicator, elements: usize) -> Result<Outcome> {
    let constants = Constants::elastic();
    let nu = constants.poisson;
    let modulus = constants.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let wave_speed = (modulus / DENSITY).sqrt();
    let contact_time = 2.0 * HEIGHT / wave_speed;
    let dt = contact_time / (8 * elements) as f64;
    let gap = 10.5 * dt * SPEED;
    let mesh = SheetMesh::new(WIDTH, HEIGHT, 1, elements);
    let mut model = problem(mesh.clone(), &constants, Quadrature::Reduced);
    model.density = DENSITY;
    model.supports = (0..mesh.nodes.len()).map(|n| held(n, 0)).collect();
    rest_on(&mut model, flat(-gap), 3);
    model.contact_compliance = 1e-7;
    let start = Start {
        displacement: &|_| [0.0; 2],
        velocity: &|_| [0.0, -SPEED],
    };
    let column = mesh.symmetry_nodes.clone();
    let motion = integrate(world, model, &start, 0.0, (dt, 10 * elements), move |now| {
        let values = now.system.local_values(now.u)?;
        let points = now
            .system
            .local()
            .contact_points(now.history, now.t, &values);
        let measures = now.measures()?;
        let v = now.rates.velocity.read()?;
        let speed = |k: usize| v[2 * column[k] + 1];
        let mean = (0..elements)
            .map(|e| (speed(2 * e) + 4.0 * speed(2 * e + 1) + speed(2 * e + 2)) / 6.0)
            .sum::<f64>()
            / elements as f64;
        Ok(Watched {
            pressure: points.iter().map(|p| p.pressure).sum::<f64>() / points.len() as f64,
            velocity: mean,
            energy: measures.kinetic_energy + measures.strain_energy + measures.contact_energy(),
        })
    })?;
    let exact_pressure = DENSITY * wave_speed * SPEED;
    let touching: Vec<usize> = (0..motion.len())
        .filter(|&k| motion[k].pressure > 0.5 * exact_pressure)
        .collect();
    let middle = &motion[elements..7 * elements];
    let before = 0.5 * DENSITY * SPEED * SPEED * HEIGHT * WIDTH;
    let largest = motion.iter().map(|w| w.energy).fold(0.0, f64::max);
    let end = &motion[motion.len() - 1];
    Ok(Outcome {
        pressure: middle.iter().map(|w| w.pressure).sum::<f64>()
            / middle.len() as f64
            / exact_pressure,
        time: (touching[touching.len() - 1] - touching[0] + 1) as f64 * dt / contact_time,
        impulse: motion.iter().map(|w| w.pressure * dt).sum(),
        velocity: end.velocity,
        growth: (largest / before - 1.0).max(0.0),
    })
}

/// What came out of an impact.
struct Outcome {
    /// Mean pressure in the middle of the contact over the exact one.
    pressure: f64,
    /// Time above half the pressure over the exact time.
    time: f64,
    /// Impulse of the wall per area.
    impulse: f64,
    /// Mean velocity after.
    velocity: f64,
    /// Largest energy over the first, less one.
    growth: f64,
}

fn wall(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "wave equation in one dimension (Doyen, Ern and Piperno 2011)";
    let mut rows = Vec::new();
    let mut losses = Vec::new();
    for elements in [25, 50, 100] {
        let outcome = impact(world, elements)?;
        losses.push(1.0 - outcome.velocity / SPEED);
        let label = format!("{elements} elements");
        rows.extend([
            Row::relative(
                format!("mean pressure in the middle of the contact over ρ c v, {label}"),
                outcome.pressure,
                1.0,
                1e-2,
                SOURCE,
            ),
            Row::relative(
                format!("time above half the pressure over 2 L/c, {label}"),
                outcome.time,
                1.0,
                2e-2,
                SOURCE,
            ),
            Row::relative(
                format!("impulse, N ms/mm², {label}"),
                outcome.impulse,
                DENSITY * HEIGHT * (SPEED + outcome.velocity),
                1e-6,
                "change of the momentum",
            ),
            Row::absolute(
                format!("largest energy over that before, less one, {label}"),
                outcome.growth,
                0.0,
                1e-6,
                "dissipation of the method",
            ),
        ]);
    }
    for (pair, elements) in losses.windows(2).zip([50, 100]) {
        rows.push(Row::absolute(
            format!(
                "order of the velocity after, {} to {elements} elements (lost: {:.4})",
                elements / 2,
                pair[1]
            ),
            (pair[0] / pair[1]).log2(),
            2.0 / 3.0,
            0.1,
            "LeVeque 2002, section 8.7: 2/3 at a jump",
        ));
    }
    Ok(rows.into())
}
