//! A static solution from time to time, without files and without step control.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use petsc::{Snes, SnesReason, Vector, VectorRef};

use super::RunError;
use super::newton::Damping;
use super::setup::LinearSolve;
use crate::system::System;

/// Solves a system statically at the times it is given and commits what converged.
pub struct StaticPath {
    system: Rc<System>,
    snes: Snes,
    unknowns: Vector,
    time: Rc<Cell<f64>>,
}

impl StaticPath {
    /// Starts from `unknowns`, which belong to the system's history. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn new(system: Rc<System>, unknowns: Vector) -> Result<Self, RunError> {
        let time = Rc::new(Cell::new(0.0));
        let mut snes = Snes::new(system.comm())?;
        let (this, now) = (Rc::clone(&system), Rc::clone(&time));
        snes.set_function(&unknowns, move |u, out| {
            this.residual(now.get(), u, None, out)
        })?;
        let linear = LinearSolve::chosen(&system)?;
        let (this, now) = (Rc::clone(&system), Rc::clone(&time));
        snes.set_jacobian(linear.matrix(&system)?, move |u, out| {
            let evaluated = this.jacobian(now.get(), u, 0.0, out);
            evaluated.map_err(super::simulation::not_evaluated)
        })?;
        let damping = RefCell::new(Damping::default());
        snes.set_shell_line_search(move |info| {
            let iteration = info.iteration.unsigned_abs() as usize;
            Ok(damping
                .borrow_mut()
                .step_length(iteration, info.residual_norm))
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
            time,
        })
    }

    /// Solves at time `t` (ms) and commits the state if the solve converged. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn advance(&mut self, t: f64) -> Result<SnesReason, RunError> {
        self.time.set(t);
        let before = self.unknowns.to_owned()?;
        let reason = self.snes.solve(&mut self.unknowns)?;
        if reason.is_converged() {
            self.system.commit(t, &self.unknowns)?;
        } else {
            self.unknowns.copy_from(&before)?;
        }
        Ok(reason)
    }

    /// The last accepted unknowns.
    pub fn unknowns(&self) -> &VectorRef {
        &self.unknowns
    }

    /// Newton iterations of the last solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn newton_iterations(&self) -> Result<u32, RunError> {
        Ok(self.snes.iteration_number()?.unsigned_abs())
    }
}
