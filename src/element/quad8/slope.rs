//! How the internal force of an element moves with a parameter of the problem, along with its nodes and displacements.
//!
//! With V the motion of the nodes in the reference configuration and v = V + du that in space, ℓ = grad v, g the gradient
//! of a shape function in space and w the reference volume of a Gauss point,
//!
//! ```text
//! dF = ℓ F - F grad V      dw = w div V      dg = -ℓᵀ g      d(w τ g) = (w dτ - w τ ℓᵀ + dw τ) g
//! ```

use super::{Quad8, spatial_gradients};
use crate::material::{Linearised, Response};
use crate::plane::{Matrix, PlaneTensor, Vector, product};

/// How the reference geometry of an element moves with a parameter.
#[derive(Clone, Debug)]
pub struct Quad8Slope {
    /// Motion of the nodes, mm per unit.
    nodes: [Vector; 8],
    /// Its gradient at each Gauss point.
    gradients: Vec<Matrix>,
    mass: [[f64; 8]; 8],
}

/// A Gauss point at accepted displacements.
#[derive(Clone, Debug)]
pub struct EvaluatedPoint {
    /// What the material answers.
    pub response: Linearised,
    /// How far beyond the yield surface the trial stress is, as a share of the flow stress.
    pub excess: f64,
    deformation: Matrix,
    /// Of the shape functions in space, 1/mm.
    gradients: [Vector; 8],
    /// Reference volume, mm³ per millimetre of width.
    volume: f64,
}

/// How the surroundings of a Gauss point move.
#[derive(Clone, Copy, Debug)]
pub struct PointMotion {
    /// Derivative of the deformation gradient.
    pub deformation: Matrix,
    /// Gradient of the motion in space.
    velocity: Matrix,
    /// Derivative of the reference volume, as a share of it.
    volume: f64,
}

impl PointMotion {
    /// Nothing moves.
    pub const STILL: Self = Self {
        deformation: [[0.0; 2]; 2],
        velocity: [[0.0; 2]; 2],
        volume: 0.0,
    };
}

impl Quad8Slope {
    /// Of an element whose nodes move this way (mm per unit); `sides` are the elements with more and with less of the
    /// parameter, `width` of it apart.
    pub fn new(of: &Quad8, nodes: [Vector; 8], sides: [&Quad8; 2], width: f64) -> Self {
        let [above, below] = sides;
        let mass = |a: usize, b: usize| (above.mass[a][b] - below.mass[a][b]) / width;
        let points = of.points.iter();
        Self {
            gradients: points.map(|(g, _)| motion_gradient(&nodes, g)).collect(),
            mass: std::array::from_fn(|a| std::array::from_fn(|b| mass(a, b))),
            nodes,
        }
    }

    /// Derivative of the consistent mass for unit density between nodes a and b, mm² per unit.
    pub fn mass(&self) -> &[[f64; 8]; 8] {
        &self.mass
    }
}

impl Quad8 {
    /// A Gauss point whose material gave this response, with this excess, to this deformation gradient.
    pub fn evaluated(
        &self,
        point: usize,
        response: Response,
        deformation: Matrix,
        excess: f64,
    ) -> EvaluatedPoint {
        let (gradients, volume) = &self.points[point];
        EvaluatedPoint {
            response: response.linearised(),
            excess,
            gradients: spatial_gradients(gradients, &deformation),
            deformation,
            volume: *volume,
        }
    }
}

impl EvaluatedPoint {
    /// Where displacements move by `du` (mm per unit) and the reference configuration by that of the element, if it moves.
    /// `point`: number of this Gauss point in its element.
    pub fn motion(&self, point: usize, du: &[Vector; 8], of: Option<&Quad8Slope>) -> PointMotion {
        let Some(of) = of else {
            let velocity = motion_gradient(du, &self.gradients);
            return PointMotion {
                deformation: product(&velocity, &self.deformation),
                velocity,
                volume: 0.0,
            };
        };
        let v: [Vector; 8] = std::array::from_fn(|a| [0, 1].map(|k| du[a][k] + of.nodes[a][k]));
        let (velocity, reference) = (motion_gradient(&v, &self.gradients), &of.gradients[point]);
        let moved = product(&velocity, &self.deformation);
        let stretched = product(&self.deformation, reference);
        PointMotion {
            deformation: [0, 1].map(|i| [0, 1].map(|j| moved[i][j] - stretched[i][j])),
            velocity,
            volume: reference[0][0] + reference[1][1],
        }
    }

    /// Derivative of the point's share of the forces on the nodes, N per mm of width and unit, with that of the Kirchhoff
    /// stress.
    pub fn force_slope(&self, motion: &PointMotion, stress: &PlaneTensor) -> [Vector; 8] {
        let (tau, by) = (
            self.response.response().kirchhoff.in_plane().rows(),
            stress.in_plane().rows(),
        );
        let along = |i: usize, j: usize| {
            let turned = tau[i][0] * motion.velocity[j][0] + tau[i][1] * motion.velocity[j][1];
            self.volume * (by[i][j] - turned + motion.volume * tau[i][j])
        };
        let s = [[along(0, 0), along(0, 1)], [along(1, 0), along(1, 1)]];
        self.gradients
            .map(|g| s.map(|row| row[0] * g[0] + row[1] * g[1]))
    }
}

/// Σ v_a ⊗ g_a.
fn motion_gradient(v: &[Vector; 8], gradients: &[Vector; 8]) -> Matrix {
    let mut sum = [[0.0; 2]; 2];
    for (v, g) in v.iter().zip(gradients) {
        for i in 0..2 {
            for j in 0..2 {
                sum[i][j] += v[i] * g[j];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{ElementForce, NODES, Quadrature};
    use crate::material::{Hardening, MaterialSlope, PointState, VonMises};

    #[test]
    fn the_slope_of_the_force_agrees_with_central_differences() {
        let hardening = Hardening::from_points(&[(0.0028, 196.0), (0.1, 300.0)], 7e4).unwrap();
        let material = VonMises::new(7e4, 0.342, hardening);
        let nodes_at = |by: f64| {
            NODES.map(|[x, y]| {
                [
                    0.2 * x + by * 0.1 * x * y,
                    0.1 * y + by * (0.2 * y + 0.1 * x * x),
                ]
            })
        };
        let u_at =
            |by: f64| NODES.map(|[x, y]| [0.004 * x * y + by * x * y * y, by * 0.3 * x + 1e-3 * y]);
        let h = 1e-6;
        let [above, below] = [h, -h].map(|by| Quad8::new(&nodes_at(by), Quadrature::Reduced));
        let here = Quad8::new(&nodes_at(0.0), Quadrature::Reduced);
        let states = vec![PointState::VIRGIN; here.point_count()];
        let force = |element: &Quad8, by: f64| {
            let mut out = ElementForce::ZERO;
            let u = u_at(by);
            element
                .internal_force(&u, &material, &states, false, &mut out)
                .unwrap();
            out.force
        };
        let difference = |above: f64, below: f64| (above - below) / (2.0 * h);
        let [more, less] = [force(&above, h), force(&below, -h)];
        let slopes = |f: &dyn Fn(f64) -> [Vector; 8]| -> [Vector; 8] {
            let (a, b) = (f(h), f(-h));
            std::array::from_fn(|i| [0, 1].map(|k| difference(a[i][k], b[i][k])))
        };
        let moves = Quad8Slope::new(&here, slopes(&nodes_at), [&above, &below], 2.0 * h);
        let (du, mut exact) = (slopes(&u_at), [[0.0; 2]; 8]);
        let by = MaterialSlope::between(&material, &material, 1.0);
        let mut yields = 0;
        for (point, state) in states.iter().enumerate() {
            let (response, f, _) = here
                .point_response(point, &u_at(0.0), &material, state)
                .unwrap();
            let at = here.evaluated(point, response, f, 0.0);
            yields += usize::from(response.yields());
            let motion = at.motion(point, &du, Some(&moves));
            let stress = at
                .response
                .slope(&motion.deformation, &PointState::STILL, &by)
                .kirchhoff;
            for (sum, force) in exact.iter_mut().zip(at.force_slope(&motion, &stress)) {
                *sum = [0, 1].map(|k| sum[k] + force[k]);
            }
        }
        assert!(yields > 0);
        for (i, exact) in exact.as_flattened().iter().enumerate() {
            let difference = difference(more[i], less[i]);
            assert!(
                (exact - difference).abs() < 1e-6 * (difference.abs() + 1e3),
                "{i}: {exact} {difference}"
            );
        }
    }
}
