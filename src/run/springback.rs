//! The angle the sheet springs back to when the tools simply vanish.

use std::rc::Rc;

use petsc::VectorRef;

use super::{RunError, StaticPath};
use crate::system::System;

/// First step of the tools' forces towards zero, as a share of them.
const FIRST_STEP: f64 = 0.125;
/// The shortest step that is tried.
const LEAST_STEP: f64 = 1e-4;
/// Growth of the step after an accepted one, and shrinkage after a refused one.
const GROWTH: f64 = 1.5;
const CUT_BACK: f64 = 0.25;

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
/// zero in static steps. `None` if they do not converge. `system` is left as it was.
/// Collective.
///
/// # Errors
/// If PETSc fails.
pub fn springback(system: &System, t: f64, u: &VectorRef) -> Result<Option<Springback>, RunError> {
    let loaded = system.measures(t, u, None)?;
    let (released, unknowns) = system.released(u, 0.0, 1.0)?;
    let released = Rc::new(released);
    let mut path = StaticPath::new(Rc::clone(&released), unknowns)?;
    let (mut faded, mut step) = (0.0, FIRST_STEP);
    while faded < 1.0 {
        let next = f64::min(faded + step, 1.0);
        if path.advance(next)?.is_converged() {
            faded = next;
            step *= GROWTH;
        } else {
            step *= CUT_BACK;
            if step < LEAST_STEP {
                return Ok(None);
            }
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
