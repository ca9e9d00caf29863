//! A direct factorisation whose symbolic part is kept.

use std::{cell::Cell, ptr};

use petsc_sys as sys;

use crate::{
    error::{Error, Result, check},
    matrix::MatrixRef,
    session::{Keep, has_external_package, keep, mpi_has_ended},
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

/// What a factorisation may take for granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorKind {
    /// Nothing: L U.
    General,
    /// The matrix is symmetric, definite or not: L D L^T. Only its upper triangle is read.
    Symmetric,
}

/// A factorisation of matrices that share one pattern: by MUMPS, or on one rank by PETSc itself where
/// PETSc was built without MUMPS.
///
/// The symbolic analysis is made once; [`Factorization::factor`] repeats the numeric part only.
/// MUMPS reads its options (`-mat_mumps_icntl_…`, behind the prefix given) at construction.
pub struct Factorization {
    pub(crate) raw: sys::Mat,
    pub(crate) mumps: bool,
    kind: FactorKind,
    /// Unknowns that are not eliminated.
    pub(crate) kept: usize,
    status: Cell<Option<FactorStatus>>,
    _keep: Keep,
}

impl Factorization {
    /// Analyses the pattern of a matrix. Collective.
    ///
    /// # Errors
    /// If MUMPS is missing on several ranks, or the analysis fails.
    pub fn new(matrix: &MatrixRef, kind: FactorKind) -> Result<Self> {
        let this = Self::begin(matrix, kind)?;
        this.analyse(matrix)?;
        Ok(this)
    }

    pub(crate) fn begin(matrix: &MatrixRef, kind: FactorKind) -> Result<Self> {
        let mumps = has_external_package("mumps")?;
        let mut this = Factorization {
            raw: ptr::null_mut(),
            mumps,
            kind,
            kept: 0,
            status: Cell::new(None),
            _keep: keep()?,
        };
        let package = if mumps {
            sys::MATSOLVERMUMPS.as_ptr()
        } else {
            sys::MATSOLVERPETSC.as_ptr()
        };
        let petsc_kind = match kind {
            FactorKind::General => sys::MAT_FACTOR_LU,
            FactorKind::Symmetric => sys::MAT_FACTOR_CHOLESKY,
        };
        // SAFETY: a live matrix; PETSc writes the new object, which `this` owns.
        check(unsafe { sys::MatGetFactor(matrix.raw(), package, petsc_kind, &mut this.raw) })?;
        if this.raw.is_null() {
            return Err(without_mumps());
        }
        Ok(this)
    }

    pub(crate) fn analyse(&self, matrix: &MatrixRef) -> Result<()> {
        let (raw, defaults) = (matrix.raw(), ptr::null());
        let (mut rows, mut columns) = (ptr::null_mut(), ptr::null_mut());
        if !self.mumps {
            let kind = sys::MATORDERINGND.as_ptr();
            // SAFETY: a live matrix; PETSc writes two new index sets, which are destroyed below.
            check(unsafe { sys::MatGetOrdering(raw, kind, &mut rows, &mut columns) })?;
        }
        // SAFETY: live objects; null orderings leave the ordering to MUMPS, a null info means defaults; the
        // factor counts its references to the index sets, of which null ones are ignored.
        unsafe {
            let analysed = check(match self.kind {
                FactorKind::General => {
                    sys::MatLUFactorSymbolic(self.raw, raw, rows, columns, defaults)
                }
                FactorKind::Symmetric => {
                    sys::MatCholeskyFactorSymbolic(self.raw, raw, rows, defaults)
                }
            });
            check(sys::ISDestroy(&mut rows))?;
            check(sys::ISDestroy(&mut columns))?;
            analysed
        }
    }

    /// Factorises a matrix of the pattern given at construction. Collective.
    ///
    /// # Errors
    /// If the matrix does not fit; a singular matrix is a [`FactorStatus`].
    pub fn factor(&self, matrix: &MatrixRef) -> Result<FactorStatus> {
        self.status.set(None);
        let (raw, defaults) = (matrix.raw(), ptr::null());
        let mut error = sys::MAT_FACTOR_NOERROR;
        // SAFETY: live objects; PETSc checks the sizes; one value to write.
        unsafe {
            check(sys::MatFactorClearError(self.raw))?;
            check(match self.kind {
                FactorKind::General => sys::MatLUFactorNumeric(self.raw, raw, defaults),
                FactorKind::Symmetric => sys::MatCholeskyFactorNumeric(self.raw, raw, defaults),
            })?;
            check(sys::MatFactorGetError(self.raw, &mut error))?;
        }
        let status = match error {
            sys::MAT_FACTOR_NOERROR => FactorStatus::Ready,
            sys::MAT_FACTOR_STRUCT_ZEROPIVOT => FactorStatus::StructurallySingular,
            sys::MAT_FACTOR_NUMERIC_ZEROPIVOT => FactorStatus::NumericallySingular,
            sys::MAT_FACTOR_OUTMEMORY => FactorStatus::OutOfMemory,
            _ => FactorStatus::Other,
        };
        if self.kept > 0 && status == FactorStatus::Ready {
            self.hand_over_kept()?;
        }
        self.status.set(Some(status));
        Ok(status)
    }

    /// Solves `A x = b` with the last factors; unknowns that were [kept](Factorization::keeping) are held at zero.
    /// Collective.
    ///
    /// # Errors
    /// If there are no usable factors or the layouts do not fit.
    pub fn solve(&self, b: &VectorRef, x: &mut VectorRef) -> Result<()> {
        self.solve_with(b, x, |kept| {
            kept.fill(0.0);
            Ok(())
        })
    }

    pub(crate) fn is_ready(&self) -> bool {
        self.status.get() == Some(FactorStatus::Ready)
    }

    /// The solve itself.
    pub(crate) fn substitute(&self, b: &VectorRef, x: &mut VectorRef) -> Result<()> {
        if !self.is_ready() {
            return Err(Error::usage("the matrix is not factorised"));
        }
        // SAFETY: live objects; PETSc checks the layouts.
        check(unsafe { sys::MatSolve(self.raw, b.raw(), x.raw()) })
    }
}

pub(crate) fn without_mumps() -> Error {
    Error::usage("PETSc was built without MUMPS, which this needs")
}

impl Drop for Factorization {
    fn drop(&mut self) {
        if !mpi_has_ended() {
            // SAFETY: `self` owns the object (or null, which PETSc ignores).
            unsafe { sys::MatDestroy(&mut self.raw) };
        }
    }
}
