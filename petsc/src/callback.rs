//! Closures called by PETSc: where they live, and what becomes of their failures.

use std::{
    cell::RefCell,
    ffi::{CStr, c_int, c_void},
    panic::{AssertUnwindSafe, catch_unwind},
    ptr,
    rc::Rc,
};

use mpi_sys::MPI_Comm;
use petsc_sys as sys;

use crate::{
    agree::largest,
    error::{Cause, Error, Evaluation, Failure, Result, check, fail},
};

/// A place for one closure. It is called through a copy of the `Rc`, so a closure may be replaced
/// while it runs.
pub(crate) struct Slot<F: ?Sized>(RefCell<Option<Rc<F>>>);

impl<F: ?Sized> Default for Slot<F> {
    fn default() -> Self {
        Slot(RefCell::new(None))
    }
}

impl<F: ?Sized> Slot<F> {
    pub(crate) fn set(&self, closure: Rc<F>) {
        let old = self.0.replace(Some(closure));
        drop(old); // outside the borrow: the old closure may own anything
    }

    pub(crate) fn get(&self) -> Result<Rc<F>> {
        self.0
            .borrow()
            .clone()
            .ok_or_else(|| Error::usage("no closure is set for this callback"))
    }

    pub(crate) fn is_set(&self) -> bool {
        self.0.borrow().is_some()
    }
}

/// The table of closures attached to a PETSc object under `name`; a new one if there is none.
///
/// The table is freed when PETSc destroys the object.
///
/// # Safety
/// `object` is alive, and `name` is used for tables of type `T` only.
pub(crate) unsafe fn table<T: Default + 'static>(
    object: sys::PetscObject,
    name: &'static CStr,
) -> Result<Rc<T>> {
    let mut found: sys::PetscObject = ptr::null_mut();
    // SAFETY: a live object, a C string, one pointer to write.
    check(unsafe { sys::PetscObjectQuery(object, name.as_ptr(), &mut found) })?;
    if found.is_null() {
        // SAFETY: as promised by the caller.
        return unsafe { attach(object, name) };
    }
    let mut pointer: *mut c_void = ptr::null_mut();
    // SAFETY: only `attach` stores objects under `name`: containers with a pointer from
    // `Rc::<T>::into_raw`, whose count is at least one as long as the object lives.
    unsafe {
        check(sys::petsc_rs_container_get(found.cast(), &mut pointer))?;
        Rc::increment_strong_count(pointer.cast::<T>().cast_const());
        Ok(Rc::from_raw(pointer.cast::<T>().cast_const()))
    }
}

/// # Safety
/// As [`table`].
unsafe fn attach<T: Default + 'static>(
    object: sys::PetscObject,
    name: &'static CStr,
) -> Result<Rc<T>> {
    let table = Rc::new(T::default());
    let mut container: sys::PetscContainer = ptr::null_mut();
    // SAFETY: the container takes over one count of the table and gives it back in `release`; the
    // object then holds the only reference to the container.
    unsafe {
        check(sys::PetscContainerCreate(comm_of(object)?, &mut container))?;
        let pointer = Rc::into_raw(Rc::clone(&table)).cast_mut().cast();
        check(sys::PetscContainerSetPointer(container, pointer))?;
        check(sys::petsc_rs_container_set_destroy(
            container,
            Some(release::<T>),
        ))?;
        check(sys::PetscObjectCompose(
            object,
            name.as_ptr(),
            container.cast(),
        ))?;
        check(sys::PetscContainerDestroy(&mut container))?;
    }
    Ok(table)
}

unsafe extern "C" fn release<T>(content: *mut c_void) -> c_int {
    #[cfg(petsc_ge_3_23)]
    // SAFETY: the place where PETSc keeps the pointer that `attach` has stored.
    let pointer = unsafe { *content.cast::<*mut c_void>() };
    #[cfg(not(petsc_ge_3_23))]
    let pointer = content;
    // SAFETY: the pointer stored by `attach`, released once.
    let dropped = catch_unwind(|| drop(unsafe { Rc::from_raw(pointer.cast::<T>().cast_const()) }));
    match dropped {
        Ok(()) => 0,
        Err(payload) => fail(Cause::from_panic(&*payload)),
    }
}

fn comm_of(object: sys::PetscObject) -> Result<MPI_Comm> {
    // SAFETY: reading a handle that PETSc overwrites.
    let mut comm = unsafe { mpi_sys::RSMPI_COMM_NULL };
    // SAFETY: a live object, one handle to write.
    check(unsafe { sys::PetscObjectGetComm(object, &mut comm) })?;
    Ok(comm)
}

/// How an evaluation ended on all ranks together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    Done,
    Domain,
}

/// Runs a closure for PETSc: panics and errors are kept for the caller of the outermost function,
/// and all ranks of `object` agree on the worst outcome. `Err` is the code to return to PETSc.
pub(crate) fn evaluate(
    object: sys::PetscObject,
    body: impl FnOnce() -> Evaluation,
) -> std::result::Result<Outcome, c_int> {
    let mine = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => Ok(Outcome::Done),
        Ok(Err(Failure::Domain)) => Ok(Outcome::Domain),
        Ok(Err(Failure::Fatal(error))) => Err(Cause::Callback(error)),
        Err(payload) => Err(Cause::from_panic(&*payload)),
    };
    let status = match &mine {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Domain) => 1,
        Err(_) => 2,
    };
    let worst = comm_of(object)
        .and_then(|comm| largest(comm, status))
        .map_err(|error| fail(Cause::Callback(Box::new(error))))?;
    match (mine, worst) {
        (Err(cause), _) => Err(fail(cause)),
        (Ok(_), 0) => Ok(Outcome::Done),
        (Ok(_), 1) => Ok(Outcome::Domain),
        (Ok(_), _) => Err(fail(Cause::Elsewhere)),
    }
}

/// Runs a closure that cannot meet a domain error; gives the code to return to PETSc.
pub(crate) fn run(
    object: sys::PetscObject,
    body: impl FnOnce() -> std::result::Result<(), crate::CallbackError>,
) -> c_int {
    match evaluate(object, || body().map_err(Failure::Fatal)) {
        Ok(_) => 0,
        Err(code) => code,
    }
}
