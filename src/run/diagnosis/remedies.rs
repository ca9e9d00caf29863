//! What the user can try next, by what kept the last solves from converging. How often each remedy helped is in
//! docs/it-does-not-converge.md.

use super::{Cause, Refusal};
use crate::case::{Case, Dynamics};
use crate::contact::ContactLocation;
use crate::output::number;
use crate::run::setup::defaults;

/// A contact surface that gives less than this per pressure (mm/MPa) is stiffer than the default.
const USUAL_COMPLIANCE: f64 = 5e-5;
/// The same for the elastic slip of friction.
const USUAL_SLIP: f64 = 5e-4;
/// A least step above this (ms) may be what stops a run.
const SMALL_STEP: f64 = 1e-6;
/// Most remedies that are shown.
const MOST: usize = 3;

/// The remedies for `cause`, a few at most.
pub(super) fn remedies(case: &Case, cause: Cause, refusals: &[Refusal]) -> Vec<String> {
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
