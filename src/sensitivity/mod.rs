//! In: accepted steps, the cases beside this one, and the linear solve of the run. Out: the derivatives of the discrete
//! solution by parameters, step by step, and of what is measured on it.
//! Never: a nonlinear solve, files, or a choice of the run.
//!
//! A step solves R(x; u_n, v_n, a_n, history_n, p) = 0, so with K = dR/dx, which the run factorises anyway,
//!
//! ```text
//! K dx/dp = - ∂R/∂p - ∂R/∂history_n dhistory_n/dp - ∂R/∂(u, v, a)_n d(u, v, a)_n/dp
//! ```
//!
//! on the reduced set: gaps that are closed stay closed (direct differentiation: Kleiber, Antúnez, Hien and Kowalczyk
//! 1997, Parameter Sensitivity in Nonlinear Mechanics). The right-hand side and the new history's derivative come from
//! [`crate::system::Variation`], everything else is linear. docs/sensitivity.md has the whole.

mod kept;
mod released;
mod solve;
mod step;
mod tracked;

pub use kept::{Kept, KeptParameter};
pub use released::{ReleasedSlopes, ReleasedState};
pub use step::{AcceptedStep, Inertia, Sensitivity, StepSlopes};

use crate::case::{Case, CaseError, Parameter};
use crate::system::Problem;

/// Derivatives of an accepted state by one parameter, per unit of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slopes {
    /// Of the force on the punch, N.
    pub force: f64,
    /// Of the opening angle, degrees.
    pub angle: f64,
    /// Of the vertical displacement of the sheet's point A, mm.
    pub dy_a: f64,
}

/// What the derivatives cost so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Factorisations, one a step.
    pub factorisations: u64,
    /// Linear solves, one a step and parameter.
    pub solves: u64,
    /// Processor time of this rank for what all parameters share, s.
    pub shared_seconds: f64,
    /// Processor time of this rank for all parameters, s.
    pub parameter_seconds: f64,
}

/// The share of its value by which a parameter differs on each side. Only the numbers of the problem are differenced, most
/// of which are linear in it.
const SHARE: f64 = 1e-5;

/// A parameter and the problems beside the one of the case.
pub struct Beside {
    /// The parameter.
    pub parameter: Parameter,
    /// How far they are apart, in its unit.
    pub width: f64,
    /// With a little more and a little less of it.
    pub problems: [Problem; 2],
}

impl Beside {
    /// Of every parameter the case is to be differentiated by.
    ///
    /// # Errors
    /// [`CaseError::NoDerivative`].
    pub fn of(case: &Case) -> Result<Vec<Self>, CaseError> {
        let beside = |parameter: Parameter| {
            Ok(Self {
                problems: [
                    Problem::new(&case.beside(&parameter, SHARE)?),
                    Problem::new(&case.beside(&parameter, -SHARE)?),
                ],
                width: 2.0 * SHARE * parameter.value,
                parameter,
            })
        };
        case.parameters()?.into_iter().map(beside).collect()
    }
}
