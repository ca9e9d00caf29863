//! The file of a series while it is written: one part of the mesh per rank, step after step.

use std::path::{Path, PathBuf};

use hdf5::{Attribute, Dataset, File};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::collective::RowWriter;
use super::datasets::{extend, write_values};
use super::earlier::{Column, EarlierSteps};
use super::layout::Layout;
use super::steps::StepTable;
use super::types::{ArraySpec, Part, Values};
use crate::output::error::{OutputError, agree};
use crate::output::space::{self, BESIDE_VALUES};

/// The file being written. Dropping it closes the file on all ranks together: do that before MPI is finalised.
pub(super) struct TimeSeries {
    path: PathBuf,
    comm: SimpleCommunicator,
    steps: usize,
    point_specs: Vec<ArraySpec>,
    point_arrays: Vec<Dataset>,
    local_points: usize,
    first_point: usize,
    total_points: usize,
    table: StepTable,
    count: Attribute,
    writer: RowWriter,
    // Last, so that everything in the file is released before the file itself.
    file: File,
}

impl TimeSeries {
    /// Starts a new file with the mesh and the cell arrays, and no step yet. Collective over `comm`; all ranks return
    /// the same result. Ranks without points or cells hand over an empty part.
    ///
    /// # Errors
    /// [`OutputError::Mismatch`] if the part contradicts itself, [`OutputError::NoSpace`] if the disk is full,
    /// [`OutputError::Hdf5`] if the file cannot be written.
    pub fn create(
        path: impl AsRef<Path>,
        comm: &impl Communicator,
        part: &Part,
        point_arrays: &[ArraySpec],
        cell_arrays: &[(ArraySpec, Values)],
    ) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let checked = cell_arrays
            .iter()
            .try_for_each(|(spec, values)| values.check(spec, part.cells()));
        agree(
            comm,
            part.check()
                .and(checked)
                .map_err(|reason| OutputError::mismatch(path, reason)),
        )?;
        let comm = comm.duplicate();
        let layout = Layout::new(&comm, part);
        let bytes = layout.mesh_bytes(point_arrays, cell_arrays);
        let begun = match comm.rank() {
            0 => begin(path, bytes),
            _ => Ok(()),
        };
        agree(&comm, begun)?;
        let opened = RowWriter::open(path, &comm);
        let (file, writer) = agree(
            &comm,
            opened.map_err(|error| OutputError::hdf5(path, "opening it on all ranks", error)),
        )?;
        let failed = |error| OutputError::hdf5(path, "writing the mesh", error);
        let made = layout
            .define(&file, point_arrays, cell_arrays)
            .map_err(|error| failed(error.to_string()));
        let (point_datasets, table, count) = agree(&comm, made)?;
        let written = layout
            .write_mesh(&file, &writer, part, cell_arrays)
            .map_err(failed);
        agree(
            &comm,
            written.and(file.flush().map_err(|error| failed(error.to_string()))),
        )?;
        Ok(Self {
            path: path.into(),
            steps: 0,
            point_specs: point_arrays.to_vec(),
            point_arrays: point_datasets,
            local_points: part.points.len(),
            first_point: layout.first_point,
            total_points: layout.total_points,
            table,
            count,
            writer,
            file,
            comm,
        })
    }

    /// Adds one step at `t_ms` with the values of all point arrays, in the order of their specifications. When it
    /// returns, the step is in the file. Collective; all ranks return the same result.
    ///
    /// # Errors
    /// [`OutputError::Mismatch`] if the values do not fit, [`OutputError::NoSpace`] if the disk is full: then nothing has
    /// been written of the step. [`OutputError::Hdf5`] if they cannot be written.
    pub fn append(&mut self, t_ms: f64, values: &[Values]) -> Result<(), OutputError> {
        let fits = if values.len() == self.point_specs.len() {
            values
                .iter()
                .zip(&self.point_specs)
                .try_for_each(|(values, spec)| values.check(spec, self.local_points))
        } else {
            Err(format!(
                "{} arrays given, {} expected",
                values.len(),
                self.point_specs.len()
            ))
        };
        agree(
            &self.comm,
            fits.map_err(|reason| OutputError::mismatch(&self.path, reason)),
        )?;
        let room = match self.comm.rank() {
            0 => space::reserve_behind(&self.path, self.step_bytes()),
            _ => Ok(()),
        };
        agree(&self.comm, room)?;
        let written = self.append_everywhere(t_ms, values);
        let failed = |reason| {
            OutputError::hdf5(
                &self.path,
                format!("writing the step at t = {t_ms} ms"),
                reason,
            )
        };
        agree(&self.comm, written.map_err(failed))?;
        self.steps += 1;
        Ok(())
    }

    /// What the file can grow by with the next step.
    fn step_bytes(&self) -> u64 {
        let of_a_point = self.point_specs.iter().map(ArraySpec::bytes).sum::<usize>();
        let beside = BESIDE_VALUES * self.point_specs.len() as u64;
        (self.total_points * of_a_point) as u64 + beside + self.table.growth(self.steps)
    }

    /// Repeats the steps of a closed file with the same arrays, in which row `rows[i]` of every step is this rank's
    /// point i. The number of ranks may have been another one. Collective; all ranks return the same result.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the file is another one, or as [`TimeSeries::append`].
    pub fn replay(&mut self, from: &Path, rows: &[usize]) -> Result<(), OutputError> {
        let failed = |reason| OutputError::read(from, reason);
        let opened = EarlierSteps::open(from, &self.point_specs);
        let mut earlier = agree(&self.comm, opened.map_err(failed))?;
        for step in 0..earlier.times.len() {
            let read = earlier.read(step, rows);
            let columns = agree(&self.comm, read.map_err(failed))?;
            let values: Vec<Values> = columns.iter().map(Column::values).collect();
            self.append(earlier.times[step], &values)?;
        }
        Ok(())
    }

    /// The same collective calls on every rank, also after a failure: a rank that left early would leave the others
    /// waiting for ever. The first failure is kept.
    fn append_everywhere(&self, t_ms: f64, values: &[Values]) -> Result<(), String> {
        let first_row = self.steps * self.total_points;
        let mut first_failure = Ok(());
        let mut keep = |result: Result<(), String>| {
            if first_failure.is_ok() {
                first_failure = result;
            }
        };
        for (dataset, values) in self.point_arrays.iter().zip(values) {
            keep(extend(dataset, first_row + self.total_points));
            keep(write_values(
                &self.writer,
                dataset,
                first_row + self.first_point,
                values,
            ));
        }
        keep(self.table.append(
            &self.writer,
            self.steps,
            t_ms,
            first_row as i64,
            self.comm.rank() == 0,
        ));
        keep(self.file.flush().map_err(|error| error.to_string()));
        keep(
            self.count
                .write_scalar(&(self.steps as i64 + 1))
                .map_err(|error| error.to_string()),
        );
        keep(self.file.flush().map_err(|error| error.to_string()));
        first_failure
    }
}

/// Makes an empty file, with room for `bytes`, for all ranks to open. On one rank.
fn begin(path: &Path, bytes: u64) -> Result<(), OutputError> {
    let failed = |error| OutputError::hdf5(path, "creating it", error);
    let file = File::create(path).map_err(failed)?;
    space::reserve_behind(path, bytes)?;
    // This cuts the file to its size, and the reservation off.
    file.close().map_err(failed)?;
    space::reserve_behind(path, bytes)
}
