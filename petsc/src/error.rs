//! Errors: PETSc's message and traceback, and what came out of a closure.

use std::{
    any::Any,
    cell::RefCell,
    ffi::{CStr, c_char, c_int, c_void},
    fmt,
};

use mpi_sys::MPI_Comm;
use petsc_sys as sys;

/// What this crate's functions return.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What closures fail with: any error.
pub type CallbackError = Box<dyn std::error::Error + Send + Sync>;

/// What a closure that evaluates something returns.
pub type Evaluation<T = ()> = std::result::Result<T, Failure>;

/// Why PETSc, or a closure called by it, failed.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// PETSc itself reported an error.
    Petsc {
        /// PETSc's error code.
        code: i32,
        /// PETSc's general text and the particular message.
        message: String,
        /// Innermost function first: `function (file:line)`.
        traceback: Vec<String>,
    },
    /// A closure returned an error.
    Callback {
        /// The closure's own error.
        source: CallbackError,
        /// PETSc's functions between the closure and the caller, innermost first.
        traceback: Vec<String>,
    },
    /// A closure panicked.
    Panic {
        /// The panic's message.
        message: String,
        /// PETSc's functions between the closure and the caller, innermost first.
        traceback: Vec<String>,
    },
    /// A closure failed on another rank of the communicator; that rank knows why.
    Elsewhere,
    /// The wrapper was asked for something that cannot be done.
    Usage(String),
}

impl Error {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Error::Usage(message.into())
    }

    /// PETSc's functions on the way, innermost first (empty if PETSc was not involved).
    pub fn traceback(&self) -> &[String] {
        match self {
            Error::Petsc { traceback, .. }
            | Error::Callback { traceback, .. }
            | Error::Panic { traceback, .. } => traceback,
            Error::Elsewhere | Error::Usage(_) => &[],
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Petsc { code, message, .. } => write!(f, "PETSc error {code}: {message}"),
            Error::Callback { source, .. } => write!(f, "{source}"),
            Error::Panic { message, .. } => write!(f, "panic in a callback: {message}"),
            Error::Elsewhere => write!(f, "a callback failed on another rank"),
            Error::Usage(message) => write!(f, "{message}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            // Display already shows the closure's error, so its own source comes next.
            Error::Callback { source, .. } => source.source(),
            _ => None,
        }
    }
}

/// Why a closure could not evaluate what it was asked for.
///
/// `?` turns every error into [`Failure::Fatal`].
#[derive(Debug)]
pub enum Failure {
    /// The point lies outside the domain of the function, for example because an element has turned
    /// over: the solver may try a smaller step.
    Domain,
    /// The computation cannot go on: the outermost call returns this error.
    Fatal(CallbackError),
}

impl<E: std::error::Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::Fatal(Box::new(error))
    }
}

/// What went wrong inside a closure, kept while PETSc unwinds its own stack.
pub(crate) enum Cause {
    Callback(CallbackError),
    Panic(String),
    Elsewhere,
}

impl Cause {
    pub(crate) fn from_panic(payload: &(dyn Any + Send)) -> Self {
        let text = payload
            .downcast_ref::<&str>()
            .map(ToString::to_string)
            .or_else(|| payload.downcast_ref::<String>().cloned());
        Cause::Panic(text.unwrap_or_else(|| "(no message)".into()))
    }
}

#[derive(Default)]
struct Report {
    message: String,
    traceback: Vec<String>,
    cause: Option<Cause>,
}

thread_local! {
    static REPORT: RefCell<Report> = RefCell::default();
}

/// Turns a PETSc error code into a `Result`, with the report collected by [`on_error`].
pub(crate) fn check(code: c_int) -> Result<()> {
    if code == 0 {
        return Ok(());
    }
    let Report {
        message,
        traceback,
        cause,
    } = REPORT.take();
    Err(match cause {
        Some(Cause::Callback(source)) => Error::Callback { source, traceback },
        Some(Cause::Panic(message)) => Error::Panic { message, traceback },
        Some(Cause::Elsewhere) => Error::Elsewhere,
        None => {
            let message = match (general_text(code), message.is_empty()) {
                (Some(text), false) => format!("{text}: {message}"),
                (Some(text), true) => text,
                (None, _) => message,
            };
            Error::Petsc {
                code,
                message,
                traceback,
            }
        }
    })
}

/// Remembers why a closure failed and gives the code to hand to PETSc.
pub(crate) fn fail(cause: Cause) -> c_int {
    REPORT.replace(Report {
        cause: Some(cause),
        ..Report::default()
    });
    sys::petsc_rs_err_user
}

fn general_text(code: c_int) -> Option<String> {
    let mut text = std::ptr::null();
    // SAFETY: PETSc writes a pointer to one of its static strings, or null; a null third argument
    // means "not wanted".
    let found = unsafe { sys::PetscErrorMessage(code, &mut text, std::ptr::null_mut()) };
    if found != 0 {
        return None;
    }
    // SAFETY: the pointer, if any, is a static NUL-terminated string.
    let text = unsafe { text_of(text) };
    (!text.is_empty()).then_some(text)
}

/// The text behind a C string; empty for null.
///
/// # Safety
/// `text` is null or points to a NUL-terminated string.
pub(crate) unsafe fn text_of(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not null, and NUL-terminated by this function's contract.
    unsafe { CStr::from_ptr(text) }
        .to_string_lossy()
        .into_owned()
}

/// PETSc's error handler: collects instead of printing.
pub(crate) unsafe extern "C" fn on_error(
    _comm: MPI_Comm,
    line: c_int,
    function: *const c_char,
    file: *const c_char,
    code: c_int,
    kind: sys::PetscErrorType,
    message: *const c_char,
    _context: *mut c_void,
) -> c_int {
    // SAFETY: PETSc passes null or NUL-terminated strings.
    let (function, file, message) = unsafe { (text_of(function), text_of(file), text_of(message)) };
    let _ = REPORT.try_with(|report| {
        let Ok(mut report) = report.try_borrow_mut() else {
            return;
        };
        if kind == sys::PETSC_ERROR_INITIAL {
            *report = Report {
                message: message.trim().to_string(),
                ..Report::default()
            };
        }
        report
            .traceback
            .push(format!("{function}() ({file}:{line})"));
    });
    code
}
