//! What a run says about itself that no verdict says.

use crate::case::Case;
use crate::contact::ContactLocation;
use crate::output::{StepRecord, number};

/// The notes on a run, whether it finished or not.
pub(in crate::run) fn notes(case: &Case, records: &[StepRecord]) -> Vec<String> {
    let limit = case.discretisation.penetration_limit;
    let Some(first) = records
        .iter()
        .find(|record| record.max_penetration_mm > limit)
    else {
        return Vec::new();
    };
    let deepest = records
        .iter()
        .map(|record| record.max_penetration_mm)
        .fold(0.0, f64::max);
    let sizes = &case.discretisation;
    let edge = case.sheet.half_length() / sizes.nx as f64;
    let (spacing, points) = match sizes.contact_location {
        ContactLocation::Points => (
            edge / sizes.contact_points_per_edge as f64,
            "contact points",
        ),
        ContactLocation::Nodes => (0.5 * edge, "contact points (nodes)"),
        ContactLocation::Closest => (edge, "edges with one moving contact point each"),
    };
    // Between points of an edge the tool enters with the square of their distance: measured on the benchmark's tools,
    // see docs/it-does-not-converge.md.
    let enough = 1.3 * sizes.nx as f64 * (deepest / limit).sqrt();
    let enough = 5 * (enough / 5.0).ceil() as usize;
    let stiff = "make the surface stiffer with a smaller -contact_compliance";
    let remedy = if deepest > 4.0 * limit || spacing > 0.3 {
        format!("use -sheet_nx {enough} or more (now {})", sizes.nx)
    } else {
        format!(
            "use -sheet_nx {enough} or more (now {}), or {stiff}",
            sizes.nx
        )
    };
    vec![format!(
        "A tool goes into the sheet between its contact points: from a stroke of {:.2} mm on, by up to {} mm; \
         the limit is {} mm. The {points} stand {spacing:.2} mm apart; {remedy}.",
        first.stroke_mm,
        number(deepest),
        number(limit)
    )]
}
