//! A tool as a person draws it: the corners of its right half from the axis outwards, each rounded or sharp.

use std::f64::consts::PI;

use super::crossing::first_crossing;
use super::{Piece, Profile};
use crate::plane::{Vector, dot};

/// Corners closer than this are one, and a straight piece shorter than this is none, mm.
const SAME_PLACE: f64 = 1e-9;
/// An outline that turns by less than this goes straight on, radians.
const STRAIGHT: f64 = 1e-9;
/// One that turns by more than a half turn less this goes back, radians.
const BACK: f64 = 1e-6;
/// More corners than this are a drawing that was converted, not drawn.
const MOST_CORNERS: usize = 200;

/// A corner of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where the straight lines meet, mm.
    pub x: Vector,
    /// Radius of the rounding that touches both, mm; 0 leaves the corner sharp.
    pub radius: f64,
}

/// On which side of the sheet a tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolSide {
    /// Below the sheet: what is above the outline is free.
    Below,
    /// Above the sheet: what is below the outline is free.
    Above,
}

/// Why corners are no outline.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}")]
pub struct OutlineError {
    /// The corner to blame from 0, if one is.
    pub corner: Option<usize>,
    /// What is wrong, and what to do.
    pub problem: String,
}

/// A place where an outline turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Its corner, from 0.
    pub corner: usize,
    /// Radius, mm; 0 where it is sharp.
    pub radius: f64,
    /// By how much it turns, radians; positive where the tool sticks out (convex).
    pub turn: f64,
}

/// The part of a flat sheet that a tool touches first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTouch {
    /// Height of the tool there, mm.
    pub y: f64,
    /// From where to where along the sheet, mm.
    pub x: [f64; 2],
}

/// The right half of a symmetric tool, from the axis x = 0 outwards. Its last line goes on for ever.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    side: ToolSide,
    corners: Vec<Corner>,
    bends: Vec<Bend>,
    /// From the axis outwards, of the right half only.
    half: Vec<Piece>,
}

fn refuse<T>(corner: usize, problem: impl Into<String>) -> Result<T, OutlineError> {
    Err(OutlineError {
        corner: Some(corner),
        problem: problem.into(),
    })
}

impl Outline {
    /// The outline with these corners.
    ///
    /// # Errors
    /// The first corner where it is none: off the axis, back or across itself, or a rounding that does not fit.
    pub fn new(side: ToolSide, corners: &[Corner]) -> Result<Self, OutlineError> {
        check_places(corners)?;
        let lines = lines(corners);
        let bends = bends(corners, &lines, side)?;
        check_room(corners, &lines)?;
        let (half, owners) = pieces(corners, &lines);
        check_crossings(&half, &owners)?;
        Ok(Self {
            side,
            corners: corners.to_vec(),
            bends,
            half,
        })
    }

    /// What it was made of.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Where it turns, from the axis outwards.
    pub fn bends(&self) -> &[Bend] {
        &self.bends
    }

    /// Where it first touches a flat sheet of this half length (mm): at its highest points there, or its lowest if the tool
    /// is above.
    pub fn first_touch(&self, half_length: f64) -> FirstTouch {
        let up = match self.side {
            ToolSide::Below => 1.0,
            ToolSide::Above => -1.0,
        };
        let mut touch = FirstTouch {
            y: -up * f64::INFINITY,
            x: [0.0; 2],
        };
        for [x, y] in self.candidates(half_length) {
            let above = up * (y - touch.y);
            if above > SAME_PLACE {
                touch = FirstTouch { y, x: [x; 2] };
            } else if above > -SAME_PLACE {
                touch.y = up * f64::max(up * y, up * touch.y);
                touch.x = [touch.x[0].min(x), touch.x[1].max(x)];
            }
        }
        touch
    }

    /// Ends of pieces, tops and bottoms of arcs, and where pieces leave the sheet: the highest and lowest points are among
    /// them.
    fn candidates(&self, half_length: f64) -> Vec<Vector> {
        let mut points = Vec::new();
        for piece in &self.half {
            points.extend([piece.at(0.0), piece.at(1.0)]);
            match *piece {
                Piece::Segment { start, end } => points.extend(crossing(start, end, half_length)),
                Piece::Arc { centre, radius, .. } => {
                    let [x, y] = centre;
                    points.extend(
                        [[x, y + radius], [x, y - radius]]
                            .into_iter()
                            .filter(|&p| piece.holds(p)),
                    );
                    let aside = half_length - x;
                    if aside.abs() < radius {
                        let up = (radius * radius - aside * aside).sqrt();
                        let both = [[half_length, y + up], [half_length, y - up]];
                        points.extend(both.into_iter().filter(|&p| piece.holds(p)));
                    }
                }
            }
        }
        // The last line goes on.
        if let Some(&Piece::Segment { start, end }) = self.half.last() {
            let far = onward(start, end, 1e6);
            points.extend(crossing(start, far, half_length));
        }
        points.retain(|point| point[0] <= half_length);
        points
    }

    /// The tool with its outline moved up by `shift` (mm). Only what begins on the axis has its mirror image with it: for a
    /// point of the right half nothing else on the left is ever closest.
    pub fn placed(&self, shift: f64) -> Profile {
        let mut pieces = with_mirror_image(&self.half);
        for piece in &mut pieces {
            match piece {
                Piece::Segment { start, end } => {
                    start[1] += shift;
                    end[1] += shift;
                }
                Piece::Arc { centre, .. } => centre[1] += shift,
            }
        }
        if self.side == ToolSide::Above {
            pieces.reverse();
            for piece in &mut pieces {
                *piece = piece.reversed();
            }
        }
        Profile::chained(pieces)
    }

    /// Points of the right half, at most `spacing` (mm) apart, and of its last line as far as `beyond` (mm) after its end.
    pub fn points(&self, spacing: f64, beyond: f64) -> Vec<Vector> {
        let mut points = Vec::new();
        let mut walk = |piece: &Piece| {
            let pieces = (piece.length() / spacing).ceil().max(1.0) as usize;
            points.extend((0..=pieces).map(|k| piece.at(k as f64 / pieces as f64)));
        };
        self.half.iter().for_each(&mut walk);
        if let Some(&Piece::Segment { start, end }) = self.half.last() {
            walk(&Piece::Segment {
                start: end,
                end: onward(start, end, beyond),
            });
        }
        points
    }
}

/// The point this far (mm) behind the end of a line.
fn onward(start: Vector, end: Vector, far: f64) -> Vector {
    let length = (end[0] - start[0]).hypot(end[1] - start[1]);
    [0, 1].map(|k| end[k] + far * (end[k] - start[k]) / length)
}

/// Where a line crosses the level x, if it does.
fn crossing(start: Vector, end: Vector, x: f64) -> Option<Vector> {
    let share = (x - start[0]) / (end[0] - start[0]);
    (share > 0.0 && share < 1.0).then(|| [x, start[1] + share * (end[1] - start[1])])
}

/// A straight line between two corners.
struct Line {
    length: f64,
    direction: Vector,
}

fn check_places(corners: &[Corner]) -> Result<(), OutlineError> {
    let count = corners.len();
    if !(2..=MOST_CORNERS).contains(&count) {
        return Err(OutlineError {
            corner: None,
            problem: format!("it has {count} corners; 2 to {MOST_CORNERS} are needed"),
        });
    }
    let (first, last) = (&corners[0], &corners[count - 1]);
    if first.x[0] != 0.0 {
        return if last.x[0] == 0.0 {
            refuse(
                0,
                "the outline ends on the symmetry line x = 0; write it the other way round, from there outwards",
            )
        } else {
            refuse(
                0,
                format!(
                    "the first corner is at x = {} mm; the outline begins on the symmetry line x = 0",
                    first.x[0]
                ),
            )
        };
    }
    for (index, pair) in corners.windows(2).enumerate() {
        let later = pair[1].x;
        let apart = (later[0] - pair[0].x[0]).hypot(later[1] - pair[0].x[1]);
        if later[0] < 0.0 {
            return refuse(
                index + 1,
                format!(
                    "x = {} mm is left of the symmetry line; only the right half is written, x >= 0",
                    later[0]
                ),
            );
        }
        if apart <= SAME_PLACE {
            return refuse(
                index + 1,
                "this corner is where the one before is; leave one of them out",
            );
        }
    }
    if last.radius != 0.0 {
        return refuse(
            count - 1,
            "the outline ends here and goes straight on, so there is nothing to round; the last radius is 0",
        );
    }
    if last.x[0] < corners[count - 2].x[0] {
        return refuse(
            count - 1,
            "the last line goes on beyond its end, and so back to the symmetry line; end with one that does not",
        );
    }
    Ok(())
}

fn lines(corners: &[Corner]) -> Vec<Line> {
    let line = |pair: &[Corner]| {
        let step = [0, 1].map(|k| pair[1].x[k] - pair[0].x[k]);
        let length = step[0].hypot(step[1]);
        Line {
            length,
            direction: step.map(|s| s / length),
        }
    };
    corners.windows(2).map(line).collect()
}

/// Directions before and after a corner that is not the last. Before the first is the mirror image of what is after it.
fn directions(lines: &[Line], corner: usize) -> [Vector; 2] {
    let after = lines[corner].direction;
    let before = match corner.checked_sub(1) {
        Some(line) => lines[line].direction,
        None => [after[0], -after[1]],
    };
    [before, after]
}

fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// By how much the outline turns at a corner, radians; positive to the left.
fn turn(lines: &[Line], corner: usize) -> f64 {
    let [before, after] = directions(lines, corner);
    cross(before, after).atan2(dot(before, after))
}

/// How far from a corner its rounding begins and ends, mm.
fn tangent_length(corners: &[Corner], lines: &[Line], corner: usize) -> f64 {
    if corner >= lines.len() {
        return 0.0;
    }
    let [before, after] = directions(lines, corner);
    // r tan(turn / 2), without the tangent's rounding where the turn is a right angle.
    corners[corner].radius * cross(before, after).abs() / (1.0 + dot(before, after))
}

fn bends(corners: &[Corner], lines: &[Line], side: ToolSide) -> Result<Vec<Bend>, OutlineError> {
    let mut bends = Vec::new();
    for (corner, _) in lines.iter().enumerate() {
        let (turn, radius) = (turn(lines, corner), corners[corner].radius);
        if turn.abs() > PI - BACK {
            return refuse(
                corner,
                "the outline goes back along itself here; a tool has two sides, so leave room between them",
            );
        }
        if turn.abs() > STRAIGHT {
            // The die is walked with the free side on the left: it sticks out where it turns to the right.
            let convex = match side {
                ToolSide::Below => -turn,
                ToolSide::Above => turn,
            };
            bends.push(Bend {
                corner,
                radius,
                turn: convex,
            });
        } else if radius > 0.0 {
            return refuse(
                corner,
                format!(
                    "the outline goes straight on here, so the radius {radius} mm rounds nothing; make it 0"
                ),
            );
        }
    }
    Ok(bends)
}

/// Whether the roundings at both ends of every line fit on it.
fn check_room(corners: &[Corner], lines: &[Line]) -> Result<(), OutlineError> {
    for (index, line) in lines.iter().enumerate() {
        let [before, here] =
            [index, index + 1].map(|corner| tangent_length(corners, lines, corner));
        let needed = before + here;
        if needed > line.length * (1.0 + SAME_PLACE) + SAME_PLACE {
            return refuse(
                index + 1,
                format!(
                    "the line from the corner before is {:.6} mm long, and the roundings at its ends need {before:.6} and \
                     {here:.6} mm of it; use smaller radii, or move the corners apart",
                    line.length
                ),
            );
        }
    }
    Ok(())
}

/// Lines and roundings in turn, each with the corner it leads to or belongs to.
fn pieces(corners: &[Corner], lines: &[Line]) -> (Vec<Piece>, Vec<usize>) {
    let mut all = Vec::new();
    let mut at = corners[0].x;
    for corner in 0..corners.len() {
        let Corner { x, radius } = corners[corner];
        let rounded = tangent_length(corners, lines, corner);
        if rounded <= SAME_PLACE {
            if corner > 0 {
                all.push((Piece::Segment { start: at, end: x }, corner));
            }
            at = x;
            continue;
        }
        let [before, after] = directions(lines, corner);
        let left = cross(before, after).signum();
        let start = [0, 1].map(|k| x[k] - rounded * before[k]);
        let end = [0, 1].map(|k| x[k] + rounded * after[k]);
        let inwards = [-left * before[1], left * before[0]];
        let mut centre = [0, 1].map(|k| start[k] + radius * inwards[k]);
        let straight = (start[0] - at[0]).hypot(start[1] - at[1]);
        if corner > 0 && straight > SAME_PLACE {
            all.push((
                Piece::Segment {
                    start: at,
                    end: start,
                },
                corner,
            ));
        }
        // What begins on the axis is one with its mirror image.
        if centre[0].abs() <= SAME_PLACE * radius.max(1.0) {
            centre[0] = 0.0;
        }
        let angle = |p: Vector| (p[1] - centre[1]).atan2(p[0] - centre[0]);
        let from = if corner == 0 {
            -left * 0.5 * PI
        } else {
            angle(start)
        };
        let to = angle(end);
        let to = if left * (to - from) < 0.0 {
            to + left * 2.0 * PI
        } else {
            to
        };
        let arc = Piece::Arc {
            centre,
            radius,
            from,
            to,
        };
        all.push((arc, corner));
        at = end;
    }
    all.into_iter().unzip()
}

/// The pieces with the mirror image of the first before it, in one with it where the outline crosses the axis smoothly.
fn with_mirror_image(half: &[Piece]) -> Vec<Piece> {
    let mut pieces = half.to_vec();
    match &mut pieces[0] {
        Piece::Segment { start, end } if (end[1] - start[1]).abs() <= SAME_PLACE * end[0] => {
            *start = [-end[0], end[1]];
        }
        Piece::Arc {
            centre, from, to, ..
        } if centre[0] == 0.0 => {
            *from = (*from - *to).signum() * PI - *to;
        }
        first => {
            let image = first.mirrored();
            pieces.insert(0, image);
        }
    }
    pieces
}

fn check_crossings(half: &[Piece], owners: &[usize]) -> Result<(), OutlineError> {
    let Some([early, late]) = first_crossing(half) else {
        return Ok(());
    };
    let (corner, other) = (owners[late], owners[early]);
    let what = match half[early] {
        Piece::Segment { .. } => "the line to",
        Piece::Arc { .. } => "the rounding of",
    };
    refuse(
        corner,
        format!(
            "here, or on the way to here or beyond the end, the outline crosses {what} corner {}; a tool has one free side, so \
             draw it without a loop",
            other + 1
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::super::{die, punch};
    use super::*;

    fn outline(side: ToolSide, corners: &[[f64; 3]]) -> Result<Outline, OutlineError> {
        let corner = |&[x, y, radius]: &[f64; 3]| Corner { x: [x, y], radius };
        Outline::new(side, &corners.iter().map(corner).collect::<Vec<_>>())
    }

    const DIE: [[f64; 3]; 4] = [
        [0.0, -29.0, 0.0],
        [25.0, -29.0, 25.0],
        [25.0, 0.0, 4.0],
        [85.0, 0.0, 0.0],
    ];
    const PUNCH: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [23.5, 0.0, 23.5], [23.5, 52.0, 0.0]];

    #[test]
    fn the_benchmarks_tools_have_the_same_bits() {
        let tools = [
            (
                outline(ToolSide::Below, &DIE).unwrap().placed(0.0),
                die(25.0, 4.0, 60.0),
            ),
            (
                outline(ToolSide::Above, &PUNCH).unwrap().placed(1.0),
                punch(23.5, 1.0, 28.5),
            ),
        ];
        for (ours, theirs) in tools {
            for i in 0..=130 {
                for j in 0..=160 {
                    let x = [0.5 * f64::from(i), 0.5 * f64::from(j) - 35.0];
                    let bits = |profile: &Profile| format!("{:?}", profile.distance(x));
                    assert_eq!(bits(&ours), bits(&theirs), "{x:?}");
                }
            }
        }
    }

    #[test]
    fn roundings_touch_both_lines_wherever_they_are() {
        // A V with a rounded bottom on the axis, a shoulder, an undercut and a sharp step.
        let corners = [
            [0.0, -9.0, 2.0],
            [9.0, 0.0, 3.0],
            [30.0, 0.0, 0.0],
            [27.0, -8.0, 1.0],
            [60.0, -8.0, 0.0],
        ];
        let outline = outline(ToolSide::Below, &corners).unwrap();
        let profile = outline.placed(0.0);
        let turns: Vec<f64> = outline
            .bends()
            .iter()
            .map(|bend| bend.turn.to_degrees().round())
            .collect();
        assert_eq!(turns, [-90.0, 45.0, 111.0, -111.0]);
        let mut before: Option<([f64; 2], f64)> = None;
        for x in profile.polyline(0.01) {
            let distance = profile.distance(x);
            assert!(distance.value.abs() < 1e-12, "{x:?}");
            // No jump: every piece begins where the one before ends, and roundings without a kink.
            if let Some((y, s)) = before {
                let step = (x[0] - y[0]).hypot(x[1] - y[1]);
                assert!((distance.arc_length - s - step).abs() < 1e-4, "{x:?}");
            }
            before = Some((x, distance.arc_length));
        }
        // The bottom of the rounding: the corner is r (√2 - 1) below it.
        let bottom = -9.0 + 2.0 * (2.0_f64.sqrt() - 1.0);
        assert!((profile.distance([0.0, bottom + 0.5]).value - 0.5).abs() < 1e-12);
        assert!(
            profile.distance([28.0, -4.0]).value < 0.0,
            "under the undercut's edge"
        );
        assert!(profile.distance([35.0, -4.0]).value > 0.0);
    }

    #[test]
    fn a_tool_touches_a_flat_sheet_where_it_is_highest() {
        let die = outline(ToolSide::Below, &DIE).unwrap();
        assert_eq!(
            die.first_touch(60.0),
            FirstTouch {
                y: 0.0,
                x: [29.0, 60.0]
            }
        );
        let punch = outline(ToolSide::Above, &PUNCH).unwrap();
        assert_eq!(
            punch.first_touch(60.0),
            FirstTouch {
                y: 0.0,
                x: [0.0, 0.0]
            }
        );
        // A sheet that ends on the slope, and one that ends on an arc.
        let slope = outline(ToolSide::Below, &[[0.0, 0.0, 0.0], [10.0, 5.0, 0.0]]).unwrap();
        assert_eq!(
            slope.first_touch(4.0),
            FirstTouch {
                y: 2.0,
                x: [4.0, 4.0]
            }
        );
        assert_eq!(slope.first_touch(20.0).y, 10.0);
        let touch = die.first_touch(26.0);
        assert!((touch.y - (7.0_f64.sqrt() - 4.0)).abs() < 1e-12 && touch.x == [26.0, 26.0]);
    }

    #[test]
    fn what_is_no_outline_is_refused_at_its_corner() {
        let refusal = |corners: &[[f64; 3]]| outline(ToolSide::Below, corners).unwrap_err();
        for (corners, corner, part) in [
            (&DIE[..1], None, "1 corners"),
            (
                &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
                Some(0),
                "begins on the symmetry line",
            ),
            (
                &[[2.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
                Some(0),
                "the other way round",
            ),
            (
                &[[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]],
                Some(1),
                "left of the symmetry line",
            ),
            (
                &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
                Some(2),
                "where the one before is",
            ),
            (
                &[[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]],
                Some(1),
                "nothing to round",
            ),
            (
                &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, -3.0, 0.0]],
                Some(2),
                "back to the symmetry line",
            ),
            (
                &[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
                Some(0),
                "back along itself",
            ),
            (
                &[
                    [0.0, 0.0, 0.0],
                    [2.0, 0.0, 0.0],
                    [1.0, 0.0, 0.0],
                    [1.0, 1.0, 0.0],
                ],
                Some(1),
                "back along itself",
            ),
            (
                &[[0.0, 0.0, 3.0], [2.0, 0.0, 0.0]],
                Some(0),
                "rounds nothing",
            ),
            (
                &[
                    [0.0, -5.0, 0.0],
                    [5.0, -5.0, 3.0],
                    [5.0, 0.0, 2.5],
                    [9.0, 0.0, 0.0],
                ],
                Some(2),
                "need 3.000000 and 2.500000",
            ),
            (
                &[
                    [0.0, 0.0, 0.0],
                    [9.0, 0.0, 0.0],
                    [9.0, 5.0, 0.0],
                    [5.0, 5.0, 0.0],
                    [5.0, -1.0, 0.0],
                ],
                Some(4),
                "crosses the line to corner 2",
            ),
            (
                &[
                    [0.0, 0.0, 0.0],
                    [9.0, 0.0, 0.0],
                    [9.0, 5.0, 0.0],
                    [5.0, 5.0, 0.0],
                    [5.0, 4.0, 0.0],
                ],
                Some(4),
                "crosses",
            ),
        ] {
            let error = refusal(corners);
            assert_eq!(error.corner, corner, "{error}");
            assert!(error.problem.contains(part), "{error}");
        }
    }
}
