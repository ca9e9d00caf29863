//! Loans of a vector's local array, given back when dropped.

use std::{
    ops::{Deref, DerefMut},
    ptr, slice,
};

use petsc_sys as sys;

use crate::{
    VectorRef,
    error::{Result, check},
};

/// This rank's entries of a vector, to read.
#[must_use]
pub struct ReadGuard<'a> {
    vector: &'a VectorRef,
    data: *const f64,
    len: usize,
}

impl<'a> ReadGuard<'a> {
    pub(crate) fn new(vector: &'a VectorRef) -> Result<Self> {
        let len = vector.local_size()?;
        let mut data = ptr::null();
        // SAFETY: a live vector, one pointer to write; the guard gives the array back.
        check(unsafe { sys::VecGetArrayRead(vector.raw(), &mut data) })?;
        Ok(ReadGuard { vector, data, len })
    }
}

impl Deref for ReadGuard<'_> {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        if self.len == 0 {
            return &[]; // PETSc's pointer may be null
        }
        // SAFETY: PETSc's array of `len` numbers, valid until it is given back; the vector is
        // borrowed, so nobody writes to it meanwhile.
        unsafe { slice::from_raw_parts(self.data, self.len) }
    }
}

impl Drop for ReadGuard<'_> {
    fn drop(&mut self) {
        // SAFETY: gives back what VecGetArrayRead lent.
        unsafe { sys::VecRestoreArrayRead(self.vector.raw(), &mut self.data) };
    }
}

/// This rank's entries of a vector, to read and write.
#[must_use]
pub struct WriteGuard<'a> {
    vector: &'a mut VectorRef,
    data: *mut f64,
    len: usize,
}

impl<'a> WriteGuard<'a> {
    pub(crate) fn new(vector: &'a mut VectorRef) -> Result<Self> {
        let len = vector.local_size()?;
        let mut data = ptr::null_mut();
        // SAFETY: a live vector, one pointer to write; the guard gives the array back.
        check(unsafe { sys::VecGetArray(vector.raw(), &mut data) })?;
        Ok(WriteGuard { vector, data, len })
    }
}

impl Deref for WriteGuard<'_> {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        if self.len == 0 {
            return &[]; // PETSc's pointer may be null
        }
        // SAFETY: PETSc's array of `len` numbers, valid until it is given back; the vector is
        // borrowed mutably by the guard.
        unsafe { slice::from_raw_parts(self.data, self.len) }
    }
}

impl DerefMut for WriteGuard<'_> {
    fn deref_mut(&mut self) -> &mut [f64] {
        if self.len == 0 {
            return &mut []; // PETSc's pointer may be null
        }
        // SAFETY: as in `deref`, and the guard is borrowed mutably.
        unsafe { slice::from_raw_parts_mut(self.data, self.len) }
    }
}

impl Drop for WriteGuard<'_> {
    fn drop(&mut self) {
        // SAFETY: gives back what VecGetArray lent; PETSc notes that the values have changed.
        unsafe { sys::VecRestoreArray(self.vector.raw(), &mut self.data) };
    }
}
