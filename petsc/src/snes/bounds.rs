//! Bounds on unknowns, and which of them are met.

use std::ptr;

use petsc_sys as sys;

use super::SnesRef;
use crate::{
    VectorRef,
    error::{Result, check},
};

impl SnesRef {
    /// Whether the solver is of a type that respects bounds.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn is_bounded(&self) -> Result<bool> {
        Ok(matches!(
            self.solver_type()?.as_deref(),
            Some("vinewtonrsls" | "vinewtonssls")
        ))
    }

    /// Sets `lower <= x <= upper` (copies are kept); `-`[`INFINITY`](crate::INFINITY) and
    /// [`INFINITY`](crate::INFINITY) mean no bound. Collective.
    ///
    /// May be called again before any solve, after the residual function is set.
    ///
    /// # Errors
    /// If the layouts differ from the residual's.
    pub fn set_variable_bounds(&mut self, lower: &VectorRef, upper: &VectorRef) -> Result<()> {
        let table = self.table()?;
        table.bounds_size.set(None); // new bounds may fit a new residual
        self.check_layout(lower)?;
        self.check_layout(upper)?;
        // PETSc keeps the vectors it is given. Copies keep its bounds out of everybody's reach.
        let (lower, upper) = (lower.to_owned()?, upper.to_owned()?);
        // SAFETY: live objects; PETSc counts its references to the vectors.
        check(unsafe { sys::SNESVISetVariableBounds(self.raw(), lower.raw(), upper.raw()) })?;
        table.bounds_size.set(Some(lower.local_size()?));
        Ok(())
    }

    /// The global indices of this rank's active unknowns at the current iterate: those on a bound
    /// whose residual presses against it. Empty for a solver without bounds. Collective.
    ///
    /// # Errors
    /// If there is no iterate yet.
    pub fn active_set(&self) -> Result<Vec<i32>> {
        if !self.is_bounded()? || self.table()?.bounds_size.get().is_none() {
            return Ok(Vec::new());
        }
        let (x, f) = (self.solution()?, self.function()?);
        self.check_layout(x)?;
        let mut set = ptr::null_mut();
        let (mut count, mut indices) = (0, ptr::null());
        // SAFETY: a live solver with bounds, whose iterate and residual have the layout of the
        // bounds; PETSc makes an index set and lends its indices, which are copied; both go back.
        unsafe {
            check(sys::SNESVIGetActiveSetIS(
                self.raw(),
                x.raw(),
                f.raw(),
                &mut set,
            ))?;
            check(sys::ISGetLocalSize(set, &mut count))?;
            check(sys::ISGetIndices(set, &mut indices))?;
            let copy = match usize::try_from(count) {
                Ok(len @ 1..) => std::slice::from_raw_parts(indices, len).to_vec(),
                _ => Vec::new(),
            };
            check(sys::ISRestoreIndices(set, &mut indices))?;
            check(sys::ISDestroy(&mut set))?;
            Ok(copy)
        }
    }

    /// The global indices of this rank's inactive unknowns, in ascending order: those the reduced
    /// linear system is made of. PETSc's own set exists during the linear solve only; this one is
    /// found by the same rule at any time. Collective.
    ///
    /// # Errors
    /// If there is no iterate yet.
    pub fn inactive_set(&self) -> Result<Vec<i32>> {
        let active = self.active_set()?;
        let mut active = active.iter().peekable();
        let own = self.solution()?.ownership_range()?;
        Ok(own.filter(|i| active.next_if_eq(&i).is_none()).collect())
    }
}
