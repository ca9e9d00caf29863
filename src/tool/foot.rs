//! Where on a piece a point has its foot point: a piece made ready for being asked often.

use std::f64::consts::PI;

use super::distance::{Along, CENTRE_RADIUS, Distance, tangential_projector};
use super::piece::Piece;
use crate::plane::{SymmetricMatrix, Vector, dot};

/// By which angle, radians, a foot point may lie beside an arc: rounding must not put the point at a smooth joint into
/// neither of the pieces that meet there, where it would find a corner.
const BESIDE: f64 = 1e-12;

/// A piece, walked as [`Piece`] says, with what its foot points need and no point changes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Foot {
    OnLine {
        start: Vector,
        /// Unit vector.
        tangent: Vector,
        /// mm.
        length: f64,
    },
    OnCircle {
        centre: Vector,
        /// mm.
        radius: f64,
        /// 1 counter-clockwise (concave), -1 clockwise (convex).
        turn: f64,
        /// Unit vectors from the centre to the first, the middle and the last point.
        first: Vector,
        middle: Vector,
        last: Vector,
        /// Angle from the first point to the last, radians.
        span: f64,
    },
}

impl Foot {
    pub fn of(piece: &Piece) -> Self {
        match *piece {
            Piece::Segment { start, .. } => Self::OnLine {
                start,
                tangent: piece.tangent(0.0),
                length: piece.length(),
            },
            Piece::Arc {
                centre,
                radius,
                from,
                to,
            } => {
                let [first, middle, last] =
                    [from, 0.5 * (from + to), to].map(|angle| [angle.cos(), angle.sin()]);
                Self::OnCircle {
                    centre,
                    radius,
                    turn: (to - from).signum(),
                    first,
                    middle,
                    last,
                    span: (to - from).abs(),
                }
            }
        }
    }

    /// Signed distance, mm, if the foot point lies within the piece; of an arc with the rounding of its radius, which
    /// is enough to compare pieces. `open_start` and `open_end` let a segment go on beyond its ends.
    #[inline]
    pub fn value(&self, x: Vector, open_start: bool, open_end: bool) -> Option<f64> {
        match *self {
            Self::OnLine {
                start,
                tangent,
                length,
            } => {
                let from_start = [x[0] - start[0], x[1] - start[1]];
                let along = dot(from_start, tangent);
                let before = along < 0.0 && !open_start;
                let beyond = along > length && !open_end;
                (!before && !beyond).then(|| cross(tangent, from_start))
            }
            Self::OnCircle {
                centre,
                radius,
                turn,
                first,
                last,
                span,
                ..
            } => {
                let from_centre = [x[0] - centre[0], x[1] - centre[1]];
                let r = dot(from_centre, from_centre).sqrt();
                let after_first = turn * cross(first, from_centre) >= -BESIDE * r;
                let before_last = turn * cross(from_centre, last) >= -BESIDE * r;
                let within = match span <= PI {
                    true => after_first && before_last,
                    false => after_first || before_last,
                };
                // Convex: r - radius; concave: radius - r.
                (within || r < CENTRE_RADIUS).then_some(turn * (radius - r))
            }
        }
    }

    /// Signed distance of a point whose foot point lies within the piece, mm: the value of [`Foot::distance`].
    #[inline]
    pub fn signed_distance(&self, x: Vector) -> f64 {
        match *self {
            Self::OnLine { start, tangent, .. } => {
                cross(tangent, [x[0] - start[0], x[1] - start[1]])
            }
            Self::OnCircle {
                centre,
                radius,
                turn,
                ..
            } => {
                let from_centre = [x[0] - centre[0], x[1] - centre[1]];
                let r = dot(from_centre, from_centre).sqrt().max(CENTRE_RADIUS);
                -turn * beyond_circle(x, centre, radius, r)
            }
        }
    }

    /// Distance of a point whose foot point lies within the piece; arc length from the start of the piece.
    #[inline]
    pub fn distance(&self, x: Vector) -> Distance {
        match *self {
            Self::OnLine { start, tangent, .. } => {
                let from_start = [x[0] - start[0], x[1] - start[1]];
                Distance {
                    value: cross(tangent, from_start),
                    gradient: [-tangent[1], tangent[0]],
                    hessian: SymmetricMatrix::default(),
                    arc_gradient: tangent,
                    arc_hessian: SymmetricMatrix::default(),
                    piece_start: 0.0,
                    along: Along::Known(dot(from_start, tangent)),
                }
            }
            Self::OnCircle {
                centre,
                radius,
                turn,
                first,
                middle,
                span,
                ..
            } => {
                let from_centre = [x[0] - centre[0], x[1] - centre[1]];
                let r = dot(from_centre, from_centre).sqrt();
                let (radial, r) = if r < CENTRE_RADIUS {
                    (middle, CENTRE_RADIUS)
                } else {
                    ([from_centre[0] / r, from_centre[1] / r], r)
                };
                let tangent = [-turn * radial[1], turn * radial[0]];
                let stretch = radius / r;
                // Second derivative of the angle: -(e_r e_t + e_t e_r) / r^2.
                let mixed = -stretch / r;
                Distance {
                    value: -turn * beyond_circle(x, centre, radius, r),
                    gradient: [-turn * radial[0], -turn * radial[1]],
                    hessian: tangential_projector(radial, -turn / r),
                    arc_gradient: [stretch * tangent[0], stretch * tangent[1]],
                    arc_hessian: SymmetricMatrix {
                        xx: 2.0 * mixed * radial[0] * tangent[0],
                        yy: 2.0 * mixed * radial[1] * tangent[1],
                        xy: mixed * (radial[0] * tangent[1] + radial[1] * tangent[0]),
                    },
                    piece_start: 0.0,
                    along: Along::OnArc {
                        radius,
                        sin: turn * cross(first, radial),
                        cos: dot(first, radial),
                        span,
                    },
                }
            }
        }
    }
}

/// |x - c| - R for a point at distance `r` from the centre, to the rounding of the point: the difference itself has that of
/// the radius, which a stiff contact on a large tool turns into noise of its pressure.
///
/// (|x - c|² - R²) / (r + R), the numerator with the rounding errors of its sums and products (Dekker 1971, Numer. Math.
/// 18, 224-242).
#[inline]
fn beyond_circle(x: Vector, centre: Vector, radius: f64, r: f64) -> f64 {
    let [(dx, lost_x), (dy, lost_y)] = [0, 1].map(|k| exact_sum(x[k], -centre[k]));
    let [(xx, lost_xx), (yy, lost_yy), (rr, lost_rr)] = [dx, dy, radius].map(exact_square);
    let (sum, lost) = exact_sum(xx, yy);
    let lost = lost + lost_xx + lost_yy - lost_rr + 2.0 * (dx * lost_x + dy * lost_y);
    ((sum - rr) + lost) / (r + radius)
}

/// a + b as the nearest number and what that leaves out.
#[inline]
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// a² as the nearest number and what that leaves out.
#[inline]
fn exact_square(a: f64) -> (f64, f64) {
    let square = a * a;
    (square, a.mul_add(a, -square))
}

#[inline]
fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arc around (0, 1100) with the radius 1000 mm, as a quarter and as three quarters of a turn.
    fn arcs() -> [Foot; 2] {
        [PI / 4.0, 0.75 * PI].map(|half| {
            Foot::of(&Piece::Arc {
                centre: [0.0, 1100.0],
                radius: 1000.0,
                from: -0.5 * PI + half,
                to: -0.5 * PI - half,
            })
        })
    }

    #[test]
    fn the_distance_to_a_large_arc_has_the_rounding_of_the_point() {
        // Below the centre by 1000 - h: 1000 mm from it at the side s where s² = 2000 h - h².
        for arc in arcs() {
            for h in [0.0, 2.0_f64.powi(-20), 2.0_f64.powi(-12), 0.5] {
                let value = arc.distance([0.0, 100.0 + h]).value;
                assert_eq!(value, -h, "{h}");
                let side = (2000.0 * h - h * h).sqrt();
                let value = arc.distance([side, 100.0 + h]).value;
                // The side itself is rounded; 1e-13 would be the rounding of the radius.
                assert!(
                    value.abs() <= f64::EPSILON * side * side / 1000.0,
                    "{h}: {value:e}"
                );
            }
        }
    }

    #[test]
    fn a_foot_point_is_within_an_arc_from_its_first_point_to_its_last() {
        for (arc, half) in arcs().into_iter().zip([PI / 4.0, 0.75 * PI]) {
            for k in -31..=31 {
                // From the middle, with the walk.
                let aside = 0.1 * f64::from(k);
                let angle = -0.5 * PI - aside;
                for r in [10.0, 999.0, 1010.0] {
                    let x = [r * angle.cos(), 1100.0 + r * angle.sin()];
                    let value = arc.value(x, false, false);
                    assert_eq!(value.is_some(), aside.abs() < half, "{aside} {half}");
                    if let Some(value) = value {
                        let distance = arc.distance(x);
                        assert!((value - (r - 1000.0)).abs() < 1e-11);
                        assert!((distance.value - value).abs() < 1e-11);
                        assert!((distance.arc_length() - 1000.0 * (half + aside)).abs() < 1e-9);
                    }
                }
            }
        }
    }

    #[test]
    fn a_number_that_is_none_has_no_distance() {
        for arc in arcs() {
            assert!(arc.value([f64::NAN, 0.0], false, false).is_none());
        }
    }
}
