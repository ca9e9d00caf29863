//! The pieces of a profile and their exact signed distance.

use std::f64::consts::PI;

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

impl Distance {
    /// Of a profile without pieces, further than any other.
    pub(super) const NOWHERE: Self = Self {
        value: f64::INFINITY,
        gradient: [0.0; 2],
        hessian: SymmetricMatrix {
            xx: 0.0,
            yy: 0.0,
            xy: 0.0,
        },
        arc_length: 0.0,
        arc_gradient: [0.0; 2],
        arc_hessian: SymmetricMatrix {
            xx: 0.0,
            yy: 0.0,
            xy: 0.0,
        },
    };
}

/// Below this distance from an arc's centre the direction to the foot point is arbitrary, mm.
const CENTRE_RADIUS: f64 = 1e-9;

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

    /// Signed distance if the foot point lies within the piece. `open_start` and `open_end` let a
    /// segment go on beyond its ends.
    #[inline]
    pub(super) fn distance(&self, x: Vector, open_start: bool, open_end: bool) -> Option<Distance> {
        match *self {
            Piece::Segment { start, end } => {
                let length = self.length();
                let tangent = [(end[0] - start[0]) / length, (end[1] - start[1]) / length];
                let normal = [-tangent[1], tangent[0]];
                let from_start = [x[0] - start[0], x[1] - start[1]];
                let along = dot(from_start, tangent);
                let before = along < 0.0 && !open_start;
                let beyond = along > length && !open_end;
                (!before && !beyond).then(|| Distance {
                    value: dot(from_start, normal),
                    gradient: normal,
                    hessian: SymmetricMatrix::default(),
                    arc_length: along,
                    arc_gradient: tangent,
                    arc_hessian: SymmetricMatrix::default(),
                })
            }
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => {
                let from_centre = [x[0] - centre[0], x[1] - centre[1]];
                let r = dot(from_centre, from_centre).sqrt();
                let turn = (to - from).signum();
                let (angle, radial, r) = if r < CENTRE_RADIUS {
                    let middle = 0.5 * (from + to);
                    (
                        0.5 * (to - from).abs(),
                        [middle.cos(), middle.sin()],
                        CENTRE_RADIUS,
                    )
                } else {
                    let walked = turn * (from_centre[1].atan2(from_centre[0]) - from);
                    let walked = walked.rem_euclid(std::f64::consts::TAU);
                    (walked, [from_centre[0] / r, from_centre[1] / r], r)
                };
                (angle <= (to - from).abs())
                    .then(|| arc_distance(radial, r, radius, turn, radius * angle))
            }
        }
    }

    /// Whether a point of its circle or line is between its ends.
    pub(super) fn holds(&self, x: Vector) -> bool {
        self.distance(x, false, false).is_some()
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

    /// Its end at `share` 0 or 1 of its length.
    pub(super) fn end(&self, share: f64) -> End {
        let tangent = match *self {
            Piece::Segment { start, end } => {
                let length = self.length();
                [(end[0] - start[0]) / length, (end[1] - start[1]) / length]
            }
            Piece::Arc { from, to, .. } => {
                let angle = from + share * (to - from);
                let turn = (to - from).signum();
                [-turn * angle.sin(), turn * angle.cos()]
            }
        };
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
    /// Distance to the end point.
    ///
    /// Where an end point is the closest point of the profile, the sum of the normals of the pieces that meet there decides the
    /// side, at a corner as sharp as any (the pseudonormal of Bærentzen and Aanæs 2005, IEEE Trans. Vis. Comput. Graph. 11,
    /// 243-253, with the equal angles of the plane); the normal of one piece alone does not.
    #[inline]
    pub(super) fn distance(&self, x: Vector) -> Distance {
        let away = [x[0] - self.x[0], x[1] - self.x[1]];
        let r = dot(away, away).sqrt().max(CENTRE_RADIUS);
        let side = if dot(away, self.normal) >= 0.0 {
            1.0
        } else {
            -1.0
        };
        let radial = [side * away[0] / r, side * away[1] / r];
        Distance {
            value: side * r,
            gradient: radial,
            hessian: tangential_projector(radial, side / r),
            arc_length: self.arc_length,
            arc_gradient: [0.0; 2],
            arc_hessian: SymmetricMatrix::default(),
        }
    }
}

/// Distance and arc length for a point at radius `r` in direction `radial` from the centre of an
/// arc walked with sign `turn`.
#[inline]
fn arc_distance(radial: Vector, r: f64, radius: f64, turn: f64, arc: f64) -> Distance {
    // Convex (turn = -1): r - radius; concave: radius - r.
    let gradient = [-turn * radial[0], -turn * radial[1]];
    let tangent = [-turn * radial[1], turn * radial[0]];
    let stretch = radius / r;
    // Second derivative of the angle: -(e_r e_t + e_t e_r) / r^2.
    let mixed = -stretch / r;
    Distance {
        value: -turn * (r - radius),
        gradient,
        hessian: tangential_projector(radial, -turn / r),
        arc_length: arc,
        arc_gradient: [stretch * tangent[0], stretch * tangent[1]],
        arc_hessian: SymmetricMatrix {
            xx: 2.0 * mixed * radial[0] * tangent[0],
            yy: 2.0 * mixed * radial[1] * tangent[1],
            xy: mixed * (radial[0] * tangent[1] + radial[1] * tangent[0]),
        },
    }
}

/// `scale` times (I - n n).
#[inline]
fn tangential_projector(n: Vector, scale: f64) -> SymmetricMatrix {
    SymmetricMatrix {
        xx: scale * n[1] * n[1],
        yy: scale * n[0] * n[0],
        xy: -scale * n[0] * n[1],
    }
}
