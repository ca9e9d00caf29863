//! Signed distance of a point to a profile, with all that contact needs of it.

use crate::plane::{SymmetricMatrix, Vector};

/// Signed distance of a point to a profile with its derivatives, and the arc length of the foot
/// point with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Signed distance, mm; positive on the free side.
    pub value: f64,
    /// Its gradient, the outward normal at the foot point.
    pub gradient: Vector,
    /// Its Hessian, 1/mm.
    pub hessian: SymmetricMatrix,
    /// Arc length of the foot point from the start of the chain, mm.
    pub arc_length: f64,
    /// Gradient of the arc length.
    pub arc_gradient: Vector,
    /// Hessian of the arc length, 1/mm.
    pub arc_hessian: SymmetricMatrix,
}

/// Below this distance from an arc's centre the direction to the foot point is arbitrary, mm.
pub(super) const CENTRE_RADIUS: f64 = 1e-9;

/// `scale` times (I - n n).
#[inline]
pub(super) fn tangential_projector(n: Vector, scale: f64) -> SymmetricMatrix {
    SymmetricMatrix {
        xx: scale * n[1] * n[1],
        yy: scale * n[0] * n[0],
        xy: -scale * n[0] * n[1],
    }
}
