//! Names for stretches of work, so that they show up in `-log_view`.
//!
//! In: a name. Out: a guard; the work between its making and its drop is counted. Never: output.

use std::marker::PhantomData;

use petsc_sys as sys;

use crate::{
    error::{Result, check},
    session::{c_string, keep},
};

/// A kind of work, for example the assembly of the residual.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    id: sys::PetscLogEvent,
    _this_thread: PhantomData<*mut u8>,
}

impl Event {
    /// Makes an event known to PETSc.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new(name: &str) -> Result<Self> {
        let _keep = keep()?;
        let name = c_string(name)?;
        let mut id = 0;
        // SAFETY: a C string, which PETSc copies; class 0 means no class; one integer to write.
        check(unsafe { sys::PetscLogEventRegister(name.as_ptr(), 0, &mut id) })?;
        Ok(Event {
            id,
            _this_thread: PhantomData,
        })
    }

    /// Counts the work until the guard is dropped. Does nothing without a `-log_…` option.
    pub fn begin(&self) -> EventGuard {
        // SAFETY: a registered event. Errors of logging are of no consequence.
        unsafe { sys::petsc_rs_event_begin(self.id) };
        EventGuard { event: *self }
    }
}

/// Ends an [`Event`] when dropped.
#[must_use]
pub struct EventGuard {
    event: Event,
}

impl Drop for EventGuard {
    fn drop(&mut self) {
        // SAFETY: as in `begin`.
        unsafe { sys::petsc_rs_event_end(self.event.id) };
    }
}

/// A section of the whole run, for example the set-up.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    id: sys::PetscLogStage,
    _this_thread: PhantomData<*mut u8>,
}

impl Stage {
    /// Makes a stage known to PETSc.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new(name: &str) -> Result<Self> {
        let _keep = keep()?;
        let name = c_string(name)?;
        let mut id = 0;
        // SAFETY: a C string, which PETSc copies, and one integer to write.
        check(unsafe { sys::PetscLogStageRegister(name.as_ptr(), &mut id) })?;
        Ok(Stage {
            id,
            _this_thread: PhantomData,
        })
    }

    /// Counts everything under this stage until the guard is dropped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn push(&self) -> Result<StageGuard> {
        let _keep = keep()?;
        // SAFETY: a registered stage.
        check(unsafe { sys::PetscLogStagePush(self.id) })?;
        Ok(StageGuard {
            _this_thread: PhantomData,
        })
    }
}

/// Ends a [`Stage`] when dropped.
#[must_use]
pub struct StageGuard {
    _this_thread: PhantomData<*mut u8>,
}

impl Drop for StageGuard {
    fn drop(&mut self) {
        if keep().is_ok() {
            // SAFETY: ends the stage begun by `push`.
            unsafe { sys::PetscLogStagePop() };
        }
    }
}
