//! A tool as a person draws it: the corners of its right half from the axis outwards, each rounded or sharp.

use super::corners::{
    bends, check_crossings, check_places, check_room, lines, pieces, with_mirror_image,
};
use super::{Piece, Profile};
use crate::plane::Vector;

/// Heights that differ by less are the same, mm.
const SAME_PLACE: f64 = 1e-9;

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
    /// The corner before it whose line or rounding is crossed, if one is.
    pub crossed: Option<usize>,
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
            // Roundings begin on the axis but for rounding.
            let x = if x.abs() < SAME_PLACE { 0.0 } else { x };
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
                assert!((distance.arc_length() - s - step).abs() < 1e-4, "{x:?}");
            }
            before = Some((x, distance.arc_length()));
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
            (&DIE[..1], None, "corners: 1"),
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
                "need 3 and 2.5",
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
                "crosses an earlier part",
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
