//! When a nonlinear solver stops.

use petsc_sys as sys;

use super::SnesRef;
use crate::error::{Result, check};

/// When a nonlinear solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The residual norm that is small enough.
    pub absolute: f64,
    /// The part of the first residual norm that is small enough.
    pub relative: f64,
    /// The part of the solution's norm below which a step is small enough.
    pub step: f64,
    /// The largest number of iterations.
    pub max_iterations: i32,
    /// The largest number of residual evaluations; negative for no limit.
    pub max_evaluations: i32,
}

impl SnesRef {
    /// When the solver stops.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn tolerances(&self) -> Result<Tolerances> {
        let (mut absolute, mut relative, mut step) = (0.0, 0.0, 0.0);
        let (mut max_iterations, mut max_evaluations) = (0, 0);
        // SAFETY: a live solver and one value behind each pointer.
        check(unsafe {
            sys::SNESGetTolerances(
                self.raw(),
                &mut absolute,
                &mut relative,
                &mut step,
                &mut max_iterations,
                &mut max_evaluations,
            )
        })?;
        Ok(Tolerances {
            absolute,
            relative,
            step,
            max_iterations,
            max_evaluations,
        })
    }

    /// Sets when the solver stops.
    ///
    /// # Errors
    /// If a value is impossible.
    pub fn set_tolerances(&mut self, to: Tolerances) -> Result<()> {
        let Tolerances {
            absolute,
            relative,
            step,
            max_iterations,
            max_evaluations,
        } = to;
        // SAFETY: a live solver.
        check(unsafe {
            sys::SNESSetTolerances(
                self.raw(),
                absolute,
                relative,
                step,
                max_iterations,
                max_evaluations,
            )
        })
    }
}
