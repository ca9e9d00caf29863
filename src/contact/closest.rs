//! The point of an edge that is closest to a tool, as a function of the edge's nodes.
//!
//! With x(ξ) the point of the edge and φ the signed distance,
//!
//! ```text
//! φ*(u) = min over ξ in [-1, 1] of  ψ(ξ, u) = φ(x(ξ, u)) + κ ξ² / 2
//! ```
//!
//! By the envelope theorem the gradient of φ* is that of ψ at a fixed ξ; its Hessian has the further
//! term -ψ_ξu ψ_ξu / ψ_ξξ where the minimum is inside, and none where it is an end. The small κ makes
//! the minimum unique where the edge lies flat on the tool or fits it (φ_ξξ near zero); it belongs to
//! the function that is minimised, so the tangent stays exact and symmetric.

use crate::element::{EDGE_SHAPE_CURVATURES, edge_shape, edge_shape_slopes};
use crate::plane::{Vector, interpolate};
use crate::tool::{Distance, Profile};

/// An edge fits a tool when the radius of their relative curvature is beyond this, mm: then its middle
/// is preferred.
const FIT_RADIUS: f64 = 100.0;
/// Pieces into which the edge is divided to find the lowest valley.
const PIECES: usize = 8;
/// Halvings that take the valley's width to rounding, when Newton's method does not.
const MOST_ITERATIONS: usize = 60;
/// Two positions on the edge closer than this are the same.
const SAME_POSITION: f64 = 1e-14;

/// The closest point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest {
    pub xi: f64,
    pub x: Vector,
    /// Distance there; its value is φ*.
    pub distance: Distance,
    /// How the point moves, unless it is held at an end.
    pub drift: Option<Drift>,
}

/// How a moving contact point moves along its edge.
#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// Derivative of the shape functions by ξ.
    pub shape_slope: [f64; 3],
    /// Derivative of the position by ξ, mm.
    pub x_slope: Vector,
    /// Derivative of ξ by the nodes' coordinates, 1/mm.
    pub by_u: [f64; 6],
    /// Second derivative of the minimised function by ξ, mm.
    pub curvature: f64,
}

/// What is minimised, with its first two derivatives by ξ.
struct Valley {
    x: Vector,
    distance: Distance,
    x_slope: Vector,
    value: f64,
    slope: f64,
    curvature: f64,
}

fn valley(nodes: &[Vector; 3], tool: &Profile, shift: Vector, xi: f64, kappa: f64) -> Valley {
    let x = interpolate(edge_shape(xi), nodes);
    let x_slope = interpolate(edge_shape_slopes(xi), nodes);
    let x_curvature = interpolate(EDGE_SHAPE_CURVATURES, nodes);
    let distance = tool.distance([x[0] - shift[0], x[1] - shift[1]]);
    let normal = distance.gradient;
    let turned = distance.hessian.times(x_slope);
    Valley {
        value: distance.value + 0.5 * kappa * xi * xi,
        slope: normal[0] * x_slope[0] + normal[1] * x_slope[1] + kappa * xi,
        curvature: turned[0] * x_slope[0]
            + turned[1] * x_slope[1]
            + normal[0] * x_curvature[0]
            + normal[1] * x_curvature[1]
            + kappa,
        x,
        distance,
        x_slope,
    }
}

/// The closest point of the edge with the given nodes, `length` (mm) long at first, to the tool moved
/// by `shift` (mm).
pub(super) fn closest(nodes: &[Vector; 3], tool: &Profile, shift: Vector, length: f64) -> Closest {
    let kappa = 0.25 * length * length / FIT_RADIUS;
    let at = |xi: f64| valley(nodes, tool, shift, xi, kappa);
    let position = |i: usize| 2.0 * i as f64 / PIECES as f64 - 1.0;
    let value = |i: usize| at(position(i)).value;
    let lowest = (1..=PIECES).fold((0, value(0)), |best, i| {
        let value = value(i);
        if value < best.1 { (i, value) } else { best }
    });
    let mut left = position(lowest.0.saturating_sub(1));
    let mut right = position((lowest.0 + 1).min(PIECES));
    let mut xi = position(lowest.0);
    let mut here = at(xi);
    for _ in 0..MOST_ITERATIONS {
        if here.slope > 0.0 {
            right = xi;
        } else {
            left = xi;
        }
        let newton = xi - here.slope / here.curvature;
        let next = if here.curvature > 0.0 && newton >= left && newton <= right {
            newton
        } else if here.slope > 0.0 && left == -1.0 && at(-1.0).slope > 0.0 {
            -1.0
        } else if here.slope < 0.0 && right == 1.0 && at(1.0).slope < 0.0 {
            1.0
        } else {
            0.5 * (left + right)
        };
        let moved = (next - xi).abs();
        xi = next;
        here = at(xi);
        if moved < SAME_POSITION {
            break;
        }
    }
    let mut distance = here.distance;
    distance.value = here.value;
    let held = (xi <= -1.0 && here.slope >= 0.0) || (xi >= 1.0 && here.slope <= 0.0);
    let shape = edge_shape(xi);
    let shape_slope = edge_shape_slopes(xi);
    let turned = here.distance.hessian.times(here.x_slope);
    let drift = (!held && here.curvature > 0.0).then(|| Drift {
        by_u: std::array::from_fn(|i| {
            let by_x = shape[i / 2] * turned[i % 2];
            let by_slope = shape_slope[i / 2] * here.distance.gradient[i % 2];
            -(by_x + by_slope) / here.curvature
        }),
        shape_slope,
        x_slope: here.x_slope,
        curvature: here.curvature,
    });
    Closest {
        xi,
        x: here.x,
        distance,
        drift,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::die;

    #[test]
    fn no_other_point_of_the_edge_is_closer() {
        let tool = die(25.0, 4.0, 60.0);
        // Over the shoulder, on the flat, across its edge, in the cavity.
        for nodes in [
            [[26.2, -1.1], [26.9, -0.7], [26.5, -0.85]],
            [[30.0, 0.0], [30.4, 0.0], [30.2, 0.0]],
            [[28.9, 0.0], [29.2, 0.01], [29.1, 0.0]],
            [[1.0, -28.9], [1.4, -28.9], [1.2, -28.91]],
        ] {
            let length = 0.4;
            let found = closest(&nodes, &tool, [0.0; 2], length);
            let kappa = 0.25 * length * length / FIT_RADIUS;
            for i in 0..=1000 {
                let xi = f64::from(i) / 500.0 - 1.0;
                let other = valley(&nodes, &tool, [0.0; 2], xi, kappa).value;
                assert!(found.distance.value <= other + 1e-12, "{nodes:?} at {xi}");
            }
        }
    }
}
