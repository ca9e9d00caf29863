//! Distributed sparse matrices.

use std::{cell::Cell, ptr, slice};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    agree::{largest, sum},
    callback::table,
    error::{Error, Result, check},
    handle::petsc_object,
    session::keep,
    vector::{VectorRef, index},
};

petsc_object! {
    /// A distributed sparse matrix (type AIJ) of `f64`.
    Matrix,
    /// A borrowed [`Matrix`].
    MatrixRef,
    Mat, MatDestroy
}

/// Properties a matrix can be told to have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MatrixOption {
    /// The values are symmetric.
    Symmetric,
    /// The pattern is symmetric.
    StructurallySymmetric,
    /// The matrix is symmetric and positive definite.
    PositiveDefinite,
    /// Zeroing rows leaves the pattern as it is.
    KeepNonzeroPattern,
}

/// How many values `set_values_coo` takes; attached to the PETSc object, so that a borrowed matrix
/// knows it too.
#[derive(Default)]
struct CooLength(Cell<Option<usize>>);

impl Matrix {
    /// A matrix of which this rank owns `local_rows` rows and as many columns, with entries at
    /// `(rows[k], cols[k])`. Collective.
    ///
    /// Entries with a negative index are ignored; entries may repeat and may belong to other ranks.
    ///
    /// # Errors
    /// If the lengths differ or an index is out of range.
    pub fn from_coo<C: Communicator>(
        comm: &C,
        local_rows: usize,
        rows: &[i32],
        cols: &[i32],
    ) -> Result<Self> {
        Self::rectangular_from_coo(comm, [local_rows, local_rows], rows, cols)
    }

    /// As [`Matrix::from_coo`], with `[rows, columns]` of this rank. Collective.
    ///
    /// # Errors
    /// As [`Matrix::from_coo`].
    pub fn rectangular_from_coo<C: Communicator>(
        comm: &C,
        local: [usize; 2],
        rows: &[i32],
        cols: &[i32],
    ) -> Result<Self> {
        let keep = keep()?;
        let [m, n] = [index(local[0])?, index(local[1])?];
        // PETSc checks neither the columns nor that all ranks succeed.
        let [height, width] = [sum(comm.as_raw(), m)?, sum(comm.as_raw(), n)?];
        let within = |indices: &[i32], size| indices.iter().all(|&i| i < size);
        let fits = rows.len() == cols.len() && within(rows, height) && within(cols, width);
        if largest(comm.as_raw(), i32::from(!fits))? > 0 {
            return Err(Error::usage(format!(
                "as many row as column indices are needed, all below {height} and {width}, on every rank"
            )));
        }
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        let matrix = unsafe {
            check(sys::MatCreate(comm.as_raw(), &mut raw))?;
            Self::own(raw, keep)?
        };
        // PETSc may reorder the indices in place.
        let (mut rows, mut cols) = (rows.to_vec(), cols.to_vec());
        let count =
            sys::PetscCount::try_from(rows.len()).map_err(|_| Error::usage("too many entries"))?;
        // SAFETY: a live matrix; both arrays have `count` entries and are not kept by PETSc.
        unsafe {
            let whole = sys::PETSC_DETERMINE;
            check(sys::MatSetSizes(raw, m, n, whole, whole))?;
            check(sys::MatSetType(raw, sys::MATAIJ.as_ptr()))?;
            check(sys::MatSetPreallocationCOO(
                raw,
                count,
                rows.as_mut_ptr(),
                cols.as_mut_ptr(),
            ))?;
        }
        matrix.coo_length()?.0.set(Some(rows.len()));
        Ok(matrix)
    }
}

impl MatrixRef {
    fn coo_length(&self) -> Result<std::rc::Rc<CooLength>> {
        // SAFETY: a live object, and a name used for this type only.
        unsafe { table(self.object(), c"petsc.rs: coo length") }
    }

    /// Whether the matrix was made by [`Matrix::from_coo`], so that its entries can be set.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn takes_values(&self) -> Result<bool> {
        Ok(self.coo_length()?.0.get().is_some())
    }

    /// Sets all entries of a matrix made by [`Matrix::from_coo`] to the sums of the values given for
    /// them, in the order of construction. Collective.
    ///
    /// # Errors
    /// If the matrix was made otherwise or the number of values differs.
    pub fn set_values_coo(&mut self, values: &[f64]) -> Result<()> {
        if self.coo_length()?.0.get() != Some(values.len()) {
            return Err(Error::usage(format!(
                "{} values do not fit the matrix",
                values.len()
            )));
        }
        // SAFETY: a live matrix that expects exactly this many values.
        check(unsafe { sys::MatSetValuesCOO(self.raw(), values.as_ptr(), sys::INSERT_VALUES) })
    }

    /// A matrix of the same pattern, with the same values. Collective.
    ///
    /// [`MatrixRef::set_values_coo`] does not work on the copy.
    ///
    /// # Errors
    /// If PETSc runs out of memory.
    pub fn duplicate(&self) -> Result<Matrix> {
        let mut raw = ptr::null_mut();
        // SAFETY: a live matrix; PETSc writes the new object, which is owned at once.
        unsafe {
            check(sys::MatDuplicate(
                self.raw(),
                sys::MAT_COPY_VALUES,
                &mut raw,
            ))?;
            Matrix::own(raw, keep()?)
        }
    }

    /// `self = other`, of the same pattern. Collective.
    ///
    /// # Errors
    /// If the patterns differ.
    pub fn copy_from(&mut self, other: &MatrixRef) -> Result<()> {
        // SAFETY: two live matrices; PETSc checks that they fit.
        check(unsafe { sys::MatCopy(other.raw(), self.raw(), sys::SAME_NONZERO_PATTERN) })
    }

    /// `y = self x`. Collective.
    ///
    /// # Errors
    /// If the layouts do not fit.
    pub fn mult(&self, x: &VectorRef, y: &mut VectorRef) -> Result<()> {
        // SAFETY: live objects; PETSc checks the layouts.
        check(unsafe { sys::MatMult(self.raw(), x.raw(), y.raw()) })
    }

    /// Replaces rows and columns (global indices of this rank) by `diagonal` times the identity.
    /// Collective.
    ///
    /// Set [`MatrixOption::KeepNonzeroPattern`] before to keep the pattern.
    ///
    /// # Errors
    /// If an index is out of range.
    pub fn zero_rows_columns(&mut self, rows: &[i32], diagonal: f64) -> Result<()> {
        let none = ptr::null_mut();
        // SAFETY: a live matrix, an array of the given length, and no vectors to adapt.
        check(unsafe {
            sys::MatZeroRowsColumns(
                self.raw(),
                index(rows.len())?,
                rows.as_ptr(),
                diagonal,
                none,
                none,
            )
        })
    }

    /// Tells the matrix that it has a property.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_option(&mut self, option: MatrixOption, value: bool) -> Result<()> {
        let option = match option {
            MatrixOption::Symmetric => sys::MAT_SYMMETRIC,
            MatrixOption::StructurallySymmetric => sys::MAT_STRUCTURALLY_SYMMETRIC,
            MatrixOption::PositiveDefinite => sys::MAT_SPD,
            MatrixOption::KeepNonzeroPattern => sys::MAT_KEEP_NONZERO_PATTERN,
        };
        let value = if value {
            sys::PETSC_TRUE
        } else {
            sys::PETSC_FALSE
        };
        // SAFETY: a live matrix.
        check(unsafe { sys::MatSetOption(self.raw(), option, value) })
    }

    /// The number of stored entries on all ranks. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn nonzeros(&self) -> Result<usize> {
        let mut info = sys::MatInfo::default();
        // SAFETY: a live matrix, one structure to write.
        check(unsafe { sys::MatGetInfo(self.raw(), sys::MAT_GLOBAL_SUM, &mut info) })?;
        Ok(info.nz_used as usize)
    }

    /// The columns and values of a row of this rank, for tests and debugging.
    ///
    /// # Errors
    /// If the row belongs to another rank.
    pub fn row(&self, row: i32) -> Result<(Vec<i32>, Vec<f64>)> {
        let (mut count, mut cols, mut values) = (0, ptr::null(), ptr::null());
        // SAFETY: a live matrix; PETSc lends two arrays of `count` entries, which are copied and
        // given back.
        unsafe {
            check(sys::MatGetRow(
                self.raw(),
                row,
                &mut count,
                &mut cols,
                &mut values,
            ))?;
            let len = usize::try_from(count).unwrap_or(0);
            let copy = if len == 0 {
                (Vec::new(), Vec::new())
            } else {
                let cols = slice::from_raw_parts(cols, len);
                (cols.to_vec(), slice::from_raw_parts(values, len).to_vec())
            };
            check(sys::MatRestoreRow(
                self.raw(),
                row,
                &mut count,
                &mut cols,
                &mut values,
            ))?;
            Ok(copy)
        }
    }
}
