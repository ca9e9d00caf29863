//! `history.csv`: one row per accepted step, on disk as soon as the step is.

use std::fs::{self, File};
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
        Ok(Self {
            path: path.into(),
            table: csv::Writer::from_writer(file),
        })
    }

    /// Continues the table of an earlier run: its rows so far are those of the file `rows`, which is left alone.
    ///
    /// # Errors
    /// [`OutputError::Read`] if there is no such file, [`OutputError::Write`] if the table cannot be written.
    pub fn resume(path: impl AsRef<Path>, rows: &Path) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let bytes = fs::read(rows).map_err(|error| OutputError::read(rows, error))?;
        super::atomic::write(path, &bytes)?;
        let file = File::options()
            .append(true)
            .open(path)
            .map_err(|error| OutputError::write(path, error))?;
        Ok(Self {
            path: path.into(),
            table: csv::WriterBuilder::new()
                .has_headers(bytes.is_empty())
                .from_writer(file),
        })
    }

    /// Adds one row and hands it to the operating system.
    ///
    /// # Errors
    /// [`OutputError::Write`], for example when the disk is full.
    pub fn append(&mut self, record: &StepRecord) -> Result<(), OutputError> {
        self.table
            .serialize(record)
            .map_err(|error| OutputError::write(&self.path, error))?;
        self.table
            .flush()
            .map_err(|error| OutputError::write(&self.path, error))
    }
}

/// Reads a history table back. A last row cut off by a kill is an error that names its line.
///
/// # Errors
/// [`OutputError::Read`] with the line where the table is not one.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<StepRecord>, OutputError> {
    let path = path.as_ref();
    let mut table = csv::Reader::from_path(path).map_err(|error| OutputError::read(path, error))?;
    table
        .deserialize()
        .map(|row| row.map_err(|error| OutputError::read(path, error)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::record::COLUMNS;

    fn record(t_ms: f64) -> StepRecord {
        StepRecord {
            t_ms,
            force_N: 151.5 + t_ms,
            gap_A_mm: f64::NAN,
            newton_iterations: 4,
            ..StepRecord::default()
        }
    }

    fn scratch(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("ssnp155-history-{name}-{}.csv", std::process::id()))
    }

    #[test]
    fn every_row_is_on_disk_when_append_returns() {
        let path = scratch("rows");
        let mut history = History::create(&path).unwrap();
        for step in 1..=3 {
            history.append(&record(f64::from(step))).unwrap();
            let rows = read(&path).unwrap();
            assert_eq!(rows.len(), step as usize);
            assert_eq!(rows[rows.len() - 1].force_N, 151.5 + f64::from(step));
            assert!(rows[0].gap_A_mm.is_nan());
        }
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn the_header_names_all_columns() {
        let path = scratch("columns");
        History::create(&path)
            .unwrap()
            .append(&record(1.0))
            .unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
        assert_eq!(text.lines().next().unwrap(), names.join(","));
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_resumed_table_goes_on_after_the_rows_it_is_given() {
        let (path, rows) = (scratch("resume"), scratch("rows-so-far"));
        let mut history = History::create(&path).unwrap();
        (1..=3).for_each(|step| history.append(&record(f64::from(step))).unwrap());
        fs::copy(&path, &rows).unwrap();
        (4..=5).for_each(|step| history.append(&record(f64::from(step))).unwrap());
        drop(history);
        let unbroken = fs::read_to_string(&path).unwrap();
        // A kill cut the last row off.
        fs::write(&path, &unbroken[..unbroken.len() - 40]).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("line: 6"));
        let mut history = History::resume(&path, &rows).unwrap();
        (4..=5).for_each(|step| history.append(&record(f64::from(step))).unwrap());
        assert_eq!(fs::read_to_string(&path).unwrap(), unbroken);
        fs::remove_file(path).unwrap();
        fs::remove_file(rows).unwrap();
    }
}
