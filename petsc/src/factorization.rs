//! A direct factorisation whose symbolic part is kept.

use std::{cell::Cell, ptr};

use petsc_sys as sys;

use crate::{
    error::{Error, Result, check},
    matrix::MatrixRef,
    session::{Keep, keep, mpi_has_ended},
    vector::VectorRef,
};

/// How a numeric factorisation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorStatus {
    /// The factors can be used.
    Ready,
    /// The pattern makes the matrix singular.
    StructurallySingular,
    /// A pivot is zero: the matrix is singular.
    NumericallySingular,
    /// The factors do not fit into the memory.
    OutOfMemory,
    /// Another failure of the package.
    Other,
}

/// An LU factorisation by MUMPS of matrices that share one pattern.
///
/// The symbolic analysis is made once; [`Factorization::factor`] repeats the numeric part only.
/// MUMPS reads its options (`-mat_mumps_icntl_…`) at construction.
pub struct Factorization {
    raw: sys::Mat,
    status: Cell<Option<FactorStatus>>,
    _keep: Keep,
}

impl Factorization {
    /// Analyses the pattern of a matrix. Collective.
    ///
    /// # Errors
    /// If MUMPS is missing or its analysis fails.
    pub fn new(matrix: &MatrixRef) -> Result<Self> {
        let mut this = Factorization {
            raw: ptr::null_mut(),
            status: Cell::new(None),
            _keep: keep()?,
        };
        let (package, none) = (sys::MATSOLVERMUMPS.as_ptr(), ptr::null_mut());
        // SAFETY: a live matrix; PETSc writes the new object, which `this` owns; null orderings
        // leave the ordering to MUMPS, a null info means defaults.
        unsafe {
            check(sys::MatGetFactor(
                matrix.raw(),
                package,
                sys::MAT_FACTOR_LU,
                &mut this.raw,
            ))?;
            if this.raw.is_null() {
                return Err(Error::usage("PETSc was built without MUMPS"));
            }
            check(sys::MatLUFactorSymbolic(
                this.raw,
                matrix.raw(),
                none,
                none,
                ptr::null(),
            ))?;
        }
        Ok(this)
    }

    /// Factorises a matrix of the pattern given at construction. Collective.
    ///
    /// # Errors
    /// If the matrix does not fit; a singular matrix is a [`FactorStatus`].
    pub fn factor(&self, matrix: &MatrixRef) -> Result<FactorStatus> {
        self.status.set(None);
        let mut error = sys::MAT_FACTOR_NOERROR;
        // SAFETY: live objects; PETSc checks the sizes; one value to write.
        unsafe {
            check(sys::MatFactorClearError(self.raw))?;
            check(sys::MatLUFactorNumeric(self.raw, matrix.raw(), ptr::null()))?;
            check(sys::MatFactorGetError(self.raw, &mut error))?;
        }
        let status = match error {
            sys::MAT_FACTOR_NOERROR => FactorStatus::Ready,
            sys::MAT_FACTOR_STRUCT_ZEROPIVOT => FactorStatus::StructurallySingular,
            sys::MAT_FACTOR_NUMERIC_ZEROPIVOT => FactorStatus::NumericallySingular,
            sys::MAT_FACTOR_OUTMEMORY => FactorStatus::OutOfMemory,
            _ => FactorStatus::Other,
        };
        self.status.set(Some(status));
        Ok(status)
    }

    /// Solves `A x = b` with the last factors. Collective.
    ///
    /// # Errors
    /// If there are no usable factors or the layouts do not fit.
    pub fn solve(&self, b: &VectorRef, x: &mut VectorRef) -> Result<()> {
        if self.status.get() != Some(FactorStatus::Ready) {
            return Err(Error::usage("the matrix is not factorised"));
        }
        // SAFETY: live objects; PETSc checks the layouts.
        check(unsafe { sys::MatSolve(self.raw, b.raw(), x.raw()) })
    }

    /// MUMPS's global information `INFOG(i)`, i from 1: for example 9 for the size of the factors.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn mumps_infog(&self, i: i32) -> Result<i32> {
        if !(1..=80).contains(&i) {
            return Err(Error::usage("INFOG has the indices 1 to 80"));
        }
        let mut value = 0;
        // SAFETY: a live MUMPS factor, an index in range, one integer to write.
        check(unsafe { sys::MatMumpsGetInfog(self.raw, i, &mut value) })?;
        Ok(value)
    }
}

impl Drop for Factorization {
    fn drop(&mut self) {
        if !mpi_has_ended() {
            // SAFETY: `self` owns the object (or null, which PETSc ignores).
            unsafe { sys::MatDestroy(&mut self.raw) };
        }
    }
}
