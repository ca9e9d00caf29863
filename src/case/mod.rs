//! In: what a person says, as options by name (command line, option file) and the tables they point to.
//! Out: a checked [`Case`], help and documentation of every option, and errors of one sentence each.
//! Never: PETSc, MPI, printing; a case that is handed out can be built and run.
//!
//! An option of ours is declared once, in `table.rs`; help, documentation, checks and errors follow from there.

mod arguments;
mod columns;
mod error;
mod geometry;
mod hardening;
mod help;
mod inverse;
mod kind;
mod kind_paths;
mod kind_resuming;
mod measured;
mod model;
mod option;
mod option_file;
mod provenance;
mod read;
mod reference;
mod reference_force;
mod reference_regression;
mod sensitivity;
mod table;
mod tool_check;
mod tool_file;
mod tools;
mod unused;

pub use arguments::{
    ENVIRONMENT, arguments_as_text, check_arguments, check_environment, check_options_file,
};
pub use error::{CaseError, Warning};
pub use geometry::check_ranks;
pub use help::{help_text, options_markdown};
pub use inverse::Sought;
pub use measured::{MeasuredPoint, read_measured};
pub use model::{
    Case, Discretisation, Dynamics, Friction, Inverse, Loading, Material, Output, Restart,
    Resuming, Sheet, Stepping, Tools,
};
pub use option::OptionSource;
pub use provenance::Difference;
pub use reference::{Instant, Origin, ReferenceValue, Tolerance};
pub use reference_force::ReferenceForce;
pub use sensitivity::Parameter;
pub use tool_check::LeastGap;
pub use tool_file::ToolFile;
pub use unused::check_unused;
pub(crate) use unused::{condensed_option, is_own};
