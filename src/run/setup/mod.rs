//! In: the options of the user. Out: PETSc's options and the linear solve this program chooses where the user does not,
//! the options that cannot work, that are known to harm, to do nothing or that nobody read, and the BLAS that is at work.
//! Never: a step of the run, or mechanics.

pub(super) mod blas;
pub(super) mod defaults;
pub(super) mod doubtful;
mod forbidden;
pub(super) mod given;
pub(super) mod help;
mod known;
pub(super) mod linear;
pub(super) mod unread;
pub use given::fate_of_petsc_option;
pub use unread::refuse_bad_options;

pub(super) use linear::LinearSolve;
