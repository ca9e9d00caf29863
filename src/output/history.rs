//! `history.csv`: one row per accepted step, on disk as soon as the step is.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::{OutputError, StepRecord};

/// Writer of the history table. It belongs to rank 0; the other ranks simply have none.
///
/// Each row reaches the operating system before [`History::append`] returns: a run killed at any moment leaves every
/// accepted step, and at worst nothing of the row being written.
pub struct History {
    path: PathBuf,
    table: csv::Writer<File>,
}

impl History {
    /// Starts a new table, replacing an old one of that name. The column names are those of [`StepRecord`].
    ///
    /// # Errors
    /// [`OutputError::Write`] if the file cannot be made.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let file = File::create(path).map_err(|error| OutputError::write(path, error))?;
        Ok(Self { path: path.into(), table: csv::Writer::from_writer(file) })
    }

    /// Continues the table of an earlier run: keeps its rows up to and including `last_t_ms` (ms) and appends after.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the old table is not one, [`OutputError::Write`] if it cannot be written.
    pub fn resume(path: impl AsRef<Path>, last_t_ms: f64) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let kept = read(path)?;
        // A step's end time may differ in the last digit after a restart: that is still the same step.
        let last = last_t_ms * (1.0 + 1e-12) + 1e-12;
        let mut text = csv::Writer::from_writer(Vec::new());
        for row in kept.iter().filter(|row| row.t_ms <= last) {
            text.serialize(row).map_err(|error| OutputError::write(path, error))?;
        }
        let empty = kept.iter().all(|row| row.t_ms > last);
        let bytes = text.into_inner().map_err(|error| OutputError::write(path, error))?;
        super::atomic::write(path, &bytes)?;
        let file = File::options().append(true).open(path).map_err(|error| OutputError::write(path, error))?;
        let table = csv::WriterBuilder::new().has_headers(empty).from_writer(file);
        Ok(Self { path: path.into(), table })
    }

    /// Adds one row and hands it to the operating system.
    ///
    /// # Errors
    /// [`OutputError::Write`], for example when the disk is full.
    pub fn append(&mut self, record: &StepRecord) -> Result<(), OutputError> {
        self.table.serialize(record).map_err(|error| OutputError::write(&self.path, error))?;
        self.table.flush().map_err(|error| OutputError::write(&self.path, error))
    }
}

/// Reads a history table back. A last row cut off by a kill is an error that names its line.
///
/// # Errors
/// [`OutputError::Read`] with the line where the table is not one.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<StepRecord>, OutputError> {
    let path = path.as_ref();
    let mut table = csv::Reader::from_path(path).map_err(|error| OutputError::read(path, error))?;
    table.deserialize().map(|row| row.map_err(|error| OutputError::read(path, error))).collect()
}
