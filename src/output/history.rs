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
        Ok(Self {
            path: path.into(),
            table: csv::Writer::from_writer(file),
        })
    }

    /// Continues the table of an earlier run: keeps its rows up to and including `last_t_ms` (ms) and appends after.
    /// What a kill cut off after that time does no harm.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the old table does not reach `last_t_ms`, [`OutputError::Write`] if it cannot be
    /// written.
    pub fn resume(path: impl AsRef<Path>, last_t_ms: f64) -> Result<Self, OutputError> {
        let path = path.as_ref();
        // A time read back from text or a checkpoint may differ in the last digit: that is still the same step.
        let rounding = 1e-9 * last_t_ms.abs();
        let mut kept = Vec::new();
        let mut old =
            csv::Reader::from_path(path).map_err(|error| OutputError::read(path, error))?;
        for row in old.deserialize::<StepRecord>() {
            match row {
                Ok(row) if row.t_ms <= last_t_ms + rounding => kept.push(row),
                Ok(_) => break,
                Err(error)
                    if kept
                        .last()
                        .is_none_or(|row| row.t_ms < last_t_ms - rounding) =>
                {
                    return Err(OutputError::read(path, error));
                }
                Err(_) => break,
            }
        }
        if kept
            .last()
            .is_none_or(|row| row.t_ms < last_t_ms - rounding)
        {
            return Err(OutputError::read(
                path,
                format!("it has no row for t = {last_t_ms} ms, the time to go on from"),
            ));
        }
        let mut table = csv::Writer::from_writer(Vec::new());
        for row in &kept {
            table
                .serialize(row)
                .map_err(|error| OutputError::write(path, error))?;
        }
        let bytes = table
            .into_inner()
            .map_err(|error| OutputError::write(path, error))?;
        super::atomic::write(path, &bytes)?;
        let file = File::options()
            .append(true)
            .open(path)
            .map_err(|error| OutputError::write(path, error))?;
        Ok(Self {
            path: path.into(),
            table: csv::WriterBuilder::new()
                .has_headers(false)
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
    use std::fs;

    use super::*;

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
    fn the_columns_are_those_people_were_promised() {
        let path = scratch("columns");
        History::create(&path)
            .unwrap()
            .append(&record(1.0))
            .unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(
            text.lines().next().unwrap(),
            "t_ms,stroke_mm,force_N,dy_A_punch_mm,dy_A_sheet_mm,gap_A_mm,angle_deg,dt_ms,newton_iterations,\
             active_points,max_penetration_mm,min_contact_force_N,kinetic_energy_mJ,strain_energy_mJ,\
             plastic_dissipation_mJ,contact_energy_mJ,external_work_mJ,energy_error,die_force_N,inertia_N,\
             balance_error,cone_violation,angle_fit_residual_mm,residual_norm_mm,refused_solves,\
             max_complementarity_mJ"
        );
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_resumed_table_goes_on_after_the_checkpoint_even_if_the_last_row_was_cut() {
        let path = scratch("resume");
        let mut history = History::create(&path).unwrap();
        (1..=5).for_each(|step| history.append(&record(f64::from(step))).unwrap());
        drop(history);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, &text[..text.len() - 40]).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("line: 6"));
        assert!(History::resume(&path, 5.0).is_err());
        let mut history = History::resume(&path, 3.0).unwrap();
        history.append(&record(3.5)).unwrap();
        let times: Vec<f64> = read(&path).unwrap().iter().map(|row| row.t_ms).collect();
        assert_eq!(times, [1.0, 2.0, 3.0, 3.5]);
        fs::remove_file(path).unwrap();
    }
}
