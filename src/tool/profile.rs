//! Rigid profiles as chains of arcs and segments, with an exact signed distance.

mod slope;

pub use slope::{DistanceSlope, ProfileSlope};

use super::distance::Distance;
use super::foot::Foot;
use super::piece::{End, Piece};
use crate::plane::{Vector, dot};

/// Where the next piece may begin, as a share of the largest coordinate or of a millimetre, whichever is more.
const CLOSED: f64 = 1e-9;
/// Two pieces whose normals add up to less than this fold back onto each other.
const FOLDED: f64 = 1e-6;

/// Why pieces are no profile. Pieces are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// There is none.
    #[error("a profile needs at least one piece")]
    Empty,
    /// A piece by itself cannot be used.
    #[error("piece {piece} of the profile {problem}")]
    Piece {
        /// Its number.
        piece: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A piece does not begin where the one before ends.
    #[error(
        "piece {piece} of the profile begins {gap:.3e} mm from the end of the one before, at ({:.6}, {:.6}) mm; at most \
         {tolerance:.1e} mm is rounding",
        at[0], at[1]
    )]
    Gap {
        /// Number of the later piece.
        piece: usize,
        /// Where it begins, mm.
        at: Vector,
        /// How far from the end of the one before, mm.
        gap: f64,
        /// What would still be allowed, mm.
        tolerance: f64,
    },
    /// A piece goes back along the one before, so that no side is free.
    #[error("piece {piece} of the profile folds back onto the one before at ({:.6}, {:.6}) mm", at[0], at[1])]
    FoldsBack {
        /// Number of the later piece.
        piece: usize,
        /// Where, mm.
        at: Vector,
    },
}

/// A chain of pieces, each starting where the one before ends. Straight first and last pieces go on
/// for ever.
#[derive(Clone, Debug)]
pub struct Profile {
    /// At least one.
    pieces: Vec<Piece>,
    /// The same, ready to be asked.
    feet: Vec<Foot>,
    /// Arc length at the start of each piece, mm.
    arc_starts: Vec<f64>,
    /// Both ends of each piece.
    ends: Vec<[End; 2]>,
}

impl Profile {
    /// A chain of pieces.
    ///
    /// # Errors
    /// There is no piece, one of them is unusable, or one does not begin where the one before ends.
    pub fn new(pieces: Vec<Piece>) -> Result<Self, ProfileError> {
        if pieces.is_empty() {
            return Err(ProfileError::Empty);
        }
        for (piece, number) in pieces.iter().zip(1..) {
            if let Some(problem) = piece.problem() {
                return Err(ProfileError::Piece {
                    piece: number,
                    problem,
                });
            }
        }
        for (pair, number) in pieces.windows(2).zip(2..) {
            check_joint(&pair[0].end(1.0), &pair[1].end(0.0), number)?;
        }
        Ok(Self::chained(pieces))
    }

    /// The same of pieces that are known to be a chain, at least one.
    pub(super) fn chained(pieces: Vec<Piece>) -> Self {
        let arc_starts = pieces
            .iter()
            .scan(0.0, |total, piece| {
                let start = *total;
                *total += piece.length();
                Some(start)
            })
            .collect();
        let mut ends: Vec<[End; 2]> = pieces.iter().map(|p| [p.end(0.0), p.end(1.0)]).collect();
        for later in 1..ends.len() {
            let normal = sum(ends[later - 1][1].normal, ends[later][0].normal);
            ends[later - 1][1].normal = normal;
            ends[later][0].normal = normal;
        }
        Self {
            feet: pieces.iter().map(Foot::of).collect(),
            pieces,
            arc_starts,
            ends,
        }
    }

    /// Signed distance of `x` (mm) to the closest piece, with what belongs to it.
    pub fn distance(&self, x: Vector) -> Distance {
        let (piece, end) = self.nearest(x);
        let mut distance = match end {
            None => self.feet[piece].distance(x),
            Some(end) => self.ends[piece][end].distance(x),
        };
        distance.piece_start = self.arc_starts[piece];
        distance
    }

    /// Signed distance of `x` (mm) alone, mm.
    pub fn signed_distance(&self, x: Vector) -> f64 {
        match self.nearest(x) {
            (piece, None) => self.feet[piece].signed_distance(x),
            (piece, Some(end)) => self.ends[piece][end].value(x),
        }
    }

    /// The piece that is closest to `x` (mm), and which of its ends if that is its closest point.
    fn nearest(&self, x: Vector) -> (usize, Option<usize>) {
        let last = self.feet.len() - 1;
        let (mut best, mut nearest) = (f64::INFINITY, (0, None));
        let mut consider = |value: f64, place| {
            // A point that is not a number keeps a distance that is none.
            if best <= value.abs() {
                return;
            }
            (best, nearest) = (value.abs(), place);
        };
        for (i, foot) in self.feet.iter().enumerate() {
            match foot.value(x, i == 0, i == last) {
                Some(value) => consider(value, (i, None)),
                None => {
                    for (k, end) in self.ends[i].iter().enumerate() {
                        consider(end.value(x), (i, Some(k)));
                    }
                }
            }
        }
        nearest
    }

    /// The profile as a polyline with at most `spacing` (mm) between points, for pictures. The middle
    /// of every arc is a point.
    pub fn polyline(&self, spacing: f64) -> Vec<Vector> {
        let mut points: Vec<Vector> = Vec::new();
        for piece in &self.pieces {
            let divisions = match piece {
                Piece::Segment { .. } => 1,
                Piece::Arc { .. } => 2 * (0.5 * piece.length() / spacing).ceil().max(1.0) as usize,
            };
            let first = usize::from(!points.is_empty());
            points.extend((first..=divisions).map(|k| piece.at(k as f64 / divisions as f64)));
        }
        points
    }
}

fn check_joint(end: &End, start: &End, piece: usize) -> Result<(), ProfileError> {
    let gap = (start.x[0] - end.x[0]).hypot(start.x[1] - end.x[1]);
    let size = start
        .x
        .iter()
        .chain(&end.x)
        .fold(1.0_f64, |m, x| m.max(x.abs()));
    let tolerance = CLOSED * size;
    if gap > tolerance {
        return Err(ProfileError::Gap {
            piece,
            at: start.x,
            gap,
            tolerance,
        });
    }
    let normal = sum(end.normal, start.normal);
    if dot(normal, normal).sqrt() < FOLDED {
        return Err(ProfileError::FoldsBack { piece, at: start.x });
    }
    Ok(())
}

fn sum(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

#[cfg(test)]
mod tests {
    use super::super::{die, punch};
    use super::*;

    fn profiles() -> [Profile; 2] {
        [die(25.0, 4.0, 60.0), punch(23.5, 1.0, 40.0)]
    }

    /// Points near the surface of each piece and far from it, away from the medial axis.
    fn probes() -> Vec<[f64; 2]> {
        let mut probes = Vec::new();
        for i in 0..60 {
            for j in 0..40 {
                probes.push([0.13 + 0.97 * i as f64, -28.3 + 0.83 * j as f64]);
            }
        }
        probes
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let h = 1e-6;
        for profile in profiles() {
            for x in probes() {
                let d = profile.distance(x);
                let [right, left, up, down] = [[h, 0.0], [-h, 0.0], [0.0, h], [0.0, -h]]
                    .map(|s| profile.distance([x[0] + s[0], x[1] + s[1]]));
                // On the medial axis the closest piece changes and no derivative exists.
                if (right.arc_length() - left.arc_length()).abs() > 1e-3
                    || (up.arc_length() - down.arc_length()).abs() > 1e-3
                {
                    continue;
                }
                let close = |a: f64, b: f64, what: &str| {
                    assert!(
                        (a - b).abs() < 1e-7 * (1.0 + b.abs()),
                        "{what} at {x:?}: {a} {b}"
                    )
                };
                let slope = |plus: f64, minus: f64| (plus - minus) / (2.0 * h);
                close(d.gradient[0], slope(right.value, left.value), "gradient x");
                close(d.gradient[1], slope(up.value, down.value), "gradient y");
                close(
                    d.hessian.xx,
                    slope(right.gradient[0], left.gradient[0]),
                    "hessian xx",
                );
                close(
                    d.hessian.xy,
                    slope(up.gradient[0], down.gradient[0]),
                    "hessian xy",
                );
                close(
                    d.hessian.yy,
                    slope(up.gradient[1], down.gradient[1]),
                    "hessian yy",
                );
                close(
                    d.arc_gradient[0],
                    slope(right.arc_length(), left.arc_length()),
                    "arc x",
                );
                close(
                    d.arc_gradient[1],
                    slope(up.arc_length(), down.arc_length()),
                    "arc y",
                );
                let [pr, pl, pu, pd] = [right, left, up, down].map(|d| d.arc_gradient);
                close(d.arc_hessian.xx, slope(pr[0], pl[0]), "arc hessian xx");
                close(d.arc_hessian.xy, slope(pu[0], pd[0]), "arc hessian xy");
                close(d.arc_hessian.yy, slope(pu[1], pd[1]), "arc hessian yy");
            }
        }
    }

    #[test]
    fn the_distance_has_unit_gradient_and_the_right_sign() {
        let [die, punch] = profiles();
        for profile in [&die, &punch] {
            for x in probes() {
                let g = profile.distance(x).gradient;
                assert!((g[0].hypot(g[1]) - 1.0).abs() < 1e-12);
            }
        }
        assert!((die.distance([0.0, -27.5]).value - 1.5).abs() < 1e-12);
        assert!((die.distance([40.0, 0.25]).value - 0.25).abs() < 1e-12);
        assert!((die.distance([29.0, -0.5]).value + 0.5).abs() < 1e-12);
        assert!((punch.distance([0.0, 0.4]).value - 0.6).abs() < 1e-12);
        assert!((punch.distance([23.0, 30.0]).value + 0.5).abs() < 1e-12);
    }

    #[test]
    fn arc_length_runs_on_without_a_jump_from_piece_to_piece() {
        for profile in profiles() {
            let line = profile.polyline(0.01);
            let mut length = 0.0;
            let mut before: Option<([f64; 2], f64)> = None;
            for x in line {
                let d = profile.distance(x);
                assert!(d.value.abs() < 1e-12);
                if let Some((y, s)) = before {
                    length += (x[0] - y[0]).hypot(x[1] - y[1]);
                    assert!(d.arc_length() >= s);
                }
                before = Some((x, d.arc_length()));
            }
            assert!(before.is_some_and(|(_, s)| (s - length).abs() < 1e-4));
        }
    }

    /// A nose that points down, with this angle (radians) at its tip in the origin.
    fn nose(angle: f64) -> Profile {
        let (sin, cos) = (0.5 * angle).sin_cos();
        let [right, left] = [[10.0 * sin, 10.0 * cos], [-10.0 * sin, 10.0 * cos]];
        let tip = [0.0, 0.0];
        Profile::new(vec![
            Piece::Segment {
                start: right,
                end: tip,
            },
            Piece::Segment {
                start: tip,
                end: left,
            },
        ])
        .unwrap()
    }

    #[test]
    fn at_a_sharp_corner_what_is_outside_is_free_and_what_is_inside_is_not() {
        for degrees in [10.0_f64, 60.0, 90.0, 150.0, 210.0, 300.0, 350.0] {
            let nose = nose(degrees.to_radians());
            for i in 0..=100 {
                for j in 0..50 {
                    let x = [
                        0.1 * (f64::from(i) - 50.0) + 0.003,
                        0.1 * f64::from(j) - 2.503,
                    ];
                    // Angle from the nose's axis, and with it the distance to a wedge that goes on for ever.
                    let aside = x[0].abs().atan2(x[1]) - 0.5 * degrees.to_radians();
                    let r = x[0].hypot(x[1]);
                    let expected = match aside.abs() {
                        beside if beside < std::f64::consts::FRAC_PI_2 => r * aside.sin(),
                        _ => r * aside.signum(),
                    };
                    let d = nose.distance(x);
                    assert!(
                        (d.value - expected).abs() < 1e-12,
                        "{degrees}° at {x:?}: {d:?}"
                    );
                    assert!((d.gradient[0].hypot(d.gradient[1]) - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn the_nearest_point_of_a_corner_between_arcs_tells_the_side_as_well() {
        // Two convex arcs that meet in a sharp edge at the origin, like the tip of a lens that points down.
        let arc = |x: f64, from: f64, to: f64| Piece::Arc {
            centre: [x, 1.0],
            radius: 2.0_f64.sqrt(),
            from,
            to,
        };
        let [quarter, eighth] = [std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_4];
        let lens = Profile::new(vec![
            arc(-1.0, 0.0, -eighth),
            arc(1.0, -quarter - eighth, -2.0 * quarter),
        ])
        .unwrap();
        for k in -4..=4 {
            let (sin, cos) = (0.19 * f64::from(k)).sin_cos();
            let d = lens.distance([0.3 * sin, -0.3 * cos]);
            assert!((d.value - 0.3).abs() < 1e-12, "{k}: {d:?}");
        }
        assert!(lens.distance([0.0, 0.1]).value < 0.0);
    }

    #[test]
    fn what_is_no_chain_is_refused_with_the_place() {
        let segment = |start: Vector, end: Vector| Piece::Segment { start, end };
        let refusal = |pieces: &[Piece]| Profile::new(pieces.to_vec()).unwrap_err();
        assert_eq!(refusal(&[]), ProfileError::Empty);
        let first = segment([0.0, 0.0], [100.0, 0.0]);
        let error = refusal(&[first, segment([100.25, 0.0], [200.0, 0.0])]);
        assert!(matches!(error, ProfileError::Gap { piece: 2, gap, .. } if gap == 0.25));
        assert_eq!(
            error.to_string(),
            "piece 2 of the profile begins 2.500e-1 mm from the end of the one before, at (100.250000, 0.000000) mm; \
             at most 1.0e-7 mm is rounding"
        );
        assert!(Profile::new(vec![first, segment([100.0 + 1e-8, 0.0], [200.0, 0.0])]).is_ok());
        let error = refusal(&[first, segment([100.0, 0.0], [50.0, 0.0])]);
        assert!(matches!(error, ProfileError::FoldsBack { piece: 2, .. }));
        let arc = |radius: f64, to: f64| Piece::Arc {
            centre: [0.0, 0.0],
            radius,
            from: 0.0,
            to,
        };
        for (piece, word) in [
            (segment([1.0, 1.0], [1.0, 1.0]), "no length"),
            (segment([f64::NAN, 1.0], [1.0, 1.0]), "not finite"),
            (arc(1.0, 0.0), "no length"),
            (arc(0.0, 1.0), "radius is not positive"),
            (arc(1.0, 7.0), "more than a full turn"),
        ] {
            assert!(refusal(&[piece]).to_string().contains(word), "{piece:?}");
        }
    }

    #[test]
    fn the_benchmarks_tools_are_chains_whatever_their_sizes() {
        for size in [1e-5, 0.1, 1.0, 25.0, 1e5] {
            for shoulder in [1e-5, 4.0, 1e5] {
                let tools = [die(size, shoulder, 60.0), punch(size, shoulder, 28.5)];
                for tool in tools {
                    assert!(Profile::new(tool.pieces).is_ok(), "{size} {shoulder}");
                }
            }
        }
    }
}
