//! How the distance of a point to a profile moves with a parameter that moves, turns or bends the pieces of the profile.

use super::Profile;
use crate::plane::{Vector, dot};
use crate::tool::distance::Distance;
use crate::tool::piece::Piece;

/// How a profile moves with a parameter.
#[derive(Clone, Debug)]
pub struct ProfileSlope {
    pieces: Vec<PieceSlope>,
}

/// How a piece moves, all per unit of the parameter.
#[derive(Clone, Copy, Debug)]
struct PieceSlope {
    /// Of the first point of a segment, of the centre of an arc, mm.
    origin: Vector,
    /// Of the direction of a segment, of the first angle of an arc, radians.
    angle: f64,
    /// Of the radius of an arc, mm.
    radius: f64,
    /// Of the arc length at its start, mm.
    arc_start: f64,
    /// Of both end points and the arc lengths from the start of the piece to them, mm.
    ends: [(Vector, f64); 2],
}

/// Derivatives of the [`Distance`] of a point that stays where it is, per unit of the parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DistanceSlope {
    /// Of the signed distance, mm.
    pub value: f64,
    /// Of its gradient.
    pub gradient: Vector,
    /// Of the arc length of the foot point, mm.
    pub arc_length: f64,
    /// Of its gradient.
    pub arc_gradient: Vector,
}

impl ProfileSlope {
    /// From the profiles with more and with less of the parameter, `width` of it apart, which have the same pieces; none if nothing
    /// moves.
    pub fn between(above: &Profile, below: &Profile, width: f64) -> Option<Self> {
        let sides = |i: usize| {
            let ends = [0, 1].map(|end| {
                let (a, b) = (&above.ends[i][end], &below.ends[i][end]);
                let arc_length = (a.arc_length - b.arc_length) / width;
                (motion(a.x, b.x, width), arc_length)
            });
            PieceSlope {
                arc_start: (above.arc_starts[i] - below.arc_starts[i]) / width,
                ends,
                ..PieceSlope::between(&above.pieces[i], &below.pieces[i], width)
            }
        };
        let pieces: Vec<PieceSlope> = (0..above.pieces.len()).map(sides).collect();
        let moves = pieces.iter().any(|piece| !piece.is_zero());
        moves.then_some(Self { pieces })
    }
}

impl PieceSlope {
    fn between(above: &Piece, below: &Piece, width: f64) -> Self {
        let (origin, angle, radius) = match (above, below) {
            (
                Piece::Arc {
                    centre,
                    radius,
                    from,
                    ..
                },
                Piece::Arc {
                    centre: centre_below,
                    radius: radius_below,
                    from: from_below,
                    ..
                },
            ) => (
                motion(*centre, *centre_below, width),
                from - from_below,
                radius - radius_below,
            ),
            (
                Piece::Segment { start, end },
                Piece::Segment {
                    start: start_below,
                    end: end_below,
                },
            ) => {
                let [a, b] = [[start, end], [start_below, end_below]]
                    .map(|[start, end]| [end[0] - start[0], end[1] - start[1]]);
                let turned = (b[0] * a[1] - b[1] * a[0]).atan2(dot(a, b));
                (motion(*start, *start_below, width), turned, 0.0)
            }
            // There is no parameter that makes another piece of one.
            _ => ([f64::NAN; 2], f64::NAN, f64::NAN),
        };
        Self {
            origin,
            angle: angle / width,
            radius: radius / width,
            arc_start: 0.0,
            ends: [([0.0; 2], 0.0); 2],
        }
    }

    fn is_zero(&self) -> bool {
        self.origin == [0.0; 2] && self.angle == 0.0 && self.radius == 0.0 && self.arc_start == 0.0
    }
}

impl Profile {
    /// Derivatives of the distance `at` that [`Profile::distance`] gave.
    pub fn distance_slope(&self, at: &Distance, by: &ProfileSlope) -> DistanceSlope {
        let index = self
            .arc_starts
            .partition_point(|start| *start <= at.arc_length());
        let index = index.saturating_sub(1);
        let (piece, moves) = (&self.pieces[index], &by.pieces[index]);
        let along = at.arc_length() - self.arc_starts[index];
        // Only the foot point at an end stays where it is when the point moves.
        if at.arc_gradient == [0.0; 2] {
            let end = usize::from(along > 0.5 * piece.length());
            let (end, length) = moves.ends[end];
            return carried(at, end, moves.arc_start + length);
        }
        let mut slope = carried(at, moves.origin, moves.arc_start);
        match *piece {
            Piece::Segment { .. } => {
                let (normal, tangent) = (at.gradient, at.arc_gradient);
                slope.value -= moves.angle * along;
                slope.arc_length += moves.angle * at.value;
                for k in 0..2 {
                    slope.gradient[k] -= moves.angle * tangent[k];
                    slope.arc_gradient[k] += moves.angle * normal[k];
                }
            }
            Piece::Arc {
                radius, from, to, ..
            } => {
                let (turn, growth) = ((to - from).signum(), moves.radius / radius);
                slope.value += turn * moves.radius;
                slope.arc_length += growth * along - turn * radius * moves.angle;
                for k in 0..2 {
                    slope.arc_gradient[k] += growth * at.arc_gradient[k];
                }
            }
        }
        slope
    }
}

/// For a piece that is carried along by the motion of its `origin`.
fn carried(at: &Distance, origin: Vector, arc_start: f64) -> DistanceSlope {
    let back = origin.map(|motion| -motion);
    DistanceSlope {
        value: dot(at.gradient, back),
        gradient: at.hessian.times(back),
        arc_length: arc_start + dot(at.arc_gradient, back),
        arc_gradient: at.arc_hessian.times(back),
    }
}

fn motion(above: Vector, below: Vector, width: f64) -> Vector {
    [0, 1].map(|k| (above[k] - below[k]) / width)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::{die, punch};

    /// A wedge whose tip, angle and sides move with the parameter.
    fn wedge(by: f64) -> Profile {
        let (tip, angle) = ([0.2 * by, -3.0 + by], 0.6 + 0.3 * by);
        let side = |angle: f64| [tip[0] + 40.0 * angle.sin(), tip[1] + 40.0 * angle.cos()];
        let [start, end] = [side(angle), side(-angle)];
        let segments = [(start, tip), (tip, end)].map(|(start, end)| Piece::Segment { start, end });
        Profile::chained(segments.to_vec())
    }

    #[test]
    fn slopes_agree_with_central_differences() {
        let h = 1e-5;
        let families: [&dyn Fn(f64) -> Profile; 5] = [
            &|by| die(25.0 + by, 4.0, 60.0),
            &|by| die(25.0, 4.0 + by, 60.0),
            &|by| punch(23.5 + by, 1.0, 40.0),
            &|by| punch(23.5, 1.0 + by, 40.0),
            &wedge,
        ];
        for family in families {
            let [here, above, below] = [0.0, h, -h].map(family);
            let slope = ProfileSlope::between(&above, &below, 2.0 * h).unwrap();
            let mut compared = 0;
            for i in 0..60 {
                for j in 0..40 {
                    let x = [0.13 + 0.97 * f64::from(i), -28.3 + 0.83 * f64::from(j)];
                    let [at, more, less] = [&here, &above, &below].map(|tool| tool.distance(x));
                    // Where the closest piece changes there is no derivative.
                    if (more.arc_length() - less.arc_length()).abs() > 1e-2 {
                        continue;
                    }
                    compared += 1;
                    let exact = here.distance_slope(&at, &slope);
                    let close = |exact: f64, above: f64, below: f64, what: &str| {
                        let difference = (above - below) / (2.0 * h);
                        let error = (exact - difference).abs();
                        assert!(
                            error < 1e-7 * (1.0 + exact.abs()),
                            "{what} at {x:?}: {exact} {difference}"
                        );
                    };
                    close(exact.value, more.value, less.value, "value");
                    close(
                        exact.arc_length,
                        more.arc_length(),
                        less.arc_length(),
                        "arc length",
                    );
                    for k in 0..2 {
                        close(
                            exact.gradient[k],
                            more.gradient[k],
                            less.gradient[k],
                            "gradient",
                        );
                        close(
                            exact.arc_gradient[k],
                            more.arc_gradient[k],
                            less.arc_gradient[k],
                            "arc gradient",
                        );
                    }
                }
            }
            assert!(compared > 1000, "{compared}");
            assert!(ProfileSlope::between(&here, &here, 1.0).is_none());
        }
    }
}
