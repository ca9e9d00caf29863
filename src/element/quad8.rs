//! The eight-node element in plane strain, total displacements, per millimetre of width.

mod slope;

pub use slope::{EvaluatedPoint, PointMotion, Quad8Slope};

use super::{Quadrature, gauss_points, shape, shape_gradients};
use crate::material::{DeformationError, PointState, Response, VonMises};
use crate::plane::{Matrix, PlaneTensor, Vector, determinant};

/// Degrees of freedom of an element: x and y of each node, node by node.
const DOFS: usize = 16;

/// Geometry of one element in the reference configuration.
#[derive(Clone, Debug)]
pub struct Quad8 {
    /// Per Gauss point: gradients of the shape functions with respect to X (1/mm), and the weight
    /// times the Jacobian determinant (mm², that is mm³ per millimetre of width).
    points: Vec<([Vector; 8], f64)>,
    /// Consistent mass between nodes for unit density, mm².
    mass: [[f64; 8]; 8],
}

/// Internal force and, on request, its tangent.
#[derive(Clone, Copy, Debug)]
pub struct ElementForce {
    /// Internal force, N per mm of width.
    pub force: [f64; DOFS],
    /// Tangent stiffness between nodes a <= b, at `[a][b]`, N/mm per mm of width; left alone if it was not asked for. That
    /// between b and a is its transpose.
    pub stiffness: [[NodeBlock; 8]; 8],
}

/// Entries between two nodes: rows x and y of the first, columns x and y of the second.
pub type NodeBlock = [[f64; 2]; 2];

/// A Gauss point whose return map failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("Gauss point {point}: {cause}")]
pub struct GaussPointFailure {
    /// Which Gauss point of the element.
    pub point: usize,
    /// Why.
    pub cause: DeformationError,
}

impl Quad8 {
    /// From the reference coordinates of the nodes (mm).
    pub fn new(nodes: &[Vector; 8], quadrature: Quadrature) -> Self {
        let points = gauss_points(quadrature)
            .into_iter()
            .map(|(xi, weight)| {
                let (gradients, determinant) = reference_gradients(nodes, xi);
                (gradients, weight * determinant)
            })
            .collect();
        let mut mass = [[0.0; 8]; 8];
        // The mass is integrated exactly whatever the rule of the stiffness.
        for (xi, weight) in gauss_points(Quadrature::Full) {
            let n = shape(xi);
            let volume = weight * reference_gradients(nodes, xi).1;
            for a in 0..8 {
                for b in 0..8 {
                    mass[a][b] += volume * n[a] * n[b];
                }
            }
        }
        Self { points, mass }
    }

    /// Consistent mass for unit density between nodes a and b, mm².
    pub fn mass(&self) -> &[[f64; 8]; 8] {
        &self.mass
    }

    /// Number of Gauss points.
    pub fn point_count(&self) -> usize {
        self.points.len()
    }

    /// Response of one Gauss point at displacements `u` (mm) with its deformation gradient and its
    /// reference volume (mm² per mm of width, times mm).
    #[inline]
    pub fn point_response(
        &self,
        point: usize,
        u: &[Vector; 8],
        material: &VonMises,
        state: &PointState,
    ) -> Result<(Response, Matrix, f64), GaussPointFailure> {
        let (gradients, volume) = &self.points[point];
        let f = deformation_gradient(gradients, u);
        let response = material
            .respond(&f, state)
            .map_err(|cause| GaussPointFailure { point, cause })?;
        Ok((response, f, *volume))
    }

    /// Internal force at displacements `u` (mm) from the committed `states`, and the tangent if
    /// `with_stiffness`. States are not changed.
    pub fn internal_force(
        &self,
        u: &[Vector; 8],
        material: &VonMises,
        states: &[PointState],
        with_stiffness: bool,
        out: &mut ElementForce,
    ) -> Result<(), GaussPointFailure> {
        out.force = [0.0; DOFS];
        if with_stiffness {
            out.stiffness = ElementForce::ZERO.stiffness;
        }
        for (point, state) in states.iter().enumerate() {
            let (response, f, volume) = self.point_response(point, u, material, state)?;
            let gradients = spatial_gradients(&self.points[point].0, &f);
            let PlaneTensor { xx, yy, xy, .. } = response.kirchhoff;
            // Traction of each node's gradient, τ · ∇N.
            let traction = gradients.map(|g| {
                [
                    volume * (xx * g[0] + xy * g[1]),
                    volume * (xy * g[0] + yy * g[1]),
                ]
            });
            for (force, traction) in out.force.chunks_exact_mut(2).zip(&traction) {
                force[0] += traction[0];
                force[1] += traction[1];
            }
            if with_stiffness {
                add_stiffness(
                    &gradients,
                    &response.tangent(),
                    volume,
                    &traction,
                    &mut out.stiffness,
                );
            }
        }
        Ok(())
    }
}

impl ElementForce {
    /// All zeros.
    pub const ZERO: Self = Self {
        force: [0.0; DOFS],
        stiffness: [[[[0.0; 2]; 2]; 8]; 8],
    };
}

/// Adds material and geometric stiffness of one Gauss point.
fn add_stiffness(
    gradients: &[Vector; 8],
    tangent: &[[f64; 3]; 3],
    volume: f64,
    traction: &[Vector; 8],
    stiffness: &mut [[NodeBlock; 8]; 8],
) {
    for b in 0..8 {
        let [bx, by] = gradients[b];
        // Stress rates (xx, yy, xy) for unit velocities of node b in x and y.
        let rate: [Vector; 3] = tangent.map(|row| {
            [
                volume * (row[0] * bx + row[2] * by),
                volume * (row[1] * by + row[2] * bx),
            ]
        });
        for a in 0..=b {
            let [ax, ay] = gradients[a];
            let geometric = traction[a][0] * bx + traction[a][1] * by;
            let [x, y] = &mut stiffness[a][b];
            for j in 0..2 {
                x[j] += ax * rate[0][j] + ay * rate[2][j];
                y[j] += ay * rate[1][j] + ax * rate[2][j];
            }
            x[0] += geometric;
            y[1] += geometric;
        }
    }
}

/// Gradients of the shape functions with respect to X, and the Jacobian determinant.
fn reference_gradients(nodes: &[Vector; 8], xi: [f64; 2]) -> ([Vector; 8], f64) {
    let local = shape_gradients(xi);
    // jacobian[i][j] = dX_i / dξ_j
    let mut jacobian = [[0.0; 2]; 2];
    for (x, g) in nodes.iter().zip(&local) {
        for i in 0..2 {
            for j in 0..2 {
                jacobian[i][j] += x[i] * g[j];
            }
        }
    }
    let determinant = determinant(&jacobian);
    (transform(&local, &jacobian, determinant), determinant)
}

/// Gradients with respect to x from those with respect to X.
fn spatial_gradients(reference: &[Vector; 8], f: &Matrix) -> [Vector; 8] {
    transform(reference, f, determinant(f))
}

/// Each gradient times the inverse of `map`.
fn transform(gradients: &[Vector; 8], map: &Matrix, determinant: f64) -> [Vector; 8] {
    gradients.map(|g| {
        [
            (g[0] * map[1][1] - g[1] * map[1][0]) / determinant,
            (g[1] * map[0][0] - g[0] * map[0][1]) / determinant,
        ]
    })
}

/// F = I + Σ u_a ⊗ ∇N_a.
fn deformation_gradient(gradients: &[Vector; 8], u: &[Vector; 8]) -> Matrix {
    let mut f = [[1.0, 0.0], [0.0, 1.0]];
    for (u, g) in u.iter().zip(gradients) {
        for i in 0..2 {
            for j in 0..2 {
                f[i][j] += u[i] * g[j];
            }
        }
    }
    f
}
