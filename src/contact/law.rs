//! Contact of one point as a complementarity problem with a bound on the gap.
//!
//! Unknowns of a point are the multiplier λ (its contact force divided by Young's modulus, mm) and
//! the gap g ≥ 0 (mm). With φ the signed distance to the tool,
//!
//! ```text
//! equilibrium        F_u -= λ ∇φ N_a
//! closure            F_λ  = φ - g + C λ          = 0
//! complementarity    F_g  = λ - c (φ - g)        ⟂   g >= 0
//! ```
//!
//! On the reduced set of a semismooth Newton method for variational inequalities this is the
//! primal-dual active set method (Hintermüller, Ito, Kunisch 2003, SIAM J. Optim. 13, 865-888): an
//! inactive point has λ = 0, an active one φ + C λ = 0, where C is the compliance of the surface. λ has no bound: its
//! negative trial value is what releases a point.

mod slope;

pub use slope::{ContactAt, ContactLawSlope, ContactMotion, ContactSlope};

use super::closest::{Drift, closest};
use super::{ContactState, Friction, FrictionState, Traction};
use crate::element::edge_shape;
use crate::plane::{Vector, dot, interpolate};
use crate::tool::{Distance, Profile};

/// Weight c of the gap in the complementarity row. It must be small: release is decided by the sign
/// of λ - c φ at g = 0, where φ is the curvature error of the last Newton step (up to 1e-2 mm) and
/// λ a force divided by Young's modulus (1e-6 mm and more). With c near 1 that error outweighs any
/// real force and releases points that carry the load.
const COMPLEMENTARITY_WEIGHT: f64 = 1e-4;

/// Constants of a contact point.
#[derive(Clone, Copy, Debug)]
pub struct ContactLaw {
    /// Edge shape functions at the point; of a moving point at its middle position.
    pub shape: [f64; 3],
    /// Length of the edge (mm) if the point moves along it, to where the edge is closest to the tool.
    pub moves_on: Option<f64>,
    /// Compliance C of the surface for a unit multiplier, that of the model (mm/MPa) · E / (weight · length):
    /// millimetres per millimetre.
    pub compliance: f64,
    /// Friction, if there is any.
    pub friction: Option<Friction>,
}

/// Where a contact point is and how far from the tool.
#[derive(Clone, Copy, Debug)]
pub struct PointPosition {
    /// Current position, mm.
    pub x: Vector,
    /// Distance to the tool.
    pub distance: Distance,
    /// Edge shape functions at the point.
    pub shape: [f64; 3],
    /// How a moving point moves with the nodes; none at a fixed point or one held at an end.
    pub drift: Option<Drift>,
    /// What slid: arc length now less that of the same point of the sheet at the last accepted step,
    /// both in the tool's frame, mm; zero without friction.
    pub slip: f64,
    /// Derivative of the slip by the place on the edge, mm; for moving points.
    pub slip_slope: f64,
}

/// Residual rows of a contact point.
#[derive(Clone, Copy, Debug)]
pub struct ContactRows {
    /// Added to the equilibrium rows of the edge's nodes (x, y of each), mm.
    pub force: [f64; 6],
    /// Closure row, mm.
    pub closure: f64,
    /// Complementarity row, mm.
    pub complementarity: f64,
}

/// Tangent blocks of a contact point; `u` stands for the six displacements of the edge's nodes.
#[derive(Clone, Copy, Debug)]
pub struct ContactTangent {
    /// Equilibrium by displacement: -N_a N_b (λ ∇∇φ + λ_t ∇∇s + dλ_t/ds ∇s ∇s).
    pub force_u: [[f64; 6]; 6],
    /// Equilibrium by multiplier.
    pub force_multiplier: [f64; 6],
    /// Closure by displacement.
    pub closure_u: [f64; 6],
    /// Closure by multiplier: the compliance of [`ContactLaw`].
    pub compliance: f64,
    /// Closure by gap.
    pub closure_gap: f64,
    /// Complementarity by displacement.
    pub complementarity_u: [f64; 6],
    /// Complementarity by multiplier.
    pub complementarity_multiplier: f64,
    /// Complementarity by gap.
    pub complementarity_gap: f64,
}

impl ContactLaw {
    /// Position of the point and its distance to `tool`, whose points are moved by `shift` (mm).
    pub fn position(
        &self,
        nodes: &[Vector; 3],
        tool: &Profile,
        shift: Vector,
        state: &FrictionState,
    ) -> PointPosition {
        if let Some(length) = self.moves_on {
            return self.moving_position(nodes, tool, shift, state, length);
        }
        let x = interpolate(self.shape, nodes);
        let distance = tool.distance([x[0] - shift[0], x[1] - shift[1]]);
        PointPosition {
            x,
            slip: match self.friction {
                Some(_) => distance.arc_length() - state.arc_length,
                None => 0.0,
            },
            distance,
            shape: self.shape,
            drift: None,
            slip_slope: 0.0,
        }
    }

    fn moving_position(
        &self,
        nodes: &[Vector; 3],
        tool: &Profile,
        shift: Vector,
        state: &FrictionState,
        length: f64,
    ) -> PointPosition {
        let found = closest(nodes, tool, shift, length);
        let (mut slip, mut slip_slope) = (0.0, 0.0);
        if self.friction.is_some() {
            let before = tool.distance(interpolate(edge_shape(found.xi), &state.nodes));
            slip = found.distance.arc_length() - before.arc_length();
            if let Some(drift) = found.drift {
                let x_slope_before = interpolate(drift.shape_slope, &state.nodes);
                slip_slope = dot(found.distance.arc_gradient, drift.x_slope)
                    - dot(before.arc_gradient, x_slope_before);
            }
        }
        PointPosition {
            x: found.x,
            distance: found.distance,
            shape: edge_shape(found.xi),
            drift: found.drift,
            slip,
            slip_slope,
        }
    }

    /// Friction at the multiplier (mm), starting from the last accepted `state`.
    pub fn traction(
        &self,
        position: &PointPosition,
        multiplier: f64,
        state: &FrictionState,
    ) -> Traction {
        Traction::of(self.friction, multiplier, position.slip, state)
    }

    /// State of the point after an accepted step, at its multiplier and gap (mm), with the committed friction. During a
    /// solve [`Traction::state_at`] says it.
    pub fn committed_state(
        &self,
        multiplier: f64,
        gap: f64,
        committed: &FrictionState,
    ) -> ContactState {
        if gap > 0.0 || multiplier <= 0.0 {
            return ContactState::Open;
        }
        self.friction.map_or(ContactState::Stick, |friction| {
            friction.committed_state(multiplier, committed)
        })
    }

    /// Residual rows at multiplier and gap (mm).
    pub fn rows(
        &self,
        position: &PointPosition,
        multiplier: f64,
        gap: f64,
        traction: &Traction,
    ) -> ContactRows {
        let (distance, shape) = (&position.distance, &position.shape);
        let load: Vector = std::array::from_fn(|k| {
            multiplier * distance.gradient[k] + traction.value * distance.arc_gradient[k]
        });
        let force = std::array::from_fn(|i| -shape[i / 2] * load[i % 2]);
        ContactRows {
            force,
            closure: distance.value - gap + self.compliance * multiplier,
            complementarity: multiplier - COMPLEMENTARITY_WEIGHT * (distance.value - gap),
        }
    }

    /// Tangent of [`Self::rows`].
    pub fn tangent(
        &self,
        position: &PointPosition,
        multiplier: f64,
        traction: &Traction,
    ) -> ContactTangent {
        let (distance, shape) = (&position.distance, &position.shape);
        let (normal, along) = (&distance.gradient, &distance.arc_gradient);
        let (hessian, arc_hessian) = (distance.hessian.rows(), distance.arc_hessian.rows());
        let stiffness = |i: usize, j: usize| {
            multiplier * hessian[i][j]
                + traction.value * arc_hessian[i][j]
                + traction.by_arc_length * along[i] * along[j]
        };
        let slope: [f64; 6] = std::array::from_fn(|i| shape[i / 2] * normal[i % 2]);
        let mut force_u: [[f64; 6]; 6] = std::array::from_fn(|i| {
            std::array::from_fn(|j| -shape[i / 2] * shape[j / 2] * stiffness(i % 2, j % 2))
        });
        if let Some(drift) = &position.drift {
            add_drift(&mut force_u, position, drift, multiplier, traction);
        }
        ContactTangent {
            force_u,
            force_multiplier: std::array::from_fn(|i| {
                -slope[i] - shape[i / 2] * traction.by_multiplier * along[i % 2]
            }),
            closure_u: slope,
            compliance: self.compliance,
            closure_gap: -1.0,
            complementarity_u: slope.map(|s| -COMPLEMENTARITY_WEIGHT * s),
            complementarity_multiplier: 1.0,
            complementarity_gap: COMPLEMENTARITY_WEIGHT,
        }
    }
}

/// Adds what the motion of the point along its edge does to the equilibrium rows: the rank-one term of
/// the envelope theorem, and for friction, whose slip and place move with the point, the chain rule.
fn add_drift(
    force_u: &mut [[f64; 6]; 6],
    position: &PointPosition,
    drift: &Drift,
    multiplier: f64,
    traction: &Traction,
) {
    let distance = &position.distance;
    let turned = distance.arc_hessian.times(drift.x_slope);
    for (i, row) in force_u.iter_mut().enumerate() {
        let (n, slope, along) = (
            position.shape[i / 2],
            drift.shape_slope[i / 2],
            distance.arc_gradient[i % 2],
        );
        let by_place = traction.value * (n * turned[i % 2] + slope * along)
            + traction.by_arc_length * position.slip_slope * n * along;
        let factor = multiplier * drift.curvature * drift.by_u[i] - by_place;
        for (entry, by_u) in row.iter_mut().zip(drift.by_u) {
            *entry += factor * by_u;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::die;

    #[test]
    fn the_tangent_agrees_with_central_differences() {
        let tool = die(25.0, 4.0, 60.0);
        // Open to friction: none, sticking, and slipping either way.
        let slips = [None, Some(0.0), Some(0.9), Some(-0.9)];
        for slip in slips {
            for moves in [false, true] {
                tangent_agrees(&tool, slip, moves);
            }
        }
    }

    fn tangent_agrees(tool: &Profile, slip: Option<f64>, moves: bool) {
        let law = ContactLaw {
            shape: crate::element::edge_shape(0.3),
            compliance: 12.0,
            moves_on: moves.then_some(0.8),
            friction: slip.map(|_| Friction {
                coefficient: 0.2,
                compliance: 120.0,
            }),
        };
        // Bent less than the shoulder, which it touches near its middle.
        let nodes = [[26.25, -1.1], [26.65, -0.77], [26.45, -0.931]];
        let (multiplier, gap, h) = (3e-4, 0.02, 1e-6);
        let mut state = FrictionState::default();
        let distance = law.position(&nodes, tool, [0.0; 2], &state).distance;
        let slip_before = slip.unwrap_or(0.0);
        state = FrictionState {
            traction: 1e-5,
            arc_length: distance.arc_length() - slip_before,
            nodes: nodes.map(|[x, y]| {
                let along = distance.arc_gradient.map(|g| slip_before * g);
                [x - along[0] + 0.01 * (x - 26.4), y - along[1]]
            }),
        };
        let rows = |nodes: &[Vector; 3], multiplier: f64, gap: f64| {
            let position = law.position(nodes, tool, [0.0; 2], &state);
            let traction = law.traction(&position, multiplier, &state);
            law.rows(&position, multiplier, gap, &traction)
        };
        let position = law.position(&nodes, tool, [0.0; 2], &state);
        let traction = law.traction(&position, multiplier, &state);
        assert_eq!(traction.by_arc_length != 0.0, slip == Some(0.0));
        assert_eq!(position.drift.is_some(), moves);
        let exact = law.tangent(&position, multiplier, &traction);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-8 * (1.0 + b.abs()), "{a} {b}");
        for j in 0..6 {
            let (mut plus, mut minus) = (nodes, nodes);
            plus[j / 2][j % 2] += h;
            minus[j / 2][j % 2] -= h;
            let (up, down) = (rows(&plus, multiplier, gap), rows(&minus, multiplier, gap));
            for i in 0..6 {
                close(
                    exact.force_u[i][j],
                    (up.force[i] - down.force[i]) / (2.0 * h),
                );
            }
            close(exact.closure_u[j], (up.closure - down.closure) / (2.0 * h));
            let slope = (up.complementarity - down.complementarity) / (2.0 * h);
            close(exact.complementarity_u[j], slope);
        }
        let (up, down) = (
            rows(&nodes, multiplier + h, gap),
            rows(&nodes, multiplier - h, gap),
        );
        for i in 0..6 {
            close(
                exact.force_multiplier[i],
                (up.force[i] - down.force[i]) / (2.0 * h),
            );
        }
        close(exact.compliance, (up.closure - down.closure) / (2.0 * h));
        let slope = (up.complementarity - down.complementarity) / (2.0 * h);
        close(exact.complementarity_multiplier, slope);
        let (up, down) = (
            rows(&nodes, multiplier, gap + h),
            rows(&nodes, multiplier, gap - h),
        );
        close(exact.closure_gap, (up.closure - down.closure) / (2.0 * h));
        let slope = (up.complementarity - down.complementarity) / (2.0 * h);
        close(exact.complementarity_gap, slope);
    }
}
