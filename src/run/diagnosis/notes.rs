//! What should be known about a run besides its verdicts.

use crate::case::Case;
use crate::contact::ContactLocation;
use crate::output::StepRecord;
use crate::text::number;

/// Measured on the benchmark's tools: a mesh of nx elements that the tools penetrate by p keeps a limit of l with this
/// many times nx √(p / l) elements, see docs/it-does-not-converge.md.
const MESH_RESERVE: f64 = 1.3;
/// The advised number of elements is rounded up to a multiple of this.
const ROUND_TO: usize = 5;
/// Beyond this many times the limit, or with points farther apart than this (mm), only a finer mesh helps.
const TOO_DEEP: f64 = 4.0;
const TOO_FAR_APART: f64 = 0.3;

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
    let spacing = case.contact_spacing();
    let points = match sizes.contact_location {
        ContactLocation::Points => "contact points",
        ContactLocation::Nodes => "contact points (nodes)",
        ContactLocation::Closest => "edges with one moving contact point each",
    };
    // Between the points of an edge the tool penetrates with the square of their distance.
    let enough = MESH_RESERVE * sizes.nx as f64 * (deepest / limit).sqrt();
    let enough = (enough.ceil() as usize).next_multiple_of(ROUND_TO);
    let stiff = "make the surface stiffer with a smaller -contact_compliance";
    let remedy = if deepest > TOO_DEEP * limit || spacing > TOO_FAR_APART {
        format!("use -sheet_nx {enough} or more (now {})", sizes.nx)
    } else {
        format!(
            "use -sheet_nx {enough} or more (now {}), or {stiff}",
            sizes.nx
        )
    };
    vec![format!(
        "A tool penetrates the sheet between its contact points: from a stroke of {:.2} mm on, by up to {} mm; \
         the limit is {} mm. The {points} are {spacing:.2} mm apart; {remedy}.",
        first.stroke_mm,
        number(deepest),
        number(limit)
    )]
}
