//! From corners to lines and roundings, or the corner where that fails.

use std::f64::consts::PI;

use super::Piece;
use super::crossing::first_crossing;
use super::outline::{Bend, Corner, OutlineError, ToolSide};
use crate::plane::{Vector, dot};
use crate::text::number;

/// Corners closer than this are one, and a straight piece shorter than this is none, mm.
const SAME_PLACE: f64 = 1e-9;
/// An outline that turns by less than this goes straight on, radians.
const STRAIGHT: f64 = 1e-9;
/// One that turns by more than a half turn less this goes back, radians.
const BACK: f64 = 1e-6;
/// More corners than this are a drawing that was converted, not drawn.
const MOST_CORNERS: usize = 200;

fn refuse<T>(corner: usize, problem: impl Into<String>) -> Result<T, OutlineError> {
    Err(OutlineError {
        corner: Some(corner),
        crossed: None,
        problem: problem.into(),
    })
}

/// A straight line between two corners.
pub(super) struct Line {
    length: f64,
    direction: Vector,
}

/// Whether the corners are where an outline may go.
pub(super) fn check_places(corners: &[Corner]) -> Result<(), OutlineError> {
    let count = corners.len();
    if !(2..=MOST_CORNERS).contains(&count) {
        return Err(OutlineError {
            corner: None,
            crossed: None,
            problem: format!("corners: {count}; 2 to {MOST_CORNERS} are needed"),
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

/// The lines between them.
pub(super) fn lines(corners: &[Corner]) -> Vec<Line> {
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

/// Where the outline turns.
pub(super) fn bends(
    corners: &[Corner],
    lines: &[Line],
    side: ToolSide,
) -> Result<Vec<Bend>, OutlineError> {
    let mut bends = Vec::new();
    // The last corner has no line after it.
    for (corner, &Corner { radius, .. }) in corners.iter().enumerate().take(lines.len()) {
        let turn = turn(lines, corner);
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
pub(super) fn check_room(corners: &[Corner], lines: &[Line]) -> Result<(), OutlineError> {
    for (index, line) in lines.iter().enumerate() {
        let [before, here] =
            [index, index + 1].map(|corner| tangent_length(corners, lines, corner));
        let needed = before + here;
        if needed > line.length * (1.0 + SAME_PLACE) + SAME_PLACE {
            return refuse(
                index + 1,
                format!(
                    "the line from the corner before is {} mm long, and the roundings at its ends need {} and {} mm of it; use \
                     smaller radii, or move the corners apart",
                    number(line.length),
                    number(before),
                    number(here)
                ),
            );
        }
    }
    Ok(())
}

/// Lines and roundings in turn, each with the corner it leads to or belongs to.
pub(super) fn pieces(corners: &[Corner], lines: &[Line]) -> (Vec<Piece>, Vec<usize>) {
    let mut all = Vec::new();
    let mut at = corners[0].x;
    for (corner, &Corner { x, radius }) in corners.iter().enumerate() {
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
pub(super) fn with_mirror_image(half: &[Piece]) -> Vec<Piece> {
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

/// Whether the pieces cross each other; `owners` are their corners.
pub(super) fn check_crossings(half: &[Piece], owners: &[usize]) -> Result<(), OutlineError> {
    let Some([early, late]) = first_crossing(half) else {
        return Ok(());
    };
    Err(OutlineError {
        corner: Some(owners[late]),
        crossed: Some(owners[early]),
        problem: "on the way to this corner, in its rounding, or beyond the end the outline crosses an earlier part; a tool has \
                  one free side, so draw it without a loop"
            .to_owned(),
    })
}
