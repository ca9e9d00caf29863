//! Distributed vectors.

use std::{ops::Range, ptr};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    error::{Error, Result, check},
    guard::{ReadGuard, WriteGuard},
    handle::petsc_object,
    session::keep,
};

petsc_object! {
    /// A distributed vector of `f64`.
    Vector,
    /// A borrowed [`Vector`].
    VectorRef,
    Vec, VecDestroy
}

impl Vector {
    /// A zero vector of which this rank owns `local_size` entries. Collective.
    ///
    /// # Errors
    /// If PETSc is not running or runs out of memory.
    pub fn new<C: Communicator>(comm: &C, local_size: usize) -> Result<Self> {
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        let vector = unsafe {
            check(sys::VecCreate(comm.as_raw(), &mut raw))?;
            Self::own(raw, keep)?
        };
        // SAFETY: a live vector whose sizes and type are not set yet.
        unsafe {
            check(sys::VecSetSizes(
                raw,
                index(local_size)?,
                sys::PETSC_DETERMINE,
            ))?;
            check(sys::VecSetType(raw, sys::VECSTANDARD.as_ptr()))?;
            check(sys::VecSet(raw, 0.0))?;
        }
        Ok(vector)
    }
}

impl VectorRef {
    /// A zero vector of the same layout. Collective.
    ///
    /// # Errors
    /// If PETSc runs out of memory.
    pub fn duplicate(&self) -> Result<Vector> {
        let mut raw = ptr::null_mut();
        // SAFETY: a live vector; PETSc writes the new object, which is owned at once.
        let vector = unsafe {
            check(sys::VecDuplicate(self.raw(), &mut raw))?;
            Vector::own(raw, keep()?)?
        };
        // SAFETY: a live vector.
        check(unsafe { sys::VecSet(raw, 0.0) })?;
        Ok(vector)
    }

    /// A copy with the same values. Collective.
    ///
    /// # Errors
    /// If PETSc runs out of memory.
    pub fn to_owned(&self) -> Result<Vector> {
        let mut copy = self.duplicate()?;
        copy.copy_from(self)?;
        Ok(copy)
    }

    /// The number of entries this rank owns.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn local_size(&self) -> Result<usize> {
        let mut size = 0;
        // SAFETY: a live vector, one integer to write.
        check(unsafe { sys::VecGetLocalSize(self.raw(), &mut size) })?;
        Ok(usize::try_from(size).unwrap_or(0))
    }

    /// The number of entries on all ranks.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn size(&self) -> Result<usize> {
        let mut size = 0;
        // SAFETY: a live vector, one integer to write.
        check(unsafe { sys::VecGetSize(self.raw(), &mut size) })?;
        Ok(usize::try_from(size).unwrap_or(0))
    }

    /// The global indices this rank owns.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn ownership_range(&self) -> Result<Range<i32>> {
        let (mut first, mut end) = (0, 0);
        // SAFETY: a live vector, two integers to write.
        check(unsafe { sys::VecGetOwnershipRange(self.raw(), &mut first, &mut end) })?;
        Ok(first..end)
    }

    /// This rank's entries, to read.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn read(&self) -> Result<ReadGuard<'_>> {
        ReadGuard::new(self)
    }

    /// This rank's entries, to read and write.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn write(&mut self) -> Result<WriteGuard<'_>> {
        WriteGuard::new(self)
    }

    /// Sets every entry to `value`.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_all(&mut self, value: f64) -> Result<()> {
        // SAFETY: a live vector.
        check(unsafe { sys::VecSet(self.raw(), value) })
    }

    /// `self = x`.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn copy_from(&mut self, x: &VectorRef) -> Result<()> {
        // SAFETY: two live vectors; PETSc checks their layouts.
        check(unsafe { sys::VecCopy(x.raw(), self.raw()) })
    }

    /// `self = self + a x`.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn axpy(&mut self, a: f64, x: &VectorRef) -> Result<()> {
        // SAFETY: two live vectors; PETSc checks their layouts.
        check(unsafe { sys::VecAXPY(self.raw(), a, x.raw()) })
    }

    /// `self = a x + b self`.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn axpby(&mut self, a: f64, b: f64, x: &VectorRef) -> Result<()> {
        // SAFETY: two live vectors; PETSc checks their layouts.
        check(unsafe { sys::VecAXPBY(self.raw(), a, b, x.raw()) })
    }

    /// `self = x + a self`.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn aypx(&mut self, a: f64, x: &VectorRef) -> Result<()> {
        // SAFETY: two live vectors; PETSc checks their layouts.
        check(unsafe { sys::VecAYPX(self.raw(), a, x.raw()) })
    }

    /// `self = a x + y`.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn waxpy(&mut self, a: f64, x: &VectorRef, y: &VectorRef) -> Result<()> {
        // SAFETY: three live vectors; PETSc checks their layouts.
        check(unsafe { sys::VecWAXPY(self.raw(), a, x.raw(), y.raw()) })
    }

    /// `self = a self`.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn scale(&mut self, a: f64) -> Result<()> {
        // SAFETY: a live vector.
        check(unsafe { sys::VecScale(self.raw(), a) })
    }

    /// The scalar product with `other`. Collective.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn dot(&self, other: &VectorRef) -> Result<f64> {
        let mut value = 0.0;
        // SAFETY: two live vectors, one number to write; PETSc checks the layouts.
        check(unsafe { sys::VecDot(self.raw(), other.raw(), &mut value) })?;
        Ok(value)
    }

    /// The Euclidean norm. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn norm2(&self) -> Result<f64> {
        self.norm(sys::NORM_2)
    }

    /// The largest absolute value. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn norm_max(&self) -> Result<f64> {
        self.norm(sys::NORM_INFINITY)
    }

    fn norm(&self, kind: sys::NormType) -> Result<f64> {
        let mut value = 0.0;
        // SAFETY: a live vector, one number to write (both norms asked for are single numbers).
        check(unsafe { sys::VecNorm(self.raw(), kind, &mut value) })?;
        Ok(value)
    }

    /// The sum of all entries. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn sum(&self) -> Result<f64> {
        let mut value = 0.0;
        // SAFETY: a live vector, one number to write.
        check(unsafe { sys::VecSum(self.raw(), &mut value) })?;
        Ok(value)
    }
}

/// A size or position as PETSc's integer.
pub(crate) fn index(value: usize) -> Result<i32> {
    i32::try_from(value).map_err(|_| Error::usage(format!("{value} is too large for PETSc")))
}
