//! Why a solve was refused, in words.

use std::fmt;

use petsc::SnesReason;

use crate::output::number;
use crate::system::ElementFailure;

/// A Newton solve that did not converge.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// Time the step was to reach, ms.
    pub time: f64,
    /// Length of the step, ms.
    pub dt: f64,
    /// What PETSc says.
    pub reason: SnesReason,
    /// Newton iterations made.
    pub iterations: u32,
    /// Residual norms, mm.
    pub norms: Vec<f64>,
    /// The element that could not be evaluated on this rank, if any.
    pub element: Option<ElementFailure>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "step to {:.4} ms (dt {} ms): {} after {} iteration{}",
            self.time,
            number(self.dt),
            self.reason.sentence(),
            self.iterations,
            if self.iterations == 1 { "" } else { "s" },
        )?;
        if let (Some(first), Some(last)) = (self.norms.first(), self.norms.last()) {
            write!(f, ", residual from {first:.1e} to {last:.1e} mm")?;
        }
        match &self.element {
            Some(element) => write!(f, "; {element}"),
            None => Ok(()),
        }
    }
}
