//! Rigid profiles as chains of arcs and segments, with an exact signed distance.

/// One piece of a profile. The chain is walked with the free side on the left, so the outward
/// normal is the walking direction turned by +90 degrees.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// A straight piece from `start` to `end` (mm).
    Segment {
        /// First point.
        start: [f64; 2],
        /// Last point.
        end: [f64; 2],
    },
    /// A circular piece around `centre`, from angle `from` to angle `to` (radians, counter-clockwise
    /// positive). Walked counter-clockwise (`to > from`) it is concave: the free side holds the
    /// centre. Walked clockwise it is convex. It spans at most a full turn.
    Arc {
        /// Centre, mm.
        centre: [f64; 2],
        /// Radius, mm.
        radius: f64,
        /// Angle of the first point.
        from: f64,
        /// Angle of the last point.
        to: f64,
    },
}

/// Signed distance of a point to a profile with its derivatives, and the arc length of the foot
/// point with its derivatives. Symmetric matrices are stored as xx, xy, yy.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Signed distance, mm; positive on the free side.
    pub value: f64,
    /// Its gradient, the outward normal at the foot point.
    pub gradient: [f64; 2],
    /// Its Hessian, 1/mm.
    pub hessian: [f64; 3],
    /// Arc length of the foot point from the start of the chain, mm.
    pub arc_length: f64,
    /// Gradient of the arc length.
    pub arc_gradient: [f64; 2],
    /// Hessian of the arc length, 1/mm.
    pub arc_hessian: [f64; 3],
}

/// A chain of pieces, each starting where the one before ends. Straight first and last pieces go on
/// for ever.
#[derive(Clone, Debug)]
pub struct Profile {
    pieces: Vec<Piece>,
    /// Arc length at the start of each piece, mm.
    arc_starts: Vec<f64>,
    /// Both ends of each piece.
    ends: Vec<[End; 2]>,
}

/// Below this distance from an arc's centre the direction to the foot point is arbitrary, mm.
const CENTRE_RADIUS: f64 = 1e-9;

impl Piece {
    fn length(&self) -> f64 {
        match *self {
            Piece::Segment { start, end } => (end[0] - start[0]).hypot(end[1] - start[1]),
            Piece::Arc {
                radius, from, to, ..
            } => radius * (to - from).abs(),
        }
    }

    fn at(&self, share: f64) -> [f64; 2] {
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
    fn distance(&self, x: [f64; 2], open_start: bool, open_end: bool) -> Option<Distance> {
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
                    hessian: [0.0; 3],
                    arc_length: along,
                    arc_gradient: tangent,
                    arc_hessian: [0.0; 3],
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

    /// Its end at `share` 0 or 1 of its length.
    fn end(&self, share: f64) -> End {
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
struct End {
    x: [f64; 2],
    normal: [f64; 2],
    /// From the start of the piece, mm.
    arc_length: f64,
}

impl End {
    /// Distance to the end point, on the side told by the piece's own normal there.
    fn distance(&self, x: [f64; 2]) -> Distance {
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
            arc_hessian: [0.0; 3],
        }
    }
}

/// Distance and arc length for a point at radius `r` in direction `radial` from the centre of an
/// arc walked with sign `turn`.
fn arc_distance(radial: [f64; 2], r: f64, radius: f64, turn: f64, arc: f64) -> Distance {
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
        arc_hessian: [
            2.0 * mixed * radial[0] * tangent[0],
            mixed * (radial[0] * tangent[1] + radial[1] * tangent[0]),
            2.0 * mixed * radial[1] * tangent[1],
        ],
    }
}

/// `scale` times (I - n n).
fn tangential_projector(n: [f64; 2], scale: f64) -> [f64; 3] {
    [
        scale * n[1] * n[1],
        -scale * n[0] * n[1],
        scale * n[0] * n[0],
    ]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Profile {
    /// A chain of pieces. Each must start where the one before ends.
    pub fn new(pieces: Vec<Piece>) -> Self {
        let arc_starts = pieces
            .iter()
            .scan(0.0, |total, piece| {
                let start = *total;
                *total += piece.length();
                Some(start)
            })
            .collect();
        Self {
            ends: pieces.iter().map(|p| [p.end(0.0), p.end(1.0)]).collect(),
            pieces,
            arc_starts,
        }
    }

    /// Signed distance of `x` (mm) to the closest piece.
    pub fn distance(&self, x: [f64; 2]) -> Distance {
        let last = self.pieces.len() - 1;
        let mut best: Option<Distance> = None;
        let mut consider = |mut candidate: Distance, arc_start: f64| {
            candidate.arc_length += arc_start;
            if best.is_none_or(|b| candidate.value.abs() < b.value.abs()) {
                best = Some(candidate);
            }
        };
        for (i, piece) in self.pieces.iter().enumerate() {
            let start = self.arc_starts[i];
            match piece.distance(x, i == 0, i == last) {
                Some(distance) => consider(distance, start),
                None => {
                    for end in &self.ends[i] {
                        consider(end.distance(x), start);
                    }
                }
            }
        }
        best.unwrap_or(Distance {
            value: f64::INFINITY,
            gradient: [0.0; 2],
            hessian: [0.0; 3],
            arc_length: 0.0,
            arc_gradient: [0.0; 2],
            arc_hessian: [0.0; 3],
        })
    }

    /// The profile as a polyline with at most `spacing` (mm) between points, for pictures. The middle
    /// of every arc is a point.
    pub fn polyline(&self, spacing: f64) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
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
                if (right.arc_length - left.arc_length).abs() > 1e-3
                    || (up.arc_length - down.arc_length).abs() > 1e-3
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
                    d.hessian[0],
                    slope(right.gradient[0], left.gradient[0]),
                    "hessian xx",
                );
                close(
                    d.hessian[1],
                    slope(up.gradient[0], down.gradient[0]),
                    "hessian xy",
                );
                close(
                    d.hessian[2],
                    slope(up.gradient[1], down.gradient[1]),
                    "hessian yy",
                );
                close(
                    d.arc_gradient[0],
                    slope(right.arc_length, left.arc_length),
                    "arc x",
                );
                close(
                    d.arc_gradient[1],
                    slope(up.arc_length, down.arc_length),
                    "arc y",
                );
                let [pr, pl, pu, pd] = [right, left, up, down].map(|d| d.arc_gradient);
                close(d.arc_hessian[0], slope(pr[0], pl[0]), "arc hessian xx");
                close(d.arc_hessian[1], slope(pu[0], pd[0]), "arc hessian xy");
                close(d.arc_hessian[2], slope(pu[1], pd[1]), "arc hessian yy");
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
                    assert!(d.arc_length >= s);
                }
                before = Some((x, d.arc_length));
            }
            assert!(before.is_some_and(|(_, s)| (s - length).abs() < 1e-4));
        }
    }
}
