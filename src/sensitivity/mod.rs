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

/// The share of its value by which a parameter differs on each side: rounding divided by it is small against a
/// derivative that moves the sheet by millimetres, and few points yield on one side only.
const SHARE: f64 = 1e-6;
/// Of parameters that move the sheet by micrometres, and in which the equations of contact are linear.
const LINEAR: [(&str, f64); 2] = [("contact_compliance", 1e-4), ("friction_coefficient", 1e-4)];

/// A parameter and the problems beside the one of the case.
pub struct Beside {
    /// The parameter.
    pub parameter: Parameter,
    /// Half the distance between them, in its unit.
    pub half_width: f64,
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
            let linear = LINEAR.iter().find(|(name, _)| *name == parameter.name);
            let share = linear.map_or(SHARE, |(_, share)| *share);
            Ok(Self {
                problems: [
                    Problem::new(&case.beside(&parameter, share)?),
                    Problem::new(&case.beside(&parameter, -share)?),
                ],
                half_width: share * parameter.value,
                parameter,
            })
        };
        case.parameters()?.into_iter().map(beside).collect()
    }
}
