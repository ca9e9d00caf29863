//! The file of a series while it is written: one part of the mesh per rank, step after step.
//!
//! Rank 0 has the file, and the others send it their rows. A file of MPI-IO would be brought to the disk at every flush, and the
//! values of a step are few: with two ranks that waiting was a third of the benchmark.

use std::path::{Path, PathBuf};

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::earlier::EarlierSteps;
use super::file::GrowingFile;
use super::mesh::Mesh;
use super::types::{ArraySpec, Column, Part, Values};
use crate::output::error::{OutputError, agree};

/// The file being written. Dropping it closes the file.
pub(super) struct TimeSeries {
    path: PathBuf,
    comm: SimpleCommunicator,
    point_arrays: Vec<ArraySpec>,
    local_points: usize,
    /// On rank 0.
    file: Option<GrowingFile>,
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
        let checked = part.check().and(checked);
        agree(
            comm,
            checked.map_err(|reason| OutputError::mismatch(path, reason)),
        )?;
        let comm = comm.duplicate();
        let mesh = Mesh::gather(&comm, part);
        // Every array, also on a rank where nothing arrives: one that stopped at the first would leave rank 0 waiting.
        let cells: Vec<Option<(ArraySpec, Column)>> = cell_arrays
            .iter()
            .map(|(spec, values)| Some((*spec, values.gather(&comm)?)))
            .collect();
        let cells: Option<Vec<(ArraySpec, Column)>> = cells.into_iter().collect();
        let created = mesh
            .zip(cells)
            .map(|(mesh, cells)| GrowingFile::create(path, &mesh, point_arrays, &cells));
        Ok(Self {
            path: path.into(),
            point_arrays: point_arrays.to_vec(),
            local_points: part.points.len(),
            file: agree(&comm, created.transpose())?,
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
        let room = || self.file.as_ref().map_or(Ok(()), GrowingFile::reserve_step);
        agree(&self.comm, self.check(values).and_then(|()| room()))?;
        let mut written = Ok(());
        for (array, values) in values.iter().enumerate() {
            let column = values.gather(&self.comm);
            // After a failure, too, the others send what they have.
            if let (Some(file), Some(column), Ok(())) = (&self.file, column, &written) {
                written = file.write(array, &column);
            }
        }
        if let Some(file) = &mut self.file {
            written = written.and_then(|()| file.end_step(t_ms));
        }
        let failed = |error| {
            let doing = format!("writing the step at t = {t_ms} ms");
            OutputError::hdf5(&self.path, doing, error)
        };
        agree(&self.comm, written.map_err(failed))
    }

    fn check(&self, values: &[Values]) -> Result<(), OutputError> {
        let fits = if values.len() == self.point_arrays.len() {
            let mut pairs = values.iter().zip(&self.point_arrays);
            pairs.try_for_each(|(values, spec)| values.check(spec, self.local_points))
        } else {
            Err(format!(
                "{} arrays given, {} expected",
                values.len(),
                self.point_arrays.len()
            ))
        };
        fits.map_err(|reason| OutputError::mismatch(&self.path, reason))
    }

    /// Repeats the steps of a closed file with the same arrays, in which row `rows[i]` of every step is this rank's
    /// point i. The number of ranks may have been another one. Collective; all ranks return the same result.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the file is another one, or as [`TimeSeries::append`].
    pub fn replay(&mut self, from: &Path, rows: &[usize]) -> Result<(), OutputError> {
        let failed = |reason| OutputError::read(from, reason);
        let opened = EarlierSteps::open(from, &self.point_arrays);
        let mut earlier = agree(&self.comm, opened.map_err(failed))?;
        for step in 0..earlier.times.len() {
            let read = earlier.read(step, rows);
            let columns = agree(&self.comm, read.map_err(failed))?;
            let values: Vec<Values> = columns.iter().map(Column::values).collect();
            self.append(earlier.times[step], &values)?;
        }
        Ok(())
    }
}
