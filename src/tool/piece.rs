//! The pieces of a profile.

use std::f64::consts::PI;

use super::distance::{Along, CENTRE_RADIUS, Distance, tangential_projector};
use super::foot::Foot;
use crate::plane::{SymmetricMatrix, Vector, dot};

/// One piece of a profile. The chain is walked with the free side on the left, so the outward
/// normal is the walking direction turned by +90 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// A straight piece from `start` to `end` (mm).
    Segment {
        /// First point.
        start: Vector,
        /// Last point.
        end: Vector,
    },
    /// A circular piece around `centre`, from angle `from` to angle `to` (radians, counter-clockwise
    /// positive). Walked counter-clockwise (`to > from`) it is concave: the free side holds the
    /// centre. Walked clockwise it is convex. It spans at most a full turn.
    Arc {
        /// Centre, mm.
        centre: Vector,
        /// Radius, mm.
        radius: f64,
        /// Angle of the first point.
        from: f64,
        /// Angle of the last point.
        to: f64,
    },
}

impl Piece {
    /// What makes it unusable, if anything.
    pub(super) fn problem(&self) -> Option<&'static str> {
        let (numbers, whole) = match *self {
            Piece::Segment { start, end } => ([start[0], start[1], end[0], end[1], 0.0], true),
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => (
                [centre[0], centre[1], radius, from, to],
                radius > 0.0 && (to - from).abs() <= std::f64::consts::TAU,
            ),
        };
        if !numbers.iter().all(|number| number.is_finite()) {
            Some("has a number that is not finite")
        } else if !whole {
            Some("is an arc whose radius is not positive or that spans more than a full turn")
        } else if self.length() > 0.0 {
            None
        } else {
            Some("has no length")
        }
    }

    /// Length, mm.
    #[inline]
    pub(super) fn length(&self) -> f64 {
        match *self {
            Piece::Segment { start, end } => (end[0] - start[0]).hypot(end[1] - start[1]),
            Piece::Arc {
                radius, from, to, ..
            } => radius * (to - from).abs(),
        }
    }

    /// The point at this share of its length.
    pub(super) fn at(&self, share: f64) -> Vector {
        match *self {
            Piece::Segment { start, end } => [
                start[0] + share * (end[0] - start[0]),
                start[1] + share * (end[1] - start[1]),
            ],
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => {
                let angle = from + share * (to - from);
                [
                    centre[0] + radius * angle.cos(),
                    centre[1] + radius * angle.sin(),
                ]
            }
        }
    }

    /// Whether a point of its circle or line is between its ends.
    pub(super) fn holds(&self, x: Vector) -> bool {
        Foot::of(self).value(x, false, false).is_some()
    }

    /// The same piece walked the other way.
    pub(super) fn reversed(&self) -> Self {
        match *self {
            Piece::Segment { start, end } => Piece::Segment {
                start: end,
                end: start,
            },
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => Piece::Arc {
                centre,
                radius,
                from: to,
                to: from,
            },
        }
    }

    /// Its mirror image about x = 0, walked so that it leads to where the piece begins on the axis.
    pub(super) fn mirrored(&self) -> Self {
        match *self {
            Piece::Segment { start, end } => Piece::Segment {
                start: [-end[0], end[1]],
                end: [-start[0], start[1]],
            },
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => Piece::Arc {
                centre: [-centre[0], centre[1]],
                radius,
                from: PI - to,
                to: PI - from,
            },
        }
    }

    /// The unit vector along the walk at this share of its length.
    pub(super) fn tangent(&self, share: f64) -> Vector {
        match *self {
            Piece::Segment { start, end } => {
                let length = self.length();
                [(end[0] - start[0]) / length, (end[1] - start[1]) / length]
            }
            Piece::Arc { from, to, .. } => {
                let angle = from + share * (to - from);
                let turn = (to - from).signum();
                [-turn * angle.sin(), turn * angle.cos()]
            }
        }
    }

    /// Its end at `share` 0 or 1 of its length.
    pub(super) fn end(&self, share: f64) -> End {
        let tangent = self.tangent(share);
        End {
            x: self.at(share),
            normal: [-tangent[1], tangent[0]],
            arc_length: share * self.length(),
        }
    }
}

/// An end point of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub x: Vector,
    /// Tells the free side: the outward normal of the piece there, or at a joint the sum of both pieces' normals.
    pub normal: Vector,
    /// From the start of the piece, mm.
    pub arc_length: f64,
}

impl End {
    /// Signed distance to the end point, mm.
    ///
    /// Where an end point is the closest point of the profile, the sum of the normals of the pieces that meet there decides the
    /// side, at a corner as sharp as any (the pseudonormal of Bærentzen and Aanæs 2005, IEEE Trans. Vis. Comput. Graph. 11,
    /// 243-253, with the equal angles of the plane); the normal of one piece alone does not.
    #[inline]
    pub fn value(&self, x: Vector) -> f64 {
        let away = [x[0] - self.x[0], x[1] - self.x[1]];
        let r = dot(away, away).sqrt().max(CENTRE_RADIUS);
        match dot(away, self.normal) >= 0.0 {
            true => r,
            false => -r,
        }
    }

    /// The same with what belongs to it.
    pub fn distance(&self, x: Vector) -> Distance {
        let away = [x[0] - self.x[0], x[1] - self.x[1]];
        let value = self.value(x);
        let (r, side) = (value.abs(), value.signum());
        let radial = [side * away[0] / r, side * away[1] / r];
        Distance {
            value,
            gradient: radial,
            hessian: tangential_projector(radial, side / r),
            arc_gradient: [0.0; 2],
            arc_hessian: SymmetricMatrix::default(),
            piece_start: 0.0,
            along: Along::Known(self.arc_length),
        }
    }
}
