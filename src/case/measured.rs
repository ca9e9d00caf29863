//! A measured force against the stroke of the punch, as a table.

use super::columns::{Columns, Line, Refusal};
use super::error::CaseError;
use crate::text::{self, shortened, show_real};

const COLUMNS: Columns<3> = Columns {
    names: ["stroke_mm", "force_N", "uncertainty_N"],
    header: "; convert to these units and name the columns so",
    short_line: "the line has another number of columns than the header; each needs a comma",
    allows: |_, number| match number.is_finite() {
        true => Ok(()),
        false => Err("a finite number such as 180.5".to_owned()),
    },
};
/// Points closer than this (mm) would only shorten the time steps.
const CLOSEST: f64 = 1e-3;

/// A point of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// Travel of the punch since its first touch, mm.
    pub stroke: f64,
    /// Force on the punch, whole sheet, N.
    pub force: f64,
    /// Standard uncertainty of the force, N.
    pub uncertainty: f64,
}

/// The points of the file at `path`, going down to at most `stroke` (mm), more than `parameters` of them.
///
/// # Errors
/// [`CaseError::Measured`].
pub fn read_measured(
    path: &str,
    stroke: f64,
    parameters: usize,
) -> Result<Vec<MeasuredPoint>, CaseError> {
    let blame = |(line, problem)| CaseError::Measured {
        path: shortened(path),
        line,
        problem,
    };
    let text = COLUMNS.text(path).map_err(blame)?;
    let points = points(&text, stroke).map_err(blame)?;
    if points.len() <= parameters {
        return Err(blame((
            None,
            format!(
                "points: {}; more than the number of parameters looked for, {parameters}, are needed",
                points.len()
            ),
        )));
    }
    Ok(points)
}

fn points(text: &str, greatest: f64) -> Result<Vec<MeasuredPoint>, Refusal> {
    let mut points: Vec<MeasuredPoint> = Vec::new();
    for Line { line, numbers } in COLUMNS.lines(text)? {
        let [stroke, force, uncertainty] = numbers;
        let point = MeasuredPoint {
            stroke,
            force,
            uncertainty,
        };
        check(point, points.last(), greatest).map_err(|problem| (Some(line), problem))?;
        points.push(point);
    }
    Ok(points)
}

fn check(
    point: MeasuredPoint,
    before: Option<&MeasuredPoint>,
    greatest: f64,
) -> Result<(), String> {
    let MeasuredPoint {
        stroke,
        uncertainty,
        ..
    } = point;
    let least = before.map_or(0.0, |before| before.stroke) + CLOSEST;
    if stroke < least {
        return Err(format!(
            "stroke_mm {}; at least {} is needed, {CLOSEST} above the line before (0 at the start): only the way down \
             is compared, so leave out the rest",
            show_real(stroke),
            show_real(text::rounded(least, 12)),
        ));
    }
    if stroke > greatest * (1.0 + 1e-12) {
        return Err(format!(
            "stroke_mm {} is beyond -stroke {}; increase -stroke, or leave out the line",
            show_real(stroke),
            show_real(greatest)
        ));
    }
    if uncertainty <= 0.0 {
        return Err(format!(
            "uncertainty_N {}; it must be above 0: give the standard uncertainty of the force",
            show_real(uncertainty)
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "# a press\nforce_N, stroke_mm ,uncertainty_N\n49.8,1,0.5\n\n84.7,2,0.8\n";

    #[test]
    fn columns_may_stand_in_any_order() {
        let point = |stroke, force, uncertainty| MeasuredPoint {
            stroke,
            force,
            uncertainty,
        };
        let expected = vec![point(1.0, 49.8, 0.5), point(2.0, 84.7, 0.8)];
        assert_eq!(points(GOOD, 28.5), Ok(expected));
    }

    #[test]
    fn what_cannot_be_compared_is_refused_with_its_line() {
        for (from, to, line, part) in [
            (
                "force_N",
                "force_kN",
                None,
                "the header is 'force_kN,stroke_mm",
            ),
            ("84.7,2,0.8", "84.7,2", Some(5), "another number of columns"),
            ("84.7,2,0.8", "84.7,2,0", Some(5), "above 0"),
            (
                "84.7,2,0.8",
                "NaN,2,0.8",
                Some(5),
                "force_N 'NaN' is not a finite number",
            ),
            (
                "84.7,2,0.8",
                "84.7,0.5,0.8",
                Some(5),
                "at least 1.001 is needed",
            ),
            ("84.7,2,0.8", "84.7,29,0.8", Some(5), "beyond -stroke 28.5"),
        ] {
            let (at, problem) = points(&GOOD.replace(from, to), 28.5).unwrap_err();
            assert_eq!(at, line, "{problem}");
            assert!(problem.contains(part), "{problem}");
        }
    }
}
