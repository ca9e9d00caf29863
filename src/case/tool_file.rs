//! The outline of a tool as a table: the corners of its right half and the radii they are rounded with.

use super::columns::{Columns, Line, Refusal};
use super::error::CaseError;
use crate::text::{shortened, show_real};
use crate::tool::{Corner, Outline, ToolSide};

/// Longest coordinate and radius, mm: those of the options.
const GREATEST: f64 = 1e5;
/// The corners of the right half and the radii.
const COLUMNS: Columns<3> = Columns {
    names: ["x_mm", "y_mm", "radius_mm"],
    header: ": the corners of the tool's right half from x = 0 outwards, and the radius each is rounded with",
    short_line: "the line has another number of columns than the header; each needs a comma, and a sharp corner the \
                 radius 0",
    allows: |column, number| {
        let least = if column == 2 { 0.0 } else { -GREATEST };
        match (least..=GREATEST).contains(&number) {
            true => Ok(()),
            false => Err(format!(
                "a number such as 23.5 with {} <= number <= {}",
                show_real(least),
                show_real(GREATEST)
            )),
        }
    },
};

/// A tool from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolFile {
    /// The path as given.
    pub path: String,
    /// The outline at the heights of the file.
    pub outline: Outline,
    /// Line of the file of each corner.
    lines: Vec<u64>,
}

impl ToolFile {
    /// Reads the tool on this side of the sheet that `option` names.
    ///
    /// # Errors
    /// [`CaseError::ToolFile`].
    pub(super) fn read(
        option: &'static str,
        side: ToolSide,
        path: &str,
    ) -> Result<Self, CaseError> {
        let blame = |(line, problem)| CaseError::ToolFile {
            option,
            path: shortened(path),
            line,
            problem,
        };
        let text = COLUMNS.text(path).map_err(blame)?;
        let (lines, corners) = corners(&text).map_err(blame)?;
        let outline = Outline::new(side, &corners).map_err(|error| {
            let line = |corner: Option<usize>| lines.get(corner?).copied();
            let problem = match line(error.crossed) {
                Some(crossed) => format!(
                    "{} (the earlier part is that of line {crossed})",
                    error.problem
                ),
                None => error.problem,
            };
            blame((line(error.corner), problem))
        })?;
        Ok(Self {
            path: path.to_owned(),
            outline,
            lines,
        })
    }

    /// Whether a table has the same corners.
    pub(super) fn is_written(&self, text: &str) -> bool {
        corners(text).is_ok_and(|(_, corners)| corners == self.outline.corners())
    }

    /// The line of the file that holds a corner.
    pub(super) fn line(&self, corner: usize) -> Option<u64> {
        self.lines.get(corner).copied()
    }
}

/// The corners of a table, each with its line.
fn corners(text: &str) -> Result<(Vec<u64>, Vec<Corner>), Refusal> {
    let lines = COLUMNS.lines(text)?.into_iter();
    Ok(lines
        .map(|Line { line, numbers }| {
            let [x, y, radius] = numbers;
            (line, Corner { x: [x, y], radius })
        })
        .unzip())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{any, prop, proptest};

    #[test]
    fn columns_may_stand_in_any_order_and_corners_know_their_lines() {
        let text = "# a die\nradius_mm, x_mm ,y_mm\n0,0,-29\n\n# its shoulder\n4,25,0\n0,85,0\n";
        let (lines, corners) = corners(text).unwrap();
        assert_eq!(lines, [3, 6, 7]);
        assert_eq!(
            corners[1],
            Corner {
                x: [25.0, 0.0],
                radius: 4.0
            }
        );
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in any::<String>()) {
            let _ = corners(&text);
            let _ = corners(&format!("{}\n{text}", COLUMNS.names.join(",")));
        }

        #[test]
        fn any_corners_are_an_outline_or_refused(
            numbers in prop::collection::vec((0.0..30.0, -30.0..30.0, 0.0..3.0), 1..8),
            rounded in any::<bool>(),
        ) {
            let corner = |&(x, y, radius): &(f64, f64, f64)| Corner { x: [x, y], radius: if rounded { radius } else { 0.0 } };
            let mut corners: Vec<Corner> = numbers.iter().map(corner).collect();
            corners[0].x[0] = 0.0;
            if let Some(last) = corners.last_mut() {
                last.radius = 0.0;
            }
            for side in [ToolSide::Below, ToolSide::Above] {
                if let Ok(outline) = Outline::new(side, &corners) {
                    // Every point of it is on it, and a sheet that it touches is not in it.
                    let profile = outline.placed(-outline.first_touch(20.0).y);
                    for x in profile.polyline(0.5) {
                        assert!(profile.distance(x).value.abs() < 1e-7, "{corners:?} {x:?}");
                    }
                    let up = if side == ToolSide::Below { 1.0 } else { -1.0 };
                    for k in 0..=40 {
                        let x = [0.5 * f64::from(k), 1e-3 * up];
                        assert!(profile.distance(x).value > 0.0, "{side:?} {corners:?} {x:?}");
                    }
                }
            }
        }
    }
}
