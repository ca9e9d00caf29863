//! One nonlinear solve of a step.

use crate::run::diagnosis::SolveWatch;
use crate::run::newton::{Damping, TangentInertia, limited_length};
use crate::system::ElementFailure;

/// From a residual above so many times the tolerance the next iteration rarely converges: of 896 residuals of the benchmark
/// this is wrong about 61.
const FAR_FROM_CONVERGED: f64 = 1e3;

/// An attempt at a step: it begins before the solve and is over when the step is accepted or refused.
#[derive(Default)]
pub(in crate::run) struct Attempt {
    /// Length of the step, ms.
    pub dt: f64,
    /// Time it is to reach, ms.
    pub time: f64,
    /// Largest displacement expected of it, mm.
    expected: f64,
    damping: Damping,
    inertia: TangentInertia,
    pub watch: SolveWatch,
    /// The element of this rank that could not be evaluated.
    pub failure: Option<ElementFailure>,
}

impl Attempt {
    /// At a step to `time` of length `dt` (ms), which is expected to move the sheet by `expected` (mm).
    pub fn new(time: f64, dt: f64, expected: f64) -> Self {
        Self {
            dt,
            time,
            expected,
            ..Self::default()
        }
    }

    /// Whether the residual evaluated next will probably be followed by a tangent at the same place, as it does not meet the
    /// tolerance (mm). What depends on the answer is where time is spent, not what is found.
    pub fn goes_on(&self, tolerance: f64) -> bool {
        let last = self.watch.norms().last();
        last.is_none_or(|norm| *norm > FAR_FROM_CONVERGED * tolerance)
    }

    /// Inertia of the next tangent as a multiple of its own.
    pub fn inertia(&self) -> f64 {
        self.inertia.multiple()
    }

    /// Length of a Newton step from an iterate with residual norm `norm`, whose largest displacement is `correction`
    /// (mm): damped where the solve stagnates, and limited where it would carry the sheet much farther than the step in
    /// time does.
    pub fn step_length(&mut self, iteration: usize, norm: f64, correction: f64) -> f64 {
        let damped = self.damping.step_length(iteration, norm);
        let limited = limited_length(iteration, correction, self.expected);
        self.inertia.follow(limited);
        damped.min(limited)
    }
}
