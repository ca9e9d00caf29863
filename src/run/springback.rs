//! The angle the sheet springs back to when the tools simply vanish.

use std::rc::Rc;

use petsc::VectorRef;

use super::{RunError, StaticPath};
use crate::system::System;

/// Steps in which the tools' forces go to zero.
const STEPS: usize = 8;

/// Angle and fit of a sheet without tools.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Springback {
    /// Time at which the tools vanished, ms.
    pub t_ms: f64,
    /// Opening angle between the arms before, degrees.
    pub loaded_angle_deg: f64,
    /// Opening angle between the arms after, degrees.
    pub released_angle_deg: f64,
    /// Root mean square distance of the released arm from its straight fit, mm.
    pub fit_residual_mm: f64,
    /// Growth of the largest equivalent plastic strain on the way: zero if it was elastic.
    pub plastic_growth: f64,
}

/// Takes the tools away from the accepted unknowns `u` at time `t` (ms) and lets their forces go to
/// zero in a few static steps. `None` if a step does not converge. `system` is left as it was.
/// Collective.
///
/// # Errors
/// If PETSc fails.
pub fn springback(system: &System, t: f64, u: &VectorRef) -> Result<Option<Springback>, RunError> {
    let loaded = system.measures(t, u, None)?;
    let (released, unknowns) = system.released(u, 0.0, 1.0)?;
    let released = Rc::new(released);
    let mut path = StaticPath::new(Rc::clone(&released), unknowns)?;
    for step in 1..=STEPS {
        if !path.advance(step as f64 / STEPS as f64)?.is_converged() {
            return Ok(None);
        }
    }
    let free = released.measures(1.0, path.unknowns(), None)?;
    Ok(Some(Springback {
        t_ms: t,
        loaded_angle_deg: loaded.angle,
        released_angle_deg: free.angle,
        fit_residual_mm: free.angle_fit_residual,
        plastic_growth: free.max_plastic_strain - loaded.max_plastic_strain,
    }))
}
