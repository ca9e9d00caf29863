//! Patch tests on a distorted mesh.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::Factor;

use crate::flow::{Constants, bisect};
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Side, Statics, Touching, growing, held, nodes_where, problem, traction};

const LENGTH: f64 = 3.0;
const HEIGHT: f64 = 2.0;

/// A rectangle whose inner nodes are moved by a fifth of an element, with straight sides.
pub fn distorted(nx: usize, ny: usize) -> SheetMesh {
    SheetMesh::new(LENGTH, HEIGHT, nx, ny)
        .mapped(|[x, y]| {
            let bump = (7.0 * x + 3.0 * y).sin() * inside([x, y]);
            let other = (5.0 * y - 4.0 * x).cos() * inside([x, y]);
            [
                x + 0.2 * LENGTH / nx as f64 * bump,
                y + 0.2 * HEIGHT / ny as f64 * other,
            ]
        })
        .straightened()
}

fn inside([x, y]: [f64; 2]) -> f64 {
    let within = |x: f64, end: f64| x > 1e-9 && x < end - 1e-9;
    f64::from(u8::from(within(x, LENGTH) && within(y, HEIGHT)))
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, v| m.max(v.abs()))
}

pub const DISPLACEMENT: Case = Case {
    name: "patch_displacement",
    title: "Elements: patch test with prescribed displacements",
    text: "4 x 3 distorted elements; the outer nodes follow u = (F - 1) X. The inner ones must do so too, and the Cauchy stress must be \
that of the material point everywhere: elastic at small strain, and with plastic strains of 0.18 and a rotation in ten steps. \
Tolerance: the convergence of Newton's method.",
    quick: true,
    two_ranks: true,
    run: displacement,
};

fn displacement(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "linear displacements are a solution (Irons and Razzaque 1972)";
    let mut rows = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        for (size, steps) in [(1e-4, 1), (0.2, 10)] {
            let constants = Constants::aluminium();
            let gradient = [[0.8 * size, 0.9 * size], [-0.3 * size, -0.7 * size]];
            let mesh = distorted(4, 3);
            let exact = |[x, y]: [f64; 2]| gradient.map(|row| row[0] * x + row[1] * y);
            let outer = nodes_where(&mesh, |x| inside(x) == 0.0);
            let mut patch = problem(mesh.clone(), &constants, quadrature);
            for node in outer {
                for (component, value) in exact(mesh.nodes[node]).into_iter().enumerate() {
                    patch.supports.push(growing(node, component, value));
                }
            }
            let mut statics = Statics::new(world, patch, Touching::All, 1e-13)?;
            let mut state = ssnp155::material::PointState::VIRGIN;
            let mut stress = [0.0; 4];
            for step in 1..=steps {
                let t = f64::from(step) / f64::from(steps);
                statics.advance(t)?;
                let [[a, b], [c, d]] = gradient.map(|row| row.map(|g| t * g));
                let f = [[1.0 + a, b], [c, 1.0 + d]];
                let response = constants.material().respond(&f, &state)?;
                state = response.state();
                let [xx, yy, zz, xy] = response.kirchhoff.components();
                let volume = f[0][0] * f[1][1] - f[0][1] * f[1][0];
                stress = [xx, yy, zz, xy].map(|s| s / volume);
            }
            let values = statics.values()?;
            let errors = mesh.nodes.iter().enumerate().flat_map(|(n, &x)| {
                let u = exact(x);
                [values[2 * n] - u[0], values[2 * n + 1] - u[1]]
            });
            let label = format!(
                "{quadrature:?} integration, strain {size}, plastic strain {:.2}",
                state.equivalent_plastic_strain
            );
            rows.push(Row::absolute(
                format!("largest error of a displacement over the strain, mm; {label}"),
                largest(errors) / size,
                0.0,
                1e-10,
                SOURCE,
            ));
            let stresses = statics.stresses()?;
            let errors = stresses
                .iter()
                .flat_map(|s| (0..4).map(move |i| s[i] - stress[i]));
            rows.push(Row::absolute(
                format!("largest error of a stress over the largest stress; {label}"),
                largest(errors) / largest(stress),
                0.0,
                1e-9,
                SOURCE,
            ));
        }
    }
    Ok(rows.into())
}

pub const TRACTION: Case = Case {
    name: "patch_traction",
    title: "Elements: patch test with prescribed tractions",
    text: "The same elements, elastic, held as lightly as possible and loaded by a dead traction P on the right side, to a logarithmic \
strain of 0.1. Kirchhoff stress E/(1-ν²) ln λ and P = stress/λ give the stretches λ in x and λ^(-ν/(1-ν)) in y. Tolerance: the convergence of Newton's method.",
    quick: true,
    two_ranks: true,
    run: loaded,
};

fn loaded(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "closed form (Hencky elasticity, Anand 1979)";
    let constants = Constants::elastic();
    let mut rows = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        let tension = constants.plane_modulus() * 0.1 / 0.1_f64.exp();
        let strain = bisect(0.0, 0.5, |e| {
            constants.plane_modulus() * e / e.exp() - tension
        });
        let mesh = distorted(4, 3);
        let factor = Factor(vec![(0.0, 0.0), (1.0, 1.0)]);
        let mut patch = problem(mesh.clone(), &constants, quadrature);
        patch.loads = traction(&mesh, Side::Right, |_| [tension, 0.0], &factor);
        let left = nodes_where(&mesh, |x| x[0] == 0.0);
        patch.supports = left.iter().map(|&n| held(n, 0)).collect();
        patch.supports.push(held(left[0], 1));
        let mut statics = Statics::new(world, patch, Touching::All, 1e-12)?;
        for step in 1..=4 {
            statics.advance(f64::from(step) / 4.0)?;
        }
        let ratio = -constants.poisson / (1.0 - constants.poisson);
        let stretch = [strain.exp_m1(), (ratio * strain).exp_m1()];
        let values = statics.values()?;
        let errors = mesh
            .nodes
            .iter()
            .enumerate()
            .flat_map(|(n, x)| [0, 1].map(|k| values[2 * n + k] - stretch[k] * x[k]));
        rows.push(Row::absolute(
            format!("largest error of a displacement, mm; {quadrature:?} integration"),
            largest(errors),
            0.0,
            1e-10,
            SOURCE,
        ));
        let corner = statics.displacement(mesh.nodes.len() - 1)?;
        let quantity = format!("elongation, mm; {quadrature:?} integration");
        rows.push(Row::relative(
            quantity,
            corner[0],
            LENGTH * stretch[0],
            1e-10,
            SOURCE,
        ));
    }
    Ok(rows.into())
}
