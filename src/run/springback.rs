//! The angle the sheet springs back to when the tools simply vanish.

use std::rc::Rc;

use petsc::VectorRef;

use super::{RunError, StaticPath};
use crate::sensitivity::{ReleasedState, Sensitivity};
use crate::system::{History, Measures, Released, System};

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
    /// Growth of the largest equivalent plastic strain meanwhile: zero if it was elastic.
    pub plastic_growth: f64,
}

/// A sheet whose tools have just vanished: their forces are still there.
pub(super) struct ReleasedSheet {
    t: f64,
    loaded: Measures,
    system: Rc<System>,
    /// Its material's history before.
    history: History,
    path: StaticPath,
}

impl ReleasedSheet {
    /// The sheet of `system` with its history at the accepted unknowns `u` at time `t` (ms). Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated.
    pub fn new(
        system: &System,
        history: &History,
        t: f64,
        u: &VectorRef,
    ) -> Result<Self, RunError> {
        let loaded = system.measures(history, t, u, None)?;
        let released = Released::new(system, history, u, 0.0, 1.0)?;
        let system = Rc::new(released.system);
        let history = released.history;
        let path = StaticPath::new(Rc::clone(&system), history.clone(), released.unknowns)?;
        Ok(Self {
            t,
            loaded,
            system,
            history,
            path,
        })
    }

    /// Lets the forces go to zero in static steps. `None` if they do not converge. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn spring_back(&mut self) -> Result<Option<Springback>, RunError> {
        let (mut faded, mut step) = (0.0, FIRST_STEP);
        while faded < 1.0 {
            let next = f64::min(faded + step, 1.0);
            if self.path.advance(next)?.is_converged() {
                faded = next;
                step *= GROWTH;
            } else {
                step *= CUT_BACK;
                if step < LEAST_STEP {
                    return Ok(None);
                }
            }
        }
        let (history, unknowns) = (self.path.history(), self.path.unknowns());
        let free = self.system.measures(&history, 1.0, unknowns, None)?;
        Ok(Some(Springback {
            t_ms: self.t,
            loaded_angle_deg: self.loaded.angle,
            released_angle_deg: free.angle,
            fit_residual_mm: free.angle_fit_residual,
            plastic_growth: free.max_plastic_strain - self.loaded.max_plastic_strain,
        }))
    }

    /// Adds the derivatives of the angle it has sprung back to. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated.
    pub fn differentiate(&self, sensitivity: &mut Sensitivity) -> Result<(), RunError> {
        let Some(solve) = self.path.solve() else {
            return Ok(());
        };
        let history = self.path.history();
        Ok(sensitivity.release(&ReleasedState {
            system: &self.system,
            solve,
            history: &history,
            unknowns: self.path.unknowns(),
            t_ms: self.t,
            elastic: *history == self.history,
        })?)
    }
}
