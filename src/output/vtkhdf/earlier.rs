//! Reads the steps of a VTKHDF file that this program wrote, each rank by itself.

use std::path::Path;

use hdf5::{Dataset, File, H5Type};

use super::types::{ArraySpec, Column, Kind};

/// The steps of a closed file.
pub(super) struct EarlierSteps {
    /// Times of the steps, ms.
    pub(super) times: Vec<f64>,
    arrays: Vec<(ArraySpec, Dataset)>,
    /// Rows of one step.
    points: usize,
    // Last, so that everything in the file is released before the file itself.
    _file: File,
}

impl EarlierSteps {
    pub(super) fn open(path: &Path, specs: &[ArraySpec]) -> Result<Self, String> {
        let open = || -> hdf5::Result<Self> {
            let file = File::open(path)?;
            let root = file.group("VTKHDF")?;
            let steps = root.group("Steps")?;
            let count: i64 = steps.attr("NSteps")?.read_scalar()?;
            let mut times = steps.dataset("Values")?.read_raw::<f64>()?;
            times.truncate(usize::try_from(count).unwrap_or(0));
            let arrays = specs
                .iter()
                .map(|spec| Ok((*spec, root.dataset(&format!("PointData/{}", spec.name))?)))
                .collect::<hdf5::Result<_>>()?;
            let points = root.dataset("Points")?.shape()[0];
            Ok(Self {
                times,
                arrays,
                points,
                _file: file,
            })
        };
        let this = open().map_err(|error| error.to_string())?;
        let rows = this.times.len() * this.points;
        match this.arrays.iter().find(|(_, a)| a.shape()[0] < rows) {
            Some((spec, _)) => Err(format!("array {} has fewer than {rows} rows", spec.name)),
            None => Ok(this),
        }
    }

    /// The values at `rows` of a step, for all arrays.
    pub(super) fn read(&mut self, step: usize, rows: &[usize]) -> Result<Vec<Column>, String> {
        let first = step * self.points;
        let range = first..first + self.points;
        if let Some(row) = rows.iter().find(|&&row| row >= self.points) {
            return Err(format!(
                "it has {} points, and point {row} is wanted",
                self.points
            ));
        }
        let column = |(spec, dataset): &(ArraySpec, Dataset)| match spec.kind {
            Kind::F64 => Ok(Column::F64(pick(
                dataset,
                range.clone(),
                spec.components,
                rows,
            )?)),
            Kind::I32 => Ok(Column::I32(pick(
                dataset,
                range.clone(),
                spec.components,
                rows,
            )?)),
        };
        let columns: hdf5::Result<_> = self.arrays.iter().map(column).collect();
        columns.map_err(|error| error.to_string())
    }
}

fn pick<T: H5Type + Copy>(
    dataset: &Dataset,
    range: std::ops::Range<usize>,
    components: usize,
    rows: &[usize],
) -> hdf5::Result<Vec<T>> {
    let all: Vec<T> = if components == 1 {
        dataset.read_slice_1d::<T, _>(range)?.into_iter().collect()
    } else {
        dataset
            .read_slice_2d::<T, _>((range, ..))?
            .into_iter()
            .collect()
    };
    let row = |&row: &usize| &all[components * row..components * (row + 1)];
    Ok(rows.iter().flat_map(row).copied().collect())
}
