//! Orders of convergence from a manufactured solution.

use std::f64::consts::PI;

use mpi::topology::SimpleCommunicator;
use ssnp155::element::{Quadrature, gauss_points, shape, shape_gradients};
use ssnp155::mesh::SheetMesh;
use ssnp155::system::{Factor, NodalValue};

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Statics, Touching, growing, nodes_where, problem};

/// Small, so that the finite strain solution is that of small strains to 1e-6.
const AMPLITUDE: f64 = 1e-7;

pub const MANUFACTURED: Case = Case {
    name: "convergence_order",
    title: "Elements: order of convergence",
    text: "u = a (sin πx cos πy, cos πx sin 2πy) on the unit square with the body force it needs, linear elasticity (a = 1e-7), on \
smoothly distorted meshes of 8 x 8, 16 x 16 and 32 x 32 elements. Quadratic elements must give order 3 in the L2 norm of the displacement and order 2 in the energy norm. \
Tolerance on the orders: the last halving is not yet the limit.",
    quick: true,
    two_ranks: true,
    run: manufactured,
};

fn displacement([x, y]: [f64; 2]) -> [f64; 2] {
    let (x, y) = (PI * x, PI * y);
    [
        AMPLITUDE * x.sin() * y.cos(),
        AMPLITUDE * x.cos() * (2.0 * y).sin(),
    ]
}

/// Gradient, rows for the components.
fn gradient([x, y]: [f64; 2]) -> [[f64; 2]; 2] {
    let (x, y) = (PI * x, PI * y);
    let a = AMPLITUDE * PI;
    [
        [a * x.cos() * y.cos(), -a * x.sin() * y.sin()],
        [
            -a * x.sin() * (2.0 * y).sin(),
            2.0 * a * x.cos() * (2.0 * y).cos(),
        ],
    ]
}

/// Lamé's constants.
fn lame(constants: &Constants) -> [f64; 2] {
    let g = constants.shear_modulus();
    [
        2.0 * g * constants.poisson / (1.0 - 2.0 * constants.poisson),
        g,
    ]
}

/// - (λ + G) grad div u - G Δu.
fn body_force([lambda, g]: [f64; 2], at: [f64; 2]) -> [f64; 2] {
    let [x, y] = at.map(|x| PI * x);
    let a = AMPLITUDE * PI * PI;
    let grad_div = [
        -a * x.sin() * (y.cos() + 2.0 * (2.0 * y).cos()),
        -a * x.cos() * (y.sin() + 4.0 * (2.0 * y).sin()),
    ];
    let u = displacement(at);
    let laplacian = [-2.0 * PI * PI * u[0], -5.0 * PI * PI * u[1]];
    [0, 1].map(|k| -(lambda + g) * grad_div[k] - g * laplacian[k])
}

/// What is needed at a point of the 3 x 3 rule: position, shape functions, gradients, volume.
type Point = ([f64; 2], [f64; 8], [[f64; 2]; 8], f64);

fn points(x: &[[f64; 2]; 8]) -> Vec<Point> {
    gauss_points(Quadrature::Full)
        .into_iter()
        .map(|(xi, weight)| {
            let (n, local) = (shape(xi), shape_gradients(xi));
            let sum = |f: &dyn Fn(usize) -> f64| (0..8).map(f).sum::<f64>();
            let at = [0, 1].map(|k| sum(&|a| n[a] * x[a][k]));
            let j = [0, 1].map(|i| [0, 1].map(|k| sum(&|a| local[a][k] * x[a][i])));
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let global = local.map(|[p, q]| {
                [
                    (p * j[1][1] - q * j[1][0]) / det,
                    (q * j[0][0] - p * j[0][1]) / det,
                ]
            });
            (at, n, global, weight * det)
        })
        .collect()
}

/// Errors in the L2 norm of the displacement and in the energy norm, over the norms themselves.
fn errors(world: &SimpleCommunicator, n: usize, quadrature: Quadrature) -> Result<[f64; 2]> {
    let constants = Constants::elastic();
    let [lambda, g] = lame(&constants);
    let wave = |x: f64, y: f64| 0.06 * (PI * x).sin() * (2.0 * PI * y).sin();
    let mesh = SheetMesh::new(1.0, 1.0, n, n)
        .mapped(|[x, y]| [x + wave(x, y), y - wave(y, x)])
        .straightened();
    let mut model = problem(mesh.clone(), &constants, quadrature);
    for nodes in &mesh.elements {
        for (at, n, _, volume) in points(&nodes.map(|a| mesh.nodes[a])) {
            let force = body_force([lambda, g], at);
            for (a, &node) in nodes.iter().enumerate() {
                for (component, force) in force.into_iter().enumerate() {
                    model.loads.push(NodalValue {
                        node,
                        component,
                        value: volume * n[a] * force,
                        factor: Factor(vec![(0.0, 1.0)]),
                    });
                }
            }
        }
    }
    let edge = |x: f64| !(1e-9..1.0 - 1e-9).contains(&x);
    for node in nodes_where(&mesh, |x| edge(x[0]) || edge(x[1])) {
        for (component, u) in displacement(mesh.nodes[node]).into_iter().enumerate() {
            model.supports.push(growing(node, component, u));
        }
    }
    let mut statics = Statics::new(world, model, Touching::All, 2e-15)?;
    statics.advance(1.0)?;
    let u = statics.values()?;
    let energy = |h: [[f64; 2]; 2]| {
        let (trace, shear) = (h[0][0] + h[1][1], h[0][1] + h[1][0]);
        lambda * trace * trace
            + 2.0 * g * (h[0][0] * h[0][0] + h[1][1] * h[1][1] + 0.5 * shear * shear)
    };
    let mut sums = [[0.0; 2]; 2];
    for nodes in &mesh.elements {
        for (at, n, dn, volume) in points(&nodes.map(|a| mesh.nodes[a])) {
            let (exact, slope) = (displacement(at), gradient(at));
            let value = [0, 1].map(|k| (0..8).map(|a| n[a] * u[2 * nodes[a] + k]).sum::<f64>());
            let h = [0, 1].map(|k| {
                [0, 1].map(|i| (0..8).map(|a| dn[a][i] * u[2 * nodes[a] + k]).sum::<f64>())
            });
            let wrong = [0, 1].map(|k| [0, 1].map(|i| h[k][i] - slope[k][i]));
            sums[0][0] += volume * (0..2).map(|k| (value[k] - exact[k]).powi(2)).sum::<f64>();
            sums[0][1] += volume * (0..2).map(|k| exact[k].powi(2)).sum::<f64>();
            sums[1][0] += volume * energy(wrong);
            sums[1][1] += volume * energy(slope);
        }
    }
    Ok(sums.map(|[error, norm]| (error / norm).sqrt()))
}

fn manufactured(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Strang and Fix 1973, chapter 3: orders k + 1 and k for degree k = 2";
    let mut rows = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        let mut last: Option<[f64; 2]> = None;
        for n in [8, 16, 32] {
            let now = errors(world, n, quadrature)?;
            if let Some(last) = last {
                for (k, (name, order, tolerance)) in
                    [("L2 norm", 3.0, 0.1), ("energy norm", 2.0, 0.1)]
                        .into_iter()
                        .enumerate()
                {
                    let observed = (last[k] / now[k]).log2();
                    let quantity = format!(
                        "order in the {name}, {} to {n} elements per side (error {:.1e}); {quadrature:?} integration",
                        n / 2,
                        now[k]
                    );
                    rows.push(Row::absolute(quantity, observed, order, tolerance, SOURCE));
                }
            }
            last = Some(now);
        }
    }
    Ok(rows.into())
}
