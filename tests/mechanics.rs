//! Element, return map and assembly against finite differences and invariances. No PETSc: seconds.

mod common;

use common::{Noise, aluminium, small_problem};
use ssnp155::contact::{ContactLocation, ContactRule};
use ssnp155::element::{ElementForce, Quad8, Quadrature};
use ssnp155::material::{PointState, VonMises};
use ssnp155::mesh::partition;
use ssnp155::system::{History, JacobianEntries, Numbering, Problem, Subdomain};

const NODES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.35, 0.01],
    [0.36, 0.2],
    [0.01, 0.21],
    [0.175, 0.0],
    [0.355, 0.1],
    [0.18, 0.205],
    [0.0, 0.1],
];

/// A bent, stretched and turned element: strains of `size`.
fn displacement(size: f64, noise: &mut Noise) -> [[f64; 2]; 8] {
    let (sin, cos) = 0.7_f64.sin_cos();
    NODES.map(|[x, y]| {
        let bent = [x * (1.0 + size * (y - 0.1) / 0.1), y * (1.0 - 0.5 * size)];
        let turned = [cos * bent[0] - sin * bent[1], sin * bent[0] + cos * bent[1]];
        [
            turned[0] - x + 0.02 * size * noise.next(),
            turned[1] - y + 0.02 * size * noise.next(),
        ]
    })
}

fn force(
    kernel: &Quad8,
    u: &[[f64; 2]; 8],
    material: &VonMises,
    states: &[PointState],
) -> ElementForce {
    let mut out = ElementForce::ZERO;
    kernel
        .internal_force(u, material, states, true, &mut out)
        .unwrap();
    out
}

/// Entry of the whole tangent, of which the blocks below the diagonal are not stored.
fn entry(of: &ElementForce, i: usize, j: usize) -> f64 {
    let (first, second) = if i / 2 <= j / 2 { (i, j) } else { (j, i) };
    of.stiffness[first / 2][second / 2][first % 2][second % 2]
}

/// States after a first plastic step, so that the second one starts from history.
fn deformed_states(kernel: &Quad8, u: &[[f64; 2]; 8], material: &VonMises) -> Vec<PointState> {
    (0..kernel.point_count())
        .map(|q| {
            kernel
                .point_response(q, u, material, &PointState::VIRGIN)
                .unwrap()
                .0
                .state()
        })
        .collect()
}

/// Every way to place contact points.
const LOCATIONS: [ContactLocation; 3] = [
    ContactLocation::Points,
    ContactLocation::Nodes,
    ContactLocation::Closest,
];

#[test]
fn the_element_tangent_agrees_with_central_differences() {
    let material = aluminium();
    for quadrature in [Quadrature::Reduced, Quadrature::Full, Quadrature::of(2, 7)] {
        for (size, plastic) in [(1e-3, false), (0.02, true), (0.2, true)] {
            let mut noise = Noise::new(7);
            let kernel = Quad8::new(&NODES, quadrature);
            let states = deformed_states(&kernel, &displacement(0.7 * size, &mut noise), &material);
            let u = displacement(size, &mut noise);
            let exact = force(&kernel, &u, &material, &states);
            let yielded = (0..kernel.point_count()).any(|q| {
                let (response, ..) = kernel.point_response(q, &u, &material, &states[q]).unwrap();
                response.state().equivalent_plastic_strain > states[q].equivalent_plastic_strain
            });
            assert_eq!(
                yielded, plastic,
                "strain {size} does not test what it should"
            );
            let scale = exact
                .stiffness
                .as_flattened()
                .as_flattened()
                .as_flattened()
                .iter()
                .fold(0.0_f64, |m, k| m.max(k.abs()));
            let h = 1e-7;
            for j in 0..16 {
                let (mut plus, mut minus) = (u, u);
                plus[j / 2][j % 2] += h;
                minus[j / 2][j % 2] -= h;
                let up = force(&kernel, &plus, &material, &states);
                let down = force(&kernel, &minus, &material, &states);
                for i in 0..16 {
                    let slope = (up.force[i] - down.force[i]) / (2.0 * h);
                    let error = (entry(&exact, i, j) - slope).abs() / scale;
                    assert!(
                        error < 2e-7,
                        "{quadrature:?} {size} [{i}][{j}]: {error:.1e}"
                    );
                    let skew = (entry(&exact, i, j) - entry(&exact, j, i)).abs() / scale;
                    assert!(skew < 1e-14);
                }
            }
        }
    }
}

#[test]
fn a_rigid_motion_turns_the_stress_and_nothing_else() {
    let material = aluminium();
    let kernel = Quad8::new(&NODES, Quadrature::Reduced);
    let mut noise = Noise::new(3);
    let u = displacement(0.05, &mut noise);
    let states = deformed_states(&kernel, &displacement(0.03, &mut noise), &material);
    let (sin, cos) = 1.1_f64.sin_cos();
    let mut turned = u;
    for (t, x) in turned.iter_mut().zip(NODES) {
        let now = [x[0] + t[0], x[1] + t[1]];
        *t = [
            cos * now[0] - sin * now[1] - x[0] + 3.0,
            sin * now[0] + cos * now[1] - x[1] - 5.0,
        ];
    }
    let (before, after) = (
        force(&kernel, &u, &material, &states).force,
        force(&kernel, &turned, &material, &states).force,
    );
    let size = before.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    for a in 0..8 {
        let expected = [
            cos * before[2 * a] - sin * before[2 * a + 1],
            sin * before[2 * a] + cos * before[2 * a + 1],
        ];
        for k in 0..2 {
            assert!((after[2 * a + k] - expected[k]).abs() < 1e-12 * size);
        }
    }
}

#[test]
fn elastic_forces_are_the_slope_of_the_stored_energy() {
    let material = aluminium();
    let kernel = Quad8::new(&NODES, Quadrature::Full);
    let mut noise = Noise::new(5);
    let u = displacement(1e-3, &mut noise);
    let states = vec![PointState::VIRGIN; kernel.point_count()];
    let energy = |u: &[[f64; 2]; 8]| -> f64 {
        (0..kernel.point_count())
            .map(|q| {
                let (r, _, volume) = kernel.point_response(q, u, &material, &states[q]).unwrap();
                volume * r.elastic_energy()
            })
            .sum()
    };
    let exact = force(&kernel, &u, &material, &states).force;
    let size = exact.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let h = 1e-6;
    for j in 0..16 {
        let (mut plus, mut minus) = (u, u);
        plus[j / 2][j % 2] += h;
        minus[j / 2][j % 2] -= h;
        let slope = (energy(&plus) - energy(&minus)) / (2.0 * h);
        assert!(
            (exact[j] - slope).abs() < 1e-6 * size,
            "{} {}",
            exact[j],
            slope
        );
    }
}

#[test]
fn an_inverted_element_is_refused() {
    let material = aluminium();
    let kernel = Quad8::new(&NODES, Quadrature::Reduced);
    let mirrored = NODES.map(|[x, _]| [-2.0 * x, 0.0]);
    let states = vec![PointState::VIRGIN; 4];
    let mut out = ElementForce::ZERO;
    let refused = kernel.internal_force(&mirrored, &material, &states, false, &mut out);
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("the element is inverted")
    );
}

/// Unknowns with plastic strain, contact on both tools, and open points.
fn deformed_unknowns(problem: &Problem, seed: u64) -> (f64, Vec<f64>, Vec<f64>) {
    let partition = partition(&problem.mesh, 1).unwrap();
    let numbering = Numbering::new(problem, &partition, 1);
    let mut noise = Noise::new(seed);
    let size = numbering.row_count(0);
    let mut global = vec![0.0; size];
    let mut acceleration = vec![0.0; size];
    for (node, &row) in numbering.node_row.iter().enumerate() {
        let [x, y] = problem.mesh.nodes[node];
        global[row] = 2e-3 * x * (y - 0.5) + 1e-4 * noise.next();
        global[row + 1] = -0.3 + 2e-3 * x * x + 1e-4 * noise.next();
        acceleration[row] = 1e-3 * noise.next();
        acceleration[row + 1] = 1e-3 * noise.next();
    }
    for (edge, &row) in numbering.edge_row.iter().enumerate() {
        for k in 0..problem.contact_samples(edge).len() {
            global[row + 2 * k] = 1e-5 * (1.5 + noise.next());
            global[row + 2 * k + 1] = 0.01 * (1.5 + noise.next());
        }
    }
    (120.0, global, acceleration)
}

/// Residual and dense Jacobian summed over `ranks` parts, in the numbering of one rank.
fn assemble(
    problem: &Problem,
    ranks: usize,
    t: f64,
    u: &[f64],
    a: &[f64],
    shift: f64,
) -> (Vec<f64>, Vec<f64>) {
    let one = Numbering::new(problem, &vec![0; problem.mesh.elements.len()], 1);
    let parts = partition(&problem.mesh, ranks).unwrap();
    let many = Numbering::new(problem, &parts, ranks);
    let size = one.row_count(0);
    let mut to_one = vec![0; size];
    for (m, o) in many.node_row.iter().zip(&one.node_row) {
        (to_one[*m], to_one[m + 1]) = (*o, o + 1);
    }
    for (edge, (m, o)) in many.edge_row.iter().zip(&one.edge_row).enumerate() {
        let points = problem.contact_samples(edge).len();
        (0..2 * points).for_each(|k| to_one[m + k] = o + k);
    }
    let (mut residual, mut jacobian) = (vec![0.0; size], vec![0.0; size * size]);
    for rank in 0..ranks {
        let local = Subdomain::new(problem.clone(), &parts, &many, rank);
        let history = History::virgin(&local);
        let rows: Vec<usize> = local.rows().iter().map(|&r| to_one[r as usize]).collect();
        let gather = |x: &[f64]| rows.iter().map(|&r| x[r]).collect::<Vec<f64>>();
        let mut out = vec![0.0; rows.len()];
        local
            .residual(&history, t, (&gather(u), &gather(a)), None, &mut out)
            .unwrap();
        rows.iter()
            .zip(&out)
            .for_each(|(&r, value)| residual[r] += value);
        let (pattern_rows, columns) = local.jacobian_pattern();
        let mut entries = JacobianEntries::new(&local);
        local
            .jacobian(&history, t, &gather(u), shift, &mut entries)
            .unwrap();
        for ((r, c), value) in pattern_rows.iter().zip(&columns).zip(entries.values()) {
            if *r >= 0 {
                jacobian[to_one[*r as usize] * size + to_one[*c as usize]] += value;
            }
        }
    }
    (residual, jacobian)
}

#[test]
fn the_full_jacobian_agrees_with_central_differences() {
    for location in LOCATIONS {
        let mut problem = small_problem(6, 2);
        problem.contact_rule = ContactRule::new(location, 3);
        full_jacobian_agrees(&problem);
        problem.friction_coefficient = 0.2;
        full_jacobian_agrees(&problem);
    }
}

fn full_jacobian_agrees(problem: &Problem) {
    let (t, u, a) = deformed_unknowns(problem, 11);
    // With an acceleration that follows the displacement the shift is its slope.
    let shift = 2.5;
    let follow = |u: &[f64]| -> Vec<f64> { u.iter().zip(&a).map(|(u, a)| a + shift * u).collect() };
    let (_, jacobian) = assemble(problem, 1, t, &u, &follow(&u), shift);
    let size = u.len();
    let mut worst = 0.0_f64;
    for j in 0..size {
        let h = 1e-7;
        let (mut plus, mut minus) = (u.clone(), u.clone());
        plus[j] += h;
        minus[j] -= h;
        let (up, _) = assemble(problem, 1, t, &plus, &follow(&plus), shift);
        let (down, _) = assemble(problem, 1, t, &minus, &follow(&minus), shift);
        for i in 0..size {
            let slope = (up[i] - down[i]) / (2.0 * h);
            worst = worst.max((jacobian[i * size + j] - slope).abs());
        }
    }
    let scale = jacobian.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
    assert!(worst < 1e-6 * scale, "{worst:.2e} of {scale:.2e}");
}

#[test]
fn a_residual_leaves_the_jacobian_of_its_place_and_of_no_other() {
    let mut problem = small_problem(6, 2);
    problem.friction_coefficient = 0.2;
    let numbering = Numbering::new(&problem, &vec![0; problem.mesh.elements.len()], 1);
    let local = Subdomain::new(problem.clone(), &vec![0; 12], &numbering, 0);
    let history = History::virgin(&local);
    let evaluate = |seed: u64, kept: Option<&mut JacobianEntries>| {
        let (t, u, a) = deformed_unknowns(&problem, seed);
        let mut out = vec![0.0; u.len()];
        local
            .residual(&history, t, (&u, &a), kept, &mut out)
            .unwrap();
        out
    };
    let jacobian = |seed: u64, entries: &mut JacobianEntries| {
        let (t, u, _) = deformed_unknowns(&problem, seed);
        local.jacobian(&history, t, &u, 2.5, entries).unwrap();
        entries.values().to_vec()
    };
    let alone = |seed| jacobian(seed, &mut JacobianEntries::new(&local));
    assert_ne!(alone(11), alone(12));
    let mut entries = JacobianEntries::new(&local);
    assert_eq!(evaluate(11, Some(&mut entries)), evaluate(11, None));
    // What was left is used once: inertia would be in it twice.
    assert_eq!(jacobian(11, &mut entries), alone(11));
    assert_eq!(jacobian(11, &mut entries), alone(11));
    evaluate(11, Some(&mut entries));
    assert_eq!(jacobian(12, &mut entries), alone(12));
    // Who forgets has it evaluated, here with another history.
    evaluate(11, Some(&mut entries));
    entries.forget();
    let (t, u, _) = deformed_unknowns(&problem, 11);
    let later = history.advanced(&local, t, &u).unwrap();
    local.jacobian(&later, t, &u, 2.5, &mut entries).unwrap();
    assert_ne!(entries.values(), alone(11));
}

#[test]
fn assembly_does_not_depend_on_the_partition() {
    for location in LOCATIONS {
        let mut problem = small_problem(12, 3);
        problem.contact_rule = ContactRule::new(location, 3);
        partition_does_not_matter(&problem);
    }
}

fn partition_does_not_matter(problem: &Problem) {
    let (t, u, a) = deformed_unknowns(problem, 13);
    let (residual, jacobian) = assemble(problem, 1, t, &u, &a, 2.5);
    for ranks in [2, 3, 4] {
        let (other_residual, other_jacobian) = assemble(problem, ranks, t, &u, &a, 2.5);
        let differ = |x: &[f64], y: &[f64]| {
            let size = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            x.iter()
                .zip(y)
                .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
                / size
        };
        assert!(differ(&residual, &other_residual) < 1e-13);
        assert!(differ(&jacobian, &other_jacobian) < 1e-13);
    }
}
