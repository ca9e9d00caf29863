//! The table and the figure of the derivatives.

use std::path::Path;

use mpi::traits::Communicator;

use super::Recorder;
use crate::case::Case;
use crate::output::derivatives::{self, DerivativeFile, DerivativeRow, DerivativeTable};
use crate::output::folder::SENSITIVITY;
use crate::output::{OutputError, StepRecord, agree, plot};
use crate::run::checkpoint::Resumed;
use crate::sensitivity::StepSlopes;

impl Recorder {
    /// Opens the table if the case asks for derivatives. Collective.
    pub(super) fn open_derivatives(
        &mut self,
        case: &Case,
        resumed: Option<&Resumed>,
        comm: &impl Communicator,
    ) -> Result<(), OutputError> {
        // A case that is handed out has parameters that can be used.
        let parameters = case.parameters().unwrap_or_default();
        if parameters.is_empty() {
            return Ok(());
        }
        self.derivatives = DerivativeTable::new(parameters);
        let rows = resumed.map(|earlier| earlier.path.join(SENSITIVITY));
        let mine = match comm.rank() {
            0 => DerivativeFile::create(
                self.folder.sensitivity(),
                &self.derivatives.header(),
                rows.as_deref(),
            )
            .map(Some),
            _ => Ok(None),
        };
        self.derivative_file = agree(comm, mine)?;
        if let Some(rows) = rows {
            let count = self.derivatives.parameters.len();
            self.derivatives.rows = agree(comm, derivatives::read(&rows, count))?;
        }
        Ok(())
    }

    /// Puts the table so far into the folder of a checkpoint, if there is one.
    pub(super) fn copy_derivatives(&self, to: &Path) -> Result<(), OutputError> {
        if self.derivative_file.is_none() {
            return Ok(());
        }
        let path = to.join(SENSITIVITY);
        let copied = std::fs::copy(self.folder.sensitivity(), &path);
        copied.map_or_else(|error| Err(OutputError::write(&path, error)), |_| Ok(()))
    }

    /// Takes the derivatives of an accepted step. Collective.
    ///
    /// # Errors
    /// If the table cannot be written; the same on every rank.
    pub fn derivatives_of_step(
        &mut self,
        record: &StepRecord,
        slopes: StepSlopes,
        comm: &impl Communicator,
    ) -> Result<(), OutputError> {
        let row = DerivativeRow {
            t_ms: record.t_ms,
            stroke_mm: record.stroke_mm,
            force_N: record.force_N,
            angle_deg: record.angle_deg,
            dy_A_sheet_mm: record.dy_A_sheet_mm,
            changed_points: slopes.changed_points,
            doubtful_points: slopes.doubtful_points,
            by_parameter: slopes.by_parameter,
        };
        let mine = match &mut self.derivative_file {
            Some(file) => file.append(&row),
            None => Ok(()),
        };
        self.derivatives.rows.push(row);
        agree(comm, mine)
    }

    /// The derivatives so far, the same on every rank.
    pub fn derivatives(&self) -> &DerivativeTable {
        &self.derivatives
    }

    /// Draws which parameter moves the force where, on rank 0 of a run with derivatives.
    ///
    /// # Errors
    /// If the figure cannot be written.
    pub fn derivative_figure(&self) -> Result<(), OutputError> {
        if self.derivative_file.is_none() || self.derivatives.rows.is_empty() {
            return Ok(());
        }
        plot::sensitivity(self.folder.sensitivity_figure(), &self.derivatives)
    }
}
