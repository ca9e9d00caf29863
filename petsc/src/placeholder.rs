//! A matrix that only has a size.

use std::{ffi::c_int, ptr};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    error::{Cause, Result, check, fail},
    matrix::Matrix,
    session::keep,
    vector::index,
};

impl Matrix {
    /// A matrix of which this rank owns `local_size` rows and as many columns, without entries.
    /// Collective.
    ///
    /// It stands where PETSc asks for a tangent matrix that nobody reads, because the
    /// [preconditioner](crate::SnesRef::set_shell_preconditioner) solves the whole system by itself:
    /// its parts are again of this kind, so the reduced-space solver extracts nothing. A product with
    /// it is not a number.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn placeholder<C: Communicator>(comm: &C, local_size: usize) -> Result<Self> {
        let (keep, size) = (keep()?, index(local_size)?);
        // SAFETY: a valid communicator; the new object is owned at once.
        unsafe { Self::own(create(comm.as_raw(), size)?, keep) }
    }
}

/// # Safety
/// `comm` is a valid communicator.
unsafe fn create(comm: mpi_sys::MPI_Comm, local_size: c_int) -> Result<sys::Mat> {
    let mut raw = ptr::null_mut();
    let whole = sys::PETSC_DETERMINE;
    // SAFETY: as promised by the caller; PETSc writes the new object and keeps two functions that need
    // no context. PETSc calls each with the signature that belongs to its operation.
    unsafe {
        check(sys::MatCreateShell(
            comm,
            local_size,
            local_size,
            whole,
            whole,
            ptr::null_mut(),
            &mut raw,
        ))?;
        let part: unsafe extern "C" fn(_, _, _, _, _) -> _ = on_part;
        let product: unsafe extern "C" fn(_, _, _) -> _ = on_product;
        let operations = [
            (
                sys::MATOP_CREATE_SUBMATRIX,
                std::mem::transmute::<OnPart, unsafe extern "C" fn()>(part),
            ),
            (
                sys::MATOP_MULT,
                std::mem::transmute::<OnProduct, unsafe extern "C" fn()>(product),
            ),
        ];
        for (operation, function) in operations {
            check(sys::MatShellSetOperation(raw, operation, Some(function)))?;
        }
    }
    Ok(raw)
}

type OnPart =
    unsafe extern "C" fn(sys::Mat, sys::IS, sys::IS, sys::MatReuse, *mut sys::Mat) -> c_int;
type OnProduct = unsafe extern "C" fn(sys::Mat, sys::Vec, sys::Vec) -> c_int;

/// The part of a placeholder is the placeholder of its size.
unsafe extern "C" fn on_part(
    matrix: sys::Mat,
    rows: sys::IS,
    _columns: sys::IS,
    reuse: sys::MatReuse,
    part: *mut sys::Mat,
) -> c_int {
    if reuse == sys::MAT_REUSE_MATRIX {
        return 0;
    }
    let made = || -> Result<sys::Mat> {
        let mut size = 0;
        // SAFETY: reading a handle that PETSc overwrites.
        let mut comm = unsafe { mpi_sys::RSMPI_COMM_NULL };
        // SAFETY: PETSc's live objects; one integer and one handle to write.
        unsafe {
            check(sys::ISGetLocalSize(rows, &mut size))?;
            check(sys::PetscObjectGetComm(matrix.cast(), &mut comm))?;
            create(comm, size)
        }
    };
    match made() {
        // SAFETY: PETSc's place for the new object.
        Ok(raw) => unsafe {
            *part = raw;
            0
        },
        Err(error) => fail(Cause::Callback(error.into())),
    }
}

/// Nobody takes the product with a placeholder for a number.
unsafe extern "C" fn on_product(_matrix: sys::Mat, _x: sys::Vec, y: sys::Vec) -> c_int {
    // SAFETY: PETSc's live vector, which is PETSc's to fill.
    unsafe { sys::VecSet(y, f64::NAN) }
}
