//! What the user can try next, by what kept the solves from converging: a table of conditions and advice. How often each
//! remedy helped is in docs/it-does-not-converge.md.

use super::cause::Cause;
use super::refusal::Refusal;
use crate::case::{Case, Dynamics};
use crate::contact::ContactLocation;
use crate::run::setup::defaults;
use crate::text::{rounded, show_real};

/// Iterations that most steps can do with.
const USUAL_ITERATIONS: usize = 15;
/// A compliance below this share of the reference case's is unusually stiff.
const STIFF: f64 = 0.2;
/// Coefficients of friction above this are not those of metal on metal.
const ROUGH: f64 = 0.5;
/// Elements longer than this many times their height are long.
const LONG: f64 = 3.0;
/// Most remedies that are shown.
const MOST: usize = 3;

/// A run that stopped.
pub(super) struct Stopped<'a> {
    pub case: &'a Case,
    /// The case whose values are the usual ones.
    pub reference: &'a Case,
    pub cause: Cause,
    /// The refused solves of the last step, longest first.
    pub refusals: &'a [Refusal],
}

/// When a remedy is worth a try, and what it is.
type Remedy = (fn(&Stopped) -> bool, fn(&Stopped) -> String);

/// All remedies, the most promising first. Values far from the usual ones come before all others: most likely they were
/// changed on purpose, or by mistake.
const REMEDIES: &[Remedy] = &[
    (
        |run| run.few_iterations(),
        |run| {
            let usual = run.reference.stepping.newton_max_iterations;
            format!(
                "{}: a step usually needs 5 to {USUAL_ITERATIONS}",
                run.iterations(usual)
            )
        },
    ),
    (
        |run| run.contact_matters() && run.stiff_surface(),
        |run| {
            let usual = run.reference.discretisation.contact_compliance;
            format!(
                "{}: the surface is much stiffer than usual, and stiff points chatter",
                run.contact_compliance(usual)
            )
        },
    ),
    (
        |run| run.stiff_friction(),
        |run| {
            let usual = run.reference.friction.compliance;
            format!(
                "{}: friction is much stiffer than usual",
                run.friction_compliance(usual)
            )
        },
    ),
    (
        |run| run.least_step_in_the_way(),
        |run| {
            let tried = match run.refusals.len() {
                1 => "only one step length was tried".to_owned(),
                count => format!("{count} step lengths were tried"),
            };
            let stepping = |case: &Case| case.stepping.dt_min;
            let advice = real("dt_min", stepping(run.reference), stepping(run.case));
            format!("{advice}: {tried}")
        },
    ),
    (
        |run| run.case.loading.dynamics == Dynamics::None && run.cause != Cause::Iterations,
        |_| {
            "-dynamics slow: the inertia of the sheet carries it over where it snaps or is not held in place"
                .to_owned()
        },
    ),
    (
        |run| run.cause == Cause::Iterations && !run.few_iterations(),
        |run| run.more_iterations(),
    ),
    (
        |run| run.cause == Cause::StickSlip && run.case.friction.coefficient > ROUGH,
        |run| {
            let coefficient = shown(run.case.friction.coefficient);
            format!("check -friction_coefficient {coefficient}: metal on metal has 0.05 to 0.3")
        },
    ),
    (
        |run| run.cause == Cause::StickSlip && !run.stiff_friction(),
        |run| {
            let softer = 10.0 * run.case.friction.compliance;
            format!(
                "{}: softer sticking chatters less",
                run.friction_compliance(softer)
            )
        },
    ),
    (
        |run| run.cause == Cause::OpenClose && !run.at_points(),
        |_| "-contact_location points: nodes and moving points chatter more often".to_owned(),
    ),
    (
        |run| run.cause == Cause::OpenClose && run.at_points() && run.few_points(),
        |run| {
            let points = |case: &Case| case.discretisation.contact_points_per_edge;
            whole(
                "contact_points_per_edge",
                points(run.reference),
                points(run.case),
            )
        },
    ),
    (
        |run| run.cause != Cause::Iterations,
        |run| {
            let nx = run.case.discretisation.nx;
            let why = if run.long_elements() {
                "the elements are long for their height"
            } else {
                "a finer mesh follows the tools in smaller pieces"
            };
            format!("{}: {why}", whole("sheet_nx", 2 * nx, nx))
        },
    ),
    (
        |run| run.contact_matters(),
        |run| {
            let softer = 4.0 * run.case.discretisation.contact_compliance;
            format!(
                "{}: a softer surface; the certificate shows how deep the tools penetrate",
                run.contact_compliance(softer)
            )
        },
    ),
    (
        |run| run.cause != Cause::Iterations && !run.few_iterations(),
        |run| run.more_iterations(),
    ),
];

/// The remedies for a run that stopped, a few at most.
pub(super) fn remedies(run: &Stopped) -> Vec<String> {
    REMEDIES
        .iter()
        .filter(|(helps, _)| helps(run))
        .map(|(_, advice)| advice(run))
        .take(MOST)
        .collect()
}

impl Stopped<'_> {
    fn few_iterations(&self) -> bool {
        self.case.stepping.newton_max_iterations < USUAL_ITERATIONS
    }

    fn contact_matters(&self) -> bool {
        matches!(
            self.cause,
            Cause::OpenClose | Cause::StickSlip | Cause::Residual | Cause::Matrix
        )
    }

    fn stiff_surface(&self) -> bool {
        let compliance = |case: &Case| case.discretisation.contact_compliance;
        compliance(self.case) < STIFF * compliance(self.reference)
    }

    fn stiff_friction(&self) -> bool {
        let friction = &self.case.friction;
        friction.coefficient > 0.0
            && friction.compliance < STIFF * self.reference.friction.compliance
    }

    fn least_step_in_the_way(&self) -> bool {
        let least = self.case.stepping.dt_min;
        let shortest = self.refusals.last().map_or(0.0, |last| last.dt);
        least > self.reference.stepping.dt_min && shortest * defaults::CUT_BACK < least
    }

    fn at_points(&self) -> bool {
        self.case.discretisation.contact_location == ContactLocation::Points
    }

    fn few_points(&self) -> bool {
        let points = |case: &Case| case.discretisation.contact_points_per_edge;
        points(self.case) < points(self.reference)
    }

    fn long_elements(&self) -> bool {
        let height = self.case.sheet.thickness / self.case.discretisation.ny as f64;
        self.case.element_length() > LONG * height
    }

    fn iterations(&self, to: usize) -> String {
        let now = self.case.stepping.newton_max_iterations;
        whole("newton_max_iterations", to, now)
    }

    fn more_iterations(&self) -> String {
        self.iterations(2 * self.case.stepping.newton_max_iterations)
    }

    fn contact_compliance(&self, to: f64) -> String {
        let now = self.case.discretisation.contact_compliance;
        real("contact_compliance", to, now)
    }

    fn friction_compliance(&self, to: f64) -> String {
        real("friction_compliance", to, self.case.friction.compliance)
    }
}

/// Advice to change an option that is a real number.
fn real(option: &str, to: f64, now: f64) -> String {
    format!("-{option} {} (now {})", shown(to), shown(now))
}

/// Advice to change an option that is a whole number.
fn whole(option: &str, to: usize, now: usize) -> String {
    format!("-{option} {to} (now {now})")
}

/// A value as a person would write it on the command line.
fn shown(value: f64) -> String {
    show_real(rounded(value, 6))
}
