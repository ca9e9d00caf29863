//! What a person sees of a run: monitor, history table, fields, figures, summary and verdict.
//!
//! In: plain numbers the solver has already computed (records, samples, options as pairs). Out: files of one
//! output folder and lines of text. Never: mechanics, PETSc, or printing anywhere but to the writer it was given.
//!
//! Files on disk and the HDF5 series in particular must be closed before MPI is finalised: every writer here
//! closes its file when it is dropped, so drop them all before the MPI session ends.

mod agreement;
mod arrays;
mod atomic;
pub mod checkpoint;
pub mod diagnosis;
pub mod error;
pub mod fields;
pub mod folder;
mod hdf_collective;
pub mod history;
pub mod monitor;
mod number;
pub mod plot;
pub mod record;
pub mod report;
pub mod summary;
pub mod verdict;
pub mod vtkhdf;
mod vtkhdf_earlier;
mod vtkhdf_layout;
mod vtkhdf_steps;

pub(crate) use agreement::agree;
pub use arrays::Arrays;
pub use diagnosis::Diagnosis;
pub use error::OutputError;
pub use fields::{ContactFile, ContactSample, FieldSample, SheetFile, SheetPart, ToolsFile};
pub use folder::OutputDir;
pub use history::History;
pub use monitor::Monitor;
pub(crate) use number::number;
pub use record::StepRecord;
pub use report::Report;
pub use summary::Summary;
pub use verdict::{Comparison, Tolerance, Verdict, VerdictRow, VerdictTable};
