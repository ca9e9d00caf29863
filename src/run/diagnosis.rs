//! Why a run stopped, and what the user can do: chosen by what was seen of the last solves. The remedies and how often
//! each of them helped are in docs/it-does-not-converge.md.

use petsc::SnesReason;

use super::refusal::Refusal;
use super::solve_watch::{Course, Flip};
use super::{Failure, defaults};
use crate::case::{Case, Dynamics};
use crate::contact::ContactLocation;
use crate::output::{Diagnosis, StepRecord, number};

/// A contact surface that gives less than this per pressure (mm/MPa) is stiffer than the default.
const USUAL_COMPLIANCE: f64 = 5e-5;
/// The same for the elastic slip of friction.
const USUAL_SLIP: f64 = 5e-4;
/// A least step above this (ms) may be what stops a run.
const SMALL_STEP: f64 = 1e-6;
/// Most remedies that are shown.
const MOST: usize = 3;

/// What kept the last solves from converging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// The matrix could not be factorised.
    Matrix,
    /// An element turned over.
    Element,
    /// There were not enough iterations.
    Iterations,
    /// Contact points open and close.
    Closing,
    /// Contact points stick and slip.
    Slipping,
    /// The residual does not fall, and no contact point is to blame.
    Residual,
}

impl Cause {
    fn of(refusal: &Refusal) -> Self {
        let flips = |kind: Flip| refusal.flips.iter().any(|(_, flip)| *flip == kind);
        if refusal.element.is_some() {
            Self::Element
        } else if refusal.reason == SnesReason::DivergedLinearSolve {
            Self::Matrix
        } else if matches!(
            refusal.course,
            Course::Short | Course::Falls(_) | Course::Small
        ) {
            Self::Iterations
        } else if flips(Flip::Closing) {
            Self::Closing
        } else if flips(Flip::Slipping) {
            Self::Slipping
        } else {
            Self::Residual
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Matrix => "Its matrix cannot be factorised: something is not held.",
            Self::Element => "An element turned over on the way.",
            Self::Iterations => "It was on its way, but its iterations were used up.",
            Self::Closing => {
                "Contact points open and close from iteration to iteration, and the residual does not fall."
            }
            Self::Slipping => {
                "Contact points stick and slip from iteration to iteration, and the residual does not fall."
            }
            Self::Residual => {
                "The residual does not fall, and contact does not change: the material or the mesh keeps it up."
            }
        }
    }
}

/// What is known about the end of a run that did not finish.
pub(super) fn diagnose(case: &Case, failure: &Failure, steps: u64) -> Diagnosis {
    let (cause, typical) = typical(&failure.refusals).unzip();
    let words = cause.map_or("", Cause::words);
    Diagnosis {
        place: format!(
            "after step {steps}, t = {:.4} ms, punch down by {:.4} mm",
            failure.time, failure.depth
        ),
        cause: format!("{}. {words}", failure.reason).trim_end().to_owned(),
        observed: typical.map_or_else(Vec::new, |refusal| observed(case, refusal)),
        tried: tried(&failure.refusals),
        remedies: cause.map_or_else(Vec::new, |cause| remedies(case, cause, &failure.refusals)),
    }
}

/// The most frequent cause, and the last refusal it is behind; of equally frequent ones the later. The shortest step alone
/// may be a chance.
fn typical(refusals: &[Refusal]) -> Option<(Cause, &Refusal)> {
    let count = |cause: Cause| {
        refusals
            .iter()
            .filter(|refusal| Cause::of(refusal) == cause)
            .count()
    };
    refusals
        .iter()
        .map(|refusal| (Cause::of(refusal), refusal))
        .max_by_key(|(cause, _)| count(*cause))
}

fn observed(case: &Case, refusal: &Refusal) -> Vec<String> {
    let mut seen = refusal.seen();
    if let (Some(element), Some(first)) = (&refusal.element, seen.first_mut()) {
        let nx = case.discretisation.nx;
        let along = (0.5 + (element.element % nx) as f64) * case.sheet.half_length() / nx as f64;
        first.push_str(&format!(
            "; it lies {along:.2} mm along the sheet from its middle, in layer {} of {} from below",
            element.element / nx + 1,
            case.discretisation.ny
        ));
    }
    seen
}

/// The refused solves, the first and the last ones if there are many.
fn tried(refusals: &[Refusal]) -> Vec<String> {
    const FIRST: usize = 1;
    const LAST: usize = 3;
    let hidden = refusals.len().saturating_sub(FIRST + LAST);
    if hidden < 2 {
        return refusals.iter().map(Refusal::to_string).collect();
    }
    let mut lines: Vec<_> = refusals[..FIRST].iter().map(Refusal::to_string).collect();
    lines.push(format!("... {hidden} more ..."));
    lines.extend(refusals[FIRST + hidden..].iter().map(Refusal::to_string));
    lines
}

fn remedies(case: &Case, cause: Cause, refusals: &[Refusal]) -> Vec<String> {
    let mut remedies = Vec::new();
    let mut add = |text: String| remedies.push(text);
    let (sizes, stepping) = (&case.discretisation, &case.stepping);
    let was = |value: f64| format!("now {}", option(value));
    // What stands far from its usual value comes first: it was most likely changed on purpose, or by a slip.
    if stepping.newton_max_iterations < 15 {
        add(format!(
            "-newton_max_iterations 20 (now {}): a step usually needs 5 to 15",
            stepping.newton_max_iterations
        ));
    }
    let contact_matters = matches!(
        cause,
        Cause::Closing | Cause::Slipping | Cause::Residual | Cause::Matrix
    );
    if contact_matters && sizes.contact_compliance < 0.2 * USUAL_COMPLIANCE {
        add(format!(
            "-contact_compliance {} ({}): the surface is much stiffer than usual, and stiff points flip",
            option(USUAL_COMPLIANCE),
            was(sizes.contact_compliance)
        ));
    }
    let friction = &case.friction;
    if friction.coefficient > 0.0 && friction.compliance < 0.2 * USUAL_SLIP {
        add(format!(
            "-friction_compliance {} ({}): friction is much stiffer than usual",
            option(USUAL_SLIP),
            was(friction.compliance)
        ));
    }
    let shortest = refusals.last().map_or(0.0, |last| last.dt);
    if stepping.dt_min > SMALL_STEP && shortest * defaults::CUT_BACK < stepping.dt_min {
        add(format!(
            "-dt_min {} ({}): {}",
            option(SMALL_STEP),
            was(stepping.dt_min),
            match refusals.len() {
                1 => "only one step length was tried".to_owned(),
                count => format!("{count} step lengths were tried"),
            }
        ));
    }
    if case.loading.dynamics == Dynamics::None && cause != Cause::Iterations {
        add("-dynamics slow: the inertia of the sheet carries it over where it snaps or is not held".to_owned());
    }
    if cause == Cause::Iterations && stepping.newton_max_iterations >= 15 {
        add(format!(
            "-newton_max_iterations {} (now {})",
            2 * stepping.newton_max_iterations,
            stepping.newton_max_iterations
        ));
    }
    if cause == Cause::Slipping && friction.coefficient > 0.5 {
        add(format!(
            "look at -friction_coefficient {}: metal on metal has 0.05 to 0.3",
            option(friction.coefficient)
        ));
    }
    if cause == Cause::Slipping && friction.compliance >= 0.2 * USUAL_SLIP {
        add(format!(
            "-friction_compliance {} ({}): sticking that gives more flips less",
            option(10.0 * friction.compliance),
            was(friction.compliance)
        ));
    }
    if cause == Cause::Closing && sizes.contact_location != ContactLocation::Points {
        add("-contact_location points: nodes and moving points flip more often".to_owned());
    } else if cause == Cause::Closing && sizes.contact_points_per_edge < 6 {
        add(format!(
            "-contact_points_per_edge 6 (now {})",
            sizes.contact_points_per_edge
        ));
    }
    let thickness = case.sheet.thickness / sizes.ny as f64;
    let aspect = case.sheet.half_length() / sizes.nx as f64 / thickness;
    if cause != Cause::Iterations {
        add(format!(
            "-sheet_nx {} (now {}): {}",
            2 * sizes.nx,
            sizes.nx,
            if aspect > 3.0 {
                "the elements are long for their height"
            } else {
                "a finer mesh follows the tools in smaller pieces"
            }
        ));
    }
    if contact_matters {
        add(format!(
            "-contact_compliance {} ({}): a softer surface; the certificate tells how deep the tools go in",
            option(4.0 * sizes.contact_compliance),
            was(sizes.contact_compliance)
        ));
    }
    if cause != Cause::Iterations && stepping.newton_max_iterations >= 15 {
        add(format!(
            "-newton_max_iterations {} (now {})",
            2 * stepping.newton_max_iterations,
            stepping.newton_max_iterations
        ));
    }
    remedies.truncate(MOST);
    remedies
}

/// A value as one would give it.
fn option(value: f64) -> String {
    if value.abs() < 1e-2 {
        format!("{value:e}")
    } else {
        number(value)
    }
}

/// What a run says about itself that no verdict says, whether it finished or not.
pub(super) fn notes(case: &Case, records: &[StepRecord]) -> Vec<String> {
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
        "A tool goes into the sheet between its contact points: from a stroke of {:.2} mm on, by up to {} mm; the limit is \
         {} mm. The {points} stand {spacing:.2} mm apart; {remedy}.",
        first.stroke_mm,
        number(deepest),
        number(limit)
    )]
}
