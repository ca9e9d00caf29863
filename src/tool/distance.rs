//! Signed distance of a point to a profile, with all that contact needs of it.

use std::f64::consts::{PI, TAU};

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
    /// Gradient of the arc length.
    pub arc_gradient: Vector,
    /// Hessian of the arc length, 1/mm.
    pub arc_hessian: SymmetricMatrix,
    /// Arc length of the foot point's piece from the start of the chain, mm.
    pub(super) piece_start: f64,
    /// Where on its piece the foot point is.
    pub(super) along: Along,
}

impl Distance {
    /// Arc length of the foot point from the start of the chain, mm. Only friction needs it, and an arc has to find an angle.
    pub fn arc_length(&self) -> f64 {
        self.piece_start + self.along.arc_length()
    }
}

/// Where a foot point is on its piece.
#[derive(Clone, Copy, Debug)]
pub(super) enum Along {
    /// This far from the start of the piece, mm.
    Known(f64),
    /// On an arc.
    OnArc {
        /// mm.
        radius: f64,
        /// Sine and cosine of the angle from the first point, in the direction of the walk.
        sin: f64,
        cos: f64,
        /// Angle from the first point to the last, radians.
        span: f64,
    },
}

impl Along {
    fn arc_length(self) -> f64 {
        match self {
            Self::Known(length) => length,
            Self::OnArc {
                radius,
                sin,
                cos,
                span,
            } => {
                let walked = sin.atan2(cos);
                // A little before the first point is rounding; on an arc of more than half a turn it can be its far part.
                let angle = match walked < 0.0 && span > PI {
                    true => (walked + TAU).min(span),
                    false => walked.clamp(0.0, span),
                };
                radius * angle
            }
        }
    }
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
