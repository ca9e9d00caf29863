//! A matrix known by its product with a vector.

use std::{ffi::c_int, ptr, rc::Rc};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    CallbackError, VectorRef,
    callback::{Slot, run, table},
    error::{Result, check},
    matrix::Matrix,
    session::keep,
    vector::index,
};

/// The closure of one shell matrix.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signature of the closure is the content"
)]
struct ShellTable {
    product: Slot<dyn Fn(&VectorRef, &mut VectorRef) -> std::result::Result<(), CallbackError>>,
}

/// # Safety
/// `matrix` is alive.
unsafe fn shell_table(matrix: sys::Mat) -> Result<Rc<ShellTable>> {
    // SAFETY: a live object, and a name used for this type only.
    unsafe { table(matrix.cast(), c"petsc.rs: closure of the shell matrix") }
}

impl Matrix {
    /// A matrix of which this rank owns `local_size` rows and as many columns, known by `product(x, y)`
    /// alone, which sets y to the product with x. Collective.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn shell<C: Communicator>(
        comm: &C,
        local_size: usize,
        product: impl Fn(&VectorRef, &mut VectorRef) -> std::result::Result<(), CallbackError> + 'static,
    ) -> Result<Self> {
        let (keep, size, whole) = (keep()?, index(local_size)?, sys::PETSC_DETERMINE);
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        let matrix = unsafe {
            let (comm, none) = (comm.as_raw(), ptr::null_mut());
            check(sys::MatCreateShell(
                comm, size, size, whole, whole, none, &mut raw,
            ))?;
            Self::own(raw, keep)?
        };
        // SAFETY: a live matrix; PETSc calls the function with the signature that belongs to the operation.
        unsafe {
            shell_table(raw)?.product.set(Rc::new(product));
            let function: OnProduct = on_product;
            let function = std::mem::transmute::<OnProduct, unsafe extern "C" fn()>(function);
            check(sys::MatShellSetOperation(
                raw,
                sys::MATOP_MULT,
                Some(function),
            ))?;
        }
        Ok(matrix)
    }
}

type OnProduct = unsafe extern "C" fn(sys::Mat, sys::Vec, sys::Vec) -> c_int;

unsafe extern "C" fn on_product(matrix: sys::Mat, x: sys::Vec, y: sys::Vec) -> c_int {
    run(matrix.cast(), || {
        // SAFETY: PETSc's live objects; `y` is PETSc's to fill and lent to nobody else.
        let (table, x, y) = unsafe {
            (
                shell_table(matrix)?,
                VectorRef::from_raw(x)?,
                VectorRef::from_raw_mut(y)?,
            )
        };
        table.product.get()?(x, y)
    })
}
