//! Refuses tools and sheets that cannot work, and says why in numbers.

use super::error::CaseError;
use super::model::Case;
use super::tool_check;

/// Checks sheet, tools and stroke together.
pub(crate) fn check(case: &Case) -> Result<(), CaseError> {
    if case.tools.from_file() {
        return tool_check::check(case);
    }
    check_punch(case)?;
    check_clearance(case)?;
    check_depth(case)?;
    check_support(case)
}

/// A punch that is finer than the contact points goes through the sheet between them.
fn check_punch(case: &Case) -> Result<(), CaseError> {
    let spacing = case.contact_spacing();
    let punch_radius = case.tools.punch_radius;
    if punch_radius >= spacing {
        Ok(())
    } else {
        Err(CaseError::PunchUnseen {
            punch_radius,
            spacing,
        })
    }
}

/// The die's opening is narrowest where shoulder and cavity meet, at x = die radius; there the sheet must pass between
/// the die and the punch's vertical side. A sheet as thick as the clearance would need both at zero gap.
fn check_clearance(case: &Case) -> Result<(), CaseError> {
    let (die_radius, punch_radius) = (case.tools.die_radius, case.tools.punch_radius);
    let thickness = case.sheet.thickness;
    // Differences of decimal numbers are rounded: 1 + 1e-16 is no clearance for a sheet of 1.
    let clearance = die_radius - punch_radius;
    if clearance > thickness + 1e-9 * die_radius {
        return Ok(());
    }
    let clearance = (clearance * 1e9).round() / 1e9;
    Err(CaseError::NoClearance {
        die_radius,
        punch_radius,
        clearance,
        thickness,
    })
}

/// Between the punch's lowest point and the bottom of the cavity: thickness - stroke + depth, to be more than thickness.
fn check_depth(case: &Case) -> Result<(), CaseError> {
    let (stroke, depth) = (case.loading.stroke, case.tools.die_edge());
    if stroke < depth {
        Ok(())
    } else {
        Err(CaseError::StrokeTooDeep { stroke, depth })
    }
}

/// The sheet has to lie on the flat at first and to reach over the shoulder at full stroke, each with one thickness to
/// spare: its end is a corner of that size.
fn check_support(case: &Case) -> Result<(), CaseError> {
    let half_length = case.sheet.half_length();
    let margin = case.sheet.thickness;
    let die_edge = case.tools.die_edge();
    if half_length <= die_edge + margin {
        return Err(CaseError::SheetTooShort {
            half_length,
            die_edge,
            least_length: 2.0 * (die_edge + margin),
        });
    }
    let path = inner_path(case);
    if half_length <= path + margin {
        return Err(CaseError::SheetSlipsOff {
            stroke: case.loading.stroke,
            path,
            half_length,
            least_length: 2.0 * (path + margin),
        });
    }
    Ok(())
}

/// Shortest path (mm) of the sheet's lower side at full stroke from the plane of symmetry to the shoulder: round the punch,
/// then along the common tangent of the punch (with the sheet on it) and the shoulder. A sheet that leaves the punch
/// takes a longer path, so a shorter sheet slips off for certain.
pub(crate) fn inner_path(case: &Case) -> f64 {
    let punch = case.tools.punch_radius + case.sheet.thickness;
    let shoulder = case.tools.die_shoulder_radius;
    // From the punch's centre to the shoulder's.
    let across = case.tools.die_edge();
    let down = -shoulder - (punch - case.loading.stroke);
    let distance = across.hypot(down);
    let tangent = ((distance - punch - shoulder) * (distance + punch + shoulder))
        .max(0.0)
        .sqrt();
    let tangent_point = down.atan2(across) - tangent.atan2(punch + shoulder);
    let wrapped = (tangent_point + std::f64::consts::FRAC_PI_2).max(0.0);
    punch * wrapped + tangent
}

/// Refuses more MPI ranks than elements.
///
/// # Errors
/// [`CaseError::TooManyRanks`].
pub fn check_ranks(ranks: usize, case: &Case) -> Result<(), CaseError> {
    let (nx, ny, elements) = (
        case.discretisation.nx,
        case.discretisation.ny,
        case.discretisation.elements(),
    );
    if ranks <= elements {
        Ok(())
    } else {
        Err(CaseError::TooManyRanks {
            ranks,
            elements,
            nx,
            ny,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_before_the_stroke_is_flat() {
        let mut case = Case::reference().unwrap();
        case.loading.stroke = 1e-12;
        assert!((inner_path(&case) - case.tools.die_edge()).abs() < 1e-6);
    }

    #[test]
    fn at_full_stroke_the_arm_has_the_angle_of_the_closed_form() {
        // Concentric circles: loaded angle 21.31 degrees = 2 acos((R1 + t + R3) / (R2 + R3)).
        let case = Case::reference().unwrap();
        let angle = (28.5_f64 / 29.0).acos();
        let expected = 24.5 * (std::f64::consts::FRAC_PI_2 - angle)
            + (29.0_f64.powi(2) - 28.5_f64.powi(2)).sqrt();
        assert!((2.0 * angle.to_degrees() - 21.31).abs() < 0.01);
        assert!((inner_path(&case) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_path_is_longest_before_or_after_the_stroke() {
        // So it is enough to check these two.
        let mut case = Case::reference().unwrap();
        let longest = inner_path(&case).max(case.tools.die_edge());
        for step in 1..=285 {
            case.loading.stroke = 0.1 * f64::from(step);
            assert!(inner_path(&case) <= longest);
        }
    }
}
