//! Several vectors side by side.

use std::{ptr, slice};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    error::{Error, Result, check},
    handle::petsc_object,
    session::keep,
    vector::{VectorRef, index},
};

petsc_object! {
    /// Vectors of one layout as the columns of a dense matrix, to be solved for at once.
    Block,
    /// A borrowed [`Block`].
    BlockRef,
    Mat, MatDestroy
}

impl Block {
    /// `columns` zero vectors of which this rank owns `local_size` entries each. Collective.
    ///
    /// # Errors
    /// If PETSc is not running or runs out of memory.
    pub fn new<C: Communicator>(comm: &C, local_size: usize, columns: usize) -> Result<Self> {
        let (local_size, columns) = (index(local_size)?, index(columns)?);
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc allocates the entries and writes the new object, which is owned at once.
        unsafe {
            check(sys::MatCreateDense(
                comm.as_raw(),
                local_size,
                sys::PETSC_DECIDE,
                sys::PETSC_DETERMINE,
                columns,
                ptr::null_mut(),
                &mut raw,
            ))?;
            let block = Self::own(raw, keep)?;
            check(sys::MatAssemblyBegin(raw, sys::MAT_FINAL_ASSEMBLY))?;
            check(sys::MatAssemblyEnd(raw, sys::MAT_FINAL_ASSEMBLY))?;
            Ok(block)
        }
    }
}

impl BlockRef {
    /// The number of vectors.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn columns(&self) -> Result<usize> {
        let mut columns = 0;
        // SAFETY: a live matrix, one integer to write.
        check(unsafe { sys::MatGetSize(self.raw(), ptr::null_mut(), &mut columns) })?;
        Ok(usize::try_from(columns).unwrap_or(0))
    }

    /// Sets a column to `x`.
    ///
    /// # Errors
    /// If there is no such column or the layouts differ.
    pub fn set_column(&mut self, column: usize, x: &VectorRef) -> Result<()> {
        let (start, x) = (self.start_of(column, x)?, x.read()?);
        let mut data = ptr::null_mut();
        // SAFETY: a live dense matrix; the column was found to lie within its array, which is given back.
        unsafe {
            check(sys::MatDenseGetArray(self.raw(), &mut data))?;
            if !x.is_empty() {
                slice::from_raw_parts_mut(data.add(start), x.len()).copy_from_slice(&x);
            }
            check(sys::MatDenseRestoreArray(self.raw(), &mut data))
        }
    }

    /// Copies a column to `x`.
    ///
    /// # Errors
    /// If there is no such column or the layouts differ.
    pub fn copy_column(&self, column: usize, x: &mut VectorRef) -> Result<()> {
        let start = self.start_of(column, x)?;
        let (mut x, mut data) = (x.write()?, ptr::null());
        // SAFETY: as in `set_column`.
        unsafe {
            check(sys::MatDenseGetArrayRead(self.raw(), &mut data))?;
            if !x.is_empty() {
                let len = x.len();
                x.copy_from_slice(slice::from_raw_parts(data.add(start), len));
            }
            check(sys::MatDenseRestoreArrayRead(self.raw(), &mut data))
        }
    }

    /// Where a column begins in the array of this rank, for a vector of the same layout.
    fn start_of(&self, column: usize, x: &VectorRef) -> Result<usize> {
        let (mut rows, mut stride) = (0, 0);
        // SAFETY: a live dense matrix, one integer to write by each call.
        unsafe {
            check(sys::MatGetLocalSize(self.raw(), &mut rows, ptr::null_mut()))?;
            check(sys::MatDenseGetLDA(self.raw(), &mut stride))?;
        }
        if column >= self.columns()? || index(x.local_size()?)? != rows {
            return Err(Error::usage(format!(
                "column {column} is none of the block, or the layouts differ"
            )));
        }
        Ok(column * usize::try_from(stride).unwrap_or(0))
    }
}
