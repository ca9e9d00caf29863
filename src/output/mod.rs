//! What a person sees of a run: monitor, history table, fields, figures, summary and verdict.
//!
//! In: plain numbers the solver has already computed (records, samples, options as pairs). Out: files of one
//! output folder and lines of text. Never: mechanics, PETSc, or printing anywhere but to the writer it was given.
//!
//! Files on disk and the HDF5 series in particular must be closed before MPI is finalised: every writer here
//! closes its file when it is dropped, so drop them all before the MPI session ends.

mod arrays;
mod atomic;
pub mod banner;
pub mod checkpoint;
pub mod comparison;
pub mod derivatives;
pub mod error;
pub mod folder;
pub mod history;
mod lock;
pub mod monitor;
pub mod plot;
mod previous;
pub mod record;
pub mod report;
mod space;
pub mod summary;
pub mod verdict;
pub mod vtkhdf;

pub use arrays::Arrays;
pub(crate) use atomic::write_json;
pub use comparison::TwoRuns;
pub use derivatives::{DerivativeFile, DerivativeRow, DerivativeTable};
pub use error::OutputError;
pub(crate) use error::agree;
pub use folder::OutputDir;
pub use history::History;
pub use monitor::Monitor;
pub use record::StepRecord;
pub use report::Report;
pub use summary::{Diagnosis, Summary};
pub use verdict::{Comparison, Tolerance, Verdict, VerdictRow, VerdictTable};
pub use vtkhdf::{ContactFile, SheetFile, SheetPart, ToolsFile};
