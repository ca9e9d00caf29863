//! Start and end of PETSc.

use std::{
    cell::RefCell,
    ffi::{CString, c_char, c_int},
    ptr,
    rc::{Rc, Weak},
};

use petsc_sys as sys;

use crate::error::{Error, Result, check, on_error};

/// Ends PETSc when the last object that needs it is gone.
pub(crate) struct Running(());

/// A share in the running PETSc; every owned PETSc object holds one.
pub(crate) type Keep = Rc<Running>;

thread_local! {
    static RUNNING: RefCell<Weak<Running>> = const { RefCell::new(Weak::new()) };
}

impl Drop for Running {
    fn drop(&mut self) {
        if !mpi_has_ended() {
            // SAFETY: called once, on the thread that initialised PETSc (`Rc` cannot leave it), and
            // not after the end of MPI.
            unsafe { sys::PetscFinalize() };
        }
    }
}

/// Whether MPI_Finalize was called, after which no PETSc object can be freed.
pub(crate) fn mpi_has_ended() -> bool {
    let mut ended: c_int = 0;
    // SAFETY: may be called at any time.
    unsafe { mpi_sys::MPI_Finalized(&mut ended) };
    ended != 0
}

/// The running PETSc of this thread.
pub(crate) fn keep() -> Result<Keep> {
    RUNNING
        .with_borrow(Weak::upgrade)
        .ok_or_else(|| Error::usage("PETSc is not running on this thread: no Session"))
}

/// PETSc between its start and its end.
///
/// MPI is initialised before (`mpi::initialize_with_threading`) and ends after it. PETSc ends when
/// the session and all objects made under it are dropped.
pub struct Session {
    _running: Keep,
}

impl Session {
    /// Starts PETSc with the program's arguments, the program's name first.
    ///
    /// PETSc reads its options from the arguments, from the environment variable `PETSC_OPTIONS` and
    /// from option files. From here on a failing call gives an `Err` and prints nothing. A screen that takes no text, as a
    /// pipe whose reader has left, is no failure: what PETSc writes there goes to nothing.
    ///
    /// # Errors
    /// If MPI is not running, if PETSc was started before or is another version than the one this crate was
    /// built with, or if PETSc rejects its options.
    pub fn new(args: &[String]) -> Result<Self> {
        Self::with_help(args, "")
    }

    /// Starts PETSc as [`Session::new`] does; with `-help`, PETSc prints `help` first.
    ///
    /// # Errors
    /// As [`Session::new`].
    pub fn with_help(args: &[String], help: &str) -> Result<Self> {
        let mut started: c_int = 0;
        // SAFETY: may be called at any time.
        unsafe { mpi_sys::MPI_Initialized(&mut started) };
        if started == 0 || mpi_has_ended() {
            return Err(Error::usage("MPI must be running before PETSc starts"));
        }
        let mut begun = sys::PETSC_FALSE;
        let mut over = sys::PETSC_FALSE;
        // SAFETY: both functions may be called at any time and write one PetscBool each.
        unsafe {
            sys::PetscInitialized(&mut begun);
            sys::PetscFinalized(&mut over);
        }
        if begun != sys::PETSC_FALSE || over != sys::PETSC_FALSE {
            return Err(Error::usage("PETSc can be started only once"));
        }
        require_built_version()?;
        let arguments = c_arguments(args)?;
        let mut count =
            c_int::try_from(args.len()).map_err(|_| Error::usage("too many arguments"))?;
        let mut first = arguments;
        let help = c_string(help)?;
        // SAFETY: `arguments` is a NULL-terminated array of C strings that lives for ever, because
        // PETSc keeps pointers into it; so does the help text.
        unsafe {
            sys::petsc_rs_forgive_screen();
            // Before the start, so that a missing option file comes back as an `Err` too.
            check(sys::PetscPushErrorHandler(Some(on_error), ptr::null_mut()))?;
            let help = if help.is_empty() {
                ptr::null()
            } else {
                help.into_raw().cast_const()
            };
            check(sys::PetscInitialize(
                &mut count,
                &mut first,
                ptr::null(),
                help,
            ))?;
        }
        let running = Rc::new(Running(()));
        RUNNING.set(Rc::downgrade(&running));
        Ok(Session { _running: running })
    }

    /// PETSc's version at run time, for example `3.18.5`.
    pub fn version(&self) -> String {
        let [major, minor, patch] = running_version();
        format!("{major}.{minor}.{patch}")
    }
}

/// Whether PETSc was built with an external package, for example `mumps`.
///
/// # Errors
/// If PETSc is not running or the name holds a NUL byte.
pub fn has_external_package(name: &str) -> Result<bool> {
    let _keep = keep()?;
    let name = c_string(name)?;
    let mut found = sys::PETSC_FALSE;
    // SAFETY: a C string, and one PetscBool to write.
    check(unsafe { sys::PetscHasExternalPackage(name.as_ptr(), &mut found) })?;
    Ok(found != sys::PETSC_FALSE)
}

/// The version of the PETSc whose headers this crate was built with, for example `3.18.5`.
pub const BUILT_WITH: &str = env!("PETSC_RS_VERSION");

fn running_version() -> [c_int; 3] {
    let (mut major, mut minor, mut patch) = (0, 0, 0);
    // SAFETY: may be called at any time; PETSc writes one integer behind each pointer; the fourth may be
    // null.
    unsafe { sys::PetscGetVersionNumber(&mut major, &mut minor, &mut patch, ptr::null_mut()) };
    [major, minor, patch]
}

/// Between minor versions PETSc changes the sizes of its types, and this crate is built for one.
fn require_built_version() -> Result<()> {
    let [major, minor, _] = running_version();
    if BUILT_WITH.starts_with(&format!("{major}.{minor}.")) {
        return Ok(());
    }
    Err(Error::usage(format!(
        "built with PETSc {BUILT_WITH}, but the library found at run time is PETSc {major}.{minor}: build again"
    )))
}

/// A C string, or an error if the text holds a NUL byte.
pub(crate) fn c_string(text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::usage(format!("a NUL byte in {text:?}")))
}

/// A leaked, NULL-terminated copy of the arguments.
fn c_arguments(args: &[String]) -> Result<*mut *mut c_char> {
    let texts = args
        .iter()
        .map(|text| c_string(text))
        .collect::<Result<Vec<_>>>()?;
    let mut pointers: Vec<*mut c_char> = texts.into_iter().map(CString::into_raw).collect();
    pointers.push(ptr::null_mut());
    Ok(pointers.leak().as_mut_ptr())
}
