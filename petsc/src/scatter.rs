//! Copies of distributed entries on the ranks that need them.

use std::ptr;

use petsc_sys as sys;

use crate::{
    error::{Error, Result, check},
    session::{Keep, keep, mpi_has_ended},
    vector::{VectorRef, index},
};

/// Brings chosen entries of distributed vectors to this rank, and sums contributions back.
pub struct Scatter {
    scatter: sys::VecScatter,
    /// Has no values of its own worth keeping: each call lends it the caller's array.
    local: sys::Vec,
    local_size: usize,
    owned_size: usize,
    _keep: Keep,
}

impl Scatter {
    /// Prepares to bring the entries with these global indices (any order, also repeated, also of
    /// other ranks) of vectors laid out as `vector` to this rank. Collective.
    ///
    /// # Errors
    /// If an index is out of range.
    pub fn new(vector: &VectorRef, indices: &[i32]) -> Result<Self> {
        let mut this = Scatter {
            scatter: ptr::null_mut(),
            local: ptr::null_mut(),
            local_size: indices.len(),
            owned_size: vector.local_size()?,
            _keep: keep()?,
        };
        let count = index(indices.len())?;
        let mut set = ptr::null_mut();
        // SAFETY: PETSc copies the indices, and writes new objects, which `this` owns (the index set
        // is given back here).
        unsafe {
            let comm = mpi_sys::RSMPI_COMM_SELF;
            check(sys::VecCreateSeq(comm, count, &mut this.local))?;
            let mode = sys::PETSC_COPY_VALUES;
            check(sys::ISCreateGeneral(
                comm,
                count,
                indices.as_ptr(),
                mode,
                &mut set,
            ))?;
            let made = check(sys::VecScatterCreate(
                vector.raw(),
                set,
                this.local,
                ptr::null_mut(),
                &mut this.scatter,
            ));
            check(sys::ISDestroy(&mut set))?;
            made?;
        }
        Ok(this)
    }

    /// `local[i]` becomes the entry of `global` with the i-th index. Collective.
    ///
    /// # Errors
    /// If a size differs from the one at construction.
    pub fn forward(&self, global: &VectorRef, local: &mut [f64]) -> Result<()> {
        self.check_sizes(global, local)?;
        self.with(local.as_mut_ptr(), |scatter, local| {
            // SAFETY: live objects with the sizes of construction; `local` lends the caller's array.
            unsafe {
                let (insert, forward) = (sys::INSERT_VALUES, sys::SCATTER_FORWARD);
                check(sys::VecScatterBegin(
                    scatter,
                    global.raw(),
                    local,
                    insert,
                    forward,
                ))?;
                check(sys::VecScatterEnd(
                    scatter,
                    global.raw(),
                    local,
                    insert,
                    forward,
                ))
            }
        })
    }

    /// Adds `local[i]` to the entry of `global` with the i-th index. Collective.
    ///
    /// # Errors
    /// If a size differs from the one at construction.
    pub fn reverse_add(&self, local: &[f64], global: &mut VectorRef) -> Result<()> {
        self.check_sizes(global, local)?;
        // PETSc wants a mutable pointer but only reads from the source of a scatter.
        self.with(local.as_ptr().cast_mut(), |scatter, local| {
            // SAFETY: as in `forward`.
            unsafe {
                let (add, reverse) = (sys::ADD_VALUES, sys::SCATTER_REVERSE);
                check(sys::VecScatterBegin(
                    scatter,
                    local,
                    global.raw(),
                    add,
                    reverse,
                ))?;
                check(sys::VecScatterEnd(
                    scatter,
                    local,
                    global.raw(),
                    add,
                    reverse,
                ))
            }
        })
    }

    fn with(
        &self,
        array: *mut f64,
        body: impl FnOnce(sys::VecScatter, sys::Vec) -> Result<()>,
    ) -> Result<()> {
        // SAFETY: the array has the length of `self.local` and outlives the loan.
        check(unsafe { sys::VecPlaceArray(self.local, array) })?;
        let done = body(self.scatter, self.local);
        // SAFETY: ends the loan begun above.
        check(unsafe { sys::VecResetArray(self.local) })?;
        done
    }

    /// PETSc itself checks sizes only in builds with debugging.
    fn check_sizes(&self, global: &VectorRef, local: &[f64]) -> Result<()> {
        if local.len() == self.local_size && global.local_size()? == self.owned_size {
            return Ok(());
        }
        Err(Error::usage(format!(
            "a scatter of {} indices over vectors with {} own entries got {} and {}",
            self.local_size,
            self.owned_size,
            local.len(),
            global.local_size()?
        )))
    }
}

impl Drop for Scatter {
    fn drop(&mut self) {
        if mpi_has_ended() {
            return;
        }
        // SAFETY: `self` owns both objects (or null, which PETSc ignores).
        unsafe {
            sys::VecScatterDestroy(&mut self.scatter);
            sys::VecDestroy(&mut self.local);
        }
    }
}
