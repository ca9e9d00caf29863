//! `-compare`: lays two runs side by side, and stops.

use std::io::stdout;
use std::path::Path;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::error::RunError;
use super::setup::refuse_bad_options;
use crate::case::Case;
use crate::output::{Monitor, OutputDir, TwoRuns, agree};

/// Writes the page about two runs, and shows their main numbers. Collective.
///
/// # Errors
/// If an option is refused, a folder holds no run, or the page cannot be written; the same on every rank.
pub fn compare(
    case: &Case,
    [one, other]: &[String; 2],
    comm: &SimpleCommunicator,
) -> Result<(), RunError> {
    refuse_bad_options(case, comm)?;
    let read = match comm.rank() {
        0 => TwoRuns::read([Path::new(one), Path::new(other)]).map(Some),
        _ => Ok(None),
    };
    let comparison = agree(comm, read)?;
    let folder = OutputDir::create(&case.output.dir, comm)?;
    let path = folder.comparison();
    let written = comparison.as_ref().map_or(Ok(()), |it| it.write(&path));
    agree(comm, written)?;
    if let Some(comparison) = comparison {
        let text = format!("{}\npage      {}\n", comparison.text(), path.display());
        Monitor::new(comm.rank(), stdout(), case.loading.motion()).show(&text);
    }
    Ok(())
}
