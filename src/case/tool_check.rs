//! Refuses tools from files that cannot work with each other, with the sheet, or with its contact points.

use super::error::CaseError;
use super::model::Case;
use super::table;
use crate::contact::ContactLocation;
use crate::plane::Vector;
use crate::text::{number, shortened};
use crate::tool::Bend;

/// The gap between the tools is looked for at so many strokes, and at points of the punch apart by this share of the
/// thickness.
const STROKES: usize = 32;
const SPACING: f64 = 0.05;
/// At most so many points.
const MOST_POINTS: f64 = 2e4;
/// Moving contact points find a rounding whose radius is at least this share of their edge: 0.2 mm on edges of 1 mm was
/// tried, with 0.06 % of noise in the force.
const LEAST_OF_EDGE: f64 = 0.2;
/// A gap less than the thickness by no more than this share is rounding.
const ROUNDING: f64 = 1e-9;

/// Where the tools come closest to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastGap {
    /// How far they are apart, mm.
    pub gap: f64,
    /// The point of the punch, mm.
    pub at: Vector,
    /// Stroke, mm.
    pub stroke: f64,
}

/// Checks tools of which at least one is from a file.
pub(super) fn check(case: &Case) -> Result<(), CaseError> {
    check_corners(case)?;
    check_support(case)?;
    check_gap(case)
}

/// How far a place that sticks out gets into a straight edge between two contact points that both lie on the outline, mm.
/// It grows with the square of their distance where the rounding is long, and linearly at a sharp corner.
fn reach_between_points(bend: &Bend, spacing: f64) -> f64 {
    let (half, r, angle) = (0.5 * spacing, bend.radius, 0.5 * bend.turn);
    if half <= r * angle.sin() {
        r - (r * r - half * half).sqrt()
    } else {
        half * angle.tan() - r * (1.0 / angle.cos() - 1.0)
    }
}

/// Whether a place that sticks out is felt. One sharper than the contact points are dense goes through the sheet between
/// them, however hard it is. A moving point finds a rounding wherever it is, but at a sharp corner it has no normal.
fn is_felt(case: &Case, bend: &Bend) -> bool {
    let spacing = case.contact_spacing();
    let moves = case.discretisation.contact_location == ContactLocation::Closest;
    bend.turn <= 0.0
        || (moves && bend.radius >= LEAST_OF_EDGE * spacing)
        || reach_between_points(bend, spacing) <= case.discretisation.penetration_limit
}

/// The least radius that sticks out and is felt, mm.
fn least_radius(case: &Case) -> f64 {
    let spacing = case.contact_spacing();
    let limit = case.discretisation.penetration_limit;
    match case.discretisation.contact_location {
        ContactLocation::Closest => LEAST_OF_EDGE * spacing,
        ContactLocation::Points | ContactLocation::Nodes => {
            spacing * spacing / (8.0 * limit) + 0.5 * limit
        }
    }
}

fn check_corners(case: &Case) -> Result<(), CaseError> {
    let spacing = case.contact_spacing();
    let files = [
        (table::PUNCH_PROFILE.name, &case.tools.punch_file),
        (table::DIE_PROFILE.name, &case.tools.die_file),
    ];
    for (option, file) in files {
        let Some(file) = file else { continue };
        let Some(bend) = file
            .outline
            .bends()
            .iter()
            .find(|bend| !is_felt(case, bend))
        else {
            continue;
        };
        let what = if bend.radius > 0.0 {
            format!("the radius {} mm is too small", bend.radius)
        } else {
            "the corner sticks out and is sharp".to_owned()
        };
        // Rounded up, so that what is advised is accepted.
        let least = (100.0 * least_radius(case)).ceil() / 100.0;
        let why = match case.discretisation.contact_location {
            ContactLocation::Closest => format!(
                "moving contact points follow the tool's normal, and it turns here too sharply for edges of the sheet that are \
                 {} mm long",
                number(spacing)
            ),
            ContactLocation::Points | ContactLocation::Nodes => format!(
                "between two contact points, which are {} mm apart, it would get {} mm into the sheet, and -penetration_limit \
                 is {} mm",
                number(spacing),
                number(reach_between_points(bend, spacing)),
                number(case.discretisation.penetration_limit)
            ),
        };
        return Err(CaseError::ToolFile {
            option,
            path: shortened(&file.path),
            line: file.line(bend.corner),
            problem: format!(
                "{what}: {why}; use a radius of {least} mm or more, or more elements with -sheet_nx"
            ),
        });
    }
    Ok(())
}

/// The sheet has to lie on the die outside of where the punch pushes it, with one thickness to spare at its end.
fn check_support(case: &Case) -> Result<(), CaseError> {
    let half_length = case.sheet.half_length();
    let [die, punch] = case
        .outlines()
        .map_err(broken)?
        .map(|outline| outline.first_touch(half_length));
    let (held, pushed) = (die.x[0], punch.x[1]);
    if held <= pushed {
        return Err(CaseError::Tools(format!(
            "the die holds the sheet at x = {} mm and the punch pushes it at x = {} mm, so it is squeezed and not bent; the die's \
             highest point under the sheet has to be farther out than the punch's lowest",
            number(held),
            number(pushed)
        )));
    }
    let margin = case.sheet.thickness;
    if half_length > held + margin {
        return Ok(());
    }
    Err(CaseError::Tools(format!(
        "half of -sheet_length is {} mm and the die holds the sheet from x = {} mm on; use a -sheet_length above {} mm, which \
         leaves a thickness to spare at each end",
        number(half_length),
        number(held),
        number(2.0 * (held + margin))
    )))
}

fn check_gap(case: &Case) -> Result<(), CaseError> {
    let least = case.least_gap()?;
    let thickness = case.sheet.thickness;
    if least.gap > thickness * (1.0 + ROUNDING) {
        return Ok(());
    }
    Err(CaseError::Tools(format!(
        "at a stroke of {} mm they are {:.4} mm apart at ({:.3}, {:.3}) mm and -sheet_thickness is {} mm, so the sheet would be \
         squeezed; use a shorter -stroke (now {} mm), or tools with more room there",
        number(least.stroke),
        least.gap,
        least.at[0],
        least.at[1],
        number(thickness),
        number(case.loading.stroke)
    )))
}

/// The outlines of the case were built before, so this is not reached.
fn broken(error: crate::tool::OutlineError) -> CaseError {
    CaseError::Tools(error.problem)
}

impl Case {
    /// Where the tools come closest while the punch goes down, as far as the sheet reaches.
    ///
    /// # Errors
    /// If the radii of the benchmark's tools make no outline.
    pub fn least_gap(&self) -> Result<LeastGap, CaseError> {
        let half_length = self.sheet.half_length();
        let [_, punch] = self.outlines().map_err(broken)?;
        let (die, thickness) = (self.die(), self.sheet.thickness);
        let up = thickness - punch.first_touch(half_length).y;
        let rough = punch.points(f64::INFINITY, half_length);
        let length: f64 = rough
            .windows(2)
            .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
            .sum();
        let points = punch.points((SPACING * thickness).max(length / MOST_POINTS), half_length);
        let mut least = LeastGap {
            gap: f64::INFINITY,
            at: [0.0; 2],
            stroke: 0.0,
        };
        for step in 1..=STROKES {
            let stroke = self.loading.stroke * step as f64 / STROKES as f64;
            for &[x, y] in &points {
                let at = [x, y + up - stroke];
                let gap = die.distance(at).value;
                if gap < least.gap {
                    least = LeastGap { gap, at, stroke };
                }
            }
        }
        Ok(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_reaches_in_as_far_as_its_outline_does() {
        // A rounded right angle with its tip in the origin, looked at between two points of the outline at the same height.
        let bend = |radius: f64, degrees: f64| Bend {
            corner: 0,
            radius,
            turn: degrees.to_radians(),
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(reach_between_points(&bend(0.0, 90.0), 0.2), 0.1);
        close(reach_between_points(&bend(5.0, 90.0), 6.0), 1.0);
        // Where the rounding ends both formulas agree.
        let end = 2.0 * 3.0 * (0.5_f64).sin();
        let just = |s: f64| reach_between_points(&bend(3.0, 1.0_f64.to_degrees()), end * s);
        assert!((just(1.0 - 1e-9) - just(1.0 + 1e-9)).abs() < 1e-8);
        // A kink of half a degree is no corner to speak of.
        assert!(reach_between_points(&bend(0.0, 0.5), 0.06) < 2e-4);
    }
}
