//! A static solution from time to time, without files and without step control.

use std::cell::{Ref, RefCell};
use std::rc::Rc;

use petsc::{Snes, SnesReason, Vector, VectorRef};

use super::RunError;
use super::newton::Damping;
use super::setup::LinearSolve;
use crate::system::{CondensedSolve, History, System};

/// Solves a system statically at one time after the other, and accepts what converged.
pub struct StaticPath {
    system: Rc<System>,
    snes: Snes,
    unknowns: Vector,
    linear: Rc<LinearSolve>,
    progress: Rc<RefCell<Progress>>,
}

/// What the closures of the solver read and move on.
struct Progress {
    /// That of the last accepted state.
    history: History,
    /// Time to be reached, ms.
    time: f64,
    damping: Damping,
}

impl StaticPath {
    /// Starts from `unknowns`, whose history this is. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn new(system: Rc<System>, history: History, unknowns: Vector) -> Result<Self, RunError> {
        let progress = Rc::new(RefCell::new(Progress {
            history,
            time: 0.0,
            damping: Damping::default(),
        }));
        let mut snes = Snes::new(system.comm())?;
        let (this, now) = (Rc::clone(&system), Rc::clone(&progress));
        snes.set_function(&unknowns, move |u, out| {
            let Progress { history, time, .. } = &*now.borrow();
            Ok(this.residual(history, *time, u, None, out)?)
        })?;
        let linear = LinearSolve::chosen(&system)?;
        let (this, now) = (Rc::clone(&linear), Rc::clone(&progress));
        snes.set_jacobian(linear.matrix()?, move |u, out| {
            let Progress { history, time, .. } = &*now.borrow();
            this.evaluate(history, *time, u, 0.0, out)
        })?;
        let now = Rc::clone(&progress);
        snes.set_shell_line_search(move |info| {
            let iteration = info.iteration.unsigned_abs() as usize;
            let damping = &mut now.borrow_mut().damping;
            Ok(damping.step_length(iteration, info.residual_norm))
        })?;
        snes.set_type("vinewtonrsls")?;
        linear.install(&mut snes)?;
        snes.set_from_options()?;
        let (lower, upper) = system.bounds()?;
        snes.set_variable_bounds(&lower, &upper)?;
        Ok(Self {
            system,
            snes,
            unknowns,
            linear,
            progress,
        })
    }

    /// Solves at time `t` (ms) and accepts the state if the solve converged. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn advance(&mut self, t: f64) -> Result<SnesReason, RunError> {
        self.progress.borrow_mut().time = t;
        let before = self.unknowns.to_owned()?;
        let reason = self.snes.solve(&mut self.unknowns)?;
        if reason.is_converged() {
            let next = self.system.advance(&self.history(), t, &self.unknowns)?;
            self.progress.borrow_mut().history = next;
        } else {
            self.unknowns.copy_from(&before)?;
        }
        Ok(reason)
    }

    /// Our own solve with its tangents; none if they are left to PETSc.
    pub(super) fn solve(&self) -> Option<&CondensedSolve> {
        self.linear.condensed().map(Rc::as_ref)
    }

    /// The last accepted unknowns.
    pub fn unknowns(&self) -> &VectorRef {
        &self.unknowns
    }

    /// Their history.
    pub fn history(&self) -> Ref<'_, History> {
        Ref::map(self.progress.borrow(), |progress| &progress.history)
    }
}
