//! The table of steps of a VTKHDF file: for each step its time, and where its data start.

use hdf5::plist::dataset_create::FillTime;
use hdf5::{Attribute, Dataset, Group, H5Type};

use super::collective::write_rows;
use super::datasets::{extend, extendable};
use super::types::ArraySpec;
use crate::output::space::BESIDE_VALUES;

/// Steps per chunk of the step table: small enough to waste nothing, large enough for a whole run in a few chunks.
const STEPS_PER_CHUNK: usize = 512;
/// Datasets of the table besides one for each array: times, numbers of parts, and where parts, points, cells and
/// connectivity start.
pub(super) const OF_ALL_ARRAYS: usize = 6;

/// `Steps`: for each step its time and where its data start. The mesh starts at 0 for every step.
pub(super) struct StepTable {
    times: Dataset,
    zeros: Vec<Dataset>,
    parts: Dataset,
    point_offsets: Vec<Dataset>,
    ranks: usize,
}

impl StepTable {
    /// Makes the empty table and the counter of steps. Collective.
    pub(super) fn define(
        root: &Group,
        point_arrays: &[ArraySpec],
        cell_arrays: &[&str],
        ranks: usize,
    ) -> hdf5::Result<(Self, Attribute)> {
        let steps = root.create_group("Steps")?;
        let count = steps.new_attr::<i64>().create("NSteps")?;
        count.write_scalar(&0_i64)?;
        let times = extendable::<f64>(&steps, "Values", 1, STEPS_PER_CHUNK)?;
        let parts = extendable::<i64>(&steps, "NumberOfParts", 1, STEPS_PER_CHUNK)?;
        let mut zeros = Vec::new();
        for name in ["PartOffsets", "PointOffsets"] {
            zeros.push(extendable::<i64>(&steps, name, 1, STEPS_PER_CHUNK)?);
        }
        for name in ["CellOffsets", "ConnectivityIdOffsets"] {
            let builder = steps.new_dataset::<i64>().chunk((STEPS_PER_CHUNK, 1));
            zeros.push(
                builder
                    .fill_time(FillTime::Never)
                    .shape((0.., 1))
                    .create(name)?,
            );
        }
        let cell_offsets = steps.create_group("CellDataOffsets")?;
        for name in cell_arrays {
            zeros.push(extendable::<i64>(&cell_offsets, name, 1, STEPS_PER_CHUNK)?);
        }
        let offsets = steps.create_group("PointDataOffsets")?;
        let point_offsets = point_arrays
            .iter()
            .map(|spec| extendable::<i64>(&offsets, spec.name, 1, STEPS_PER_CHUNK));
        let point_offsets = point_offsets.collect::<hdf5::Result<_>>()?;
        Ok((
            Self {
                times,
                zeros,
                parts,
                point_offsets,
                ranks,
            },
            count,
        ))
    }

    /// What it can grow by with step number `step` (counted from 0), bytes: its chunks are begun together.
    pub(super) fn growth(&self, step: usize) -> u64 {
        if step % STEPS_PER_CHUNK != 0 {
            return 0;
        }
        let datasets = 2 + self.zeros.len() + self.point_offsets.len();
        let chunk = STEPS_PER_CHUNK * size_of::<f64>();
        datasets as u64 * (chunk as u64 + BESIDE_VALUES)
    }

    /// Adds the row of step number `step` (counted from 0) whose point data start at row `first_row`. Collective;
    /// rank 0 writes. Every rank makes all calls, the first failure is returned.
    pub(super) fn append(
        &self,
        step: usize,
        t_ms: f64,
        first_row: i64,
        writes: bool,
    ) -> Result<(), String> {
        let mut results = vec![append_one(&self.times, step, t_ms, writes)];
        results.push(append_one(&self.parts, step, self.ranks as i64, writes));
        results.extend(
            self.zeros
                .iter()
                .map(|dataset| append_one(dataset, step, 0_i64, writes)),
        );
        results.extend(
            self.point_offsets
                .iter()
                .map(|dataset| append_one(dataset, step, first_row, writes)),
        );
        results.into_iter().collect()
    }
}

fn append_one<T: H5Type>(
    dataset: &Dataset,
    step: usize,
    value: T,
    writes: bool,
) -> Result<(), String> {
    let extended = extend(dataset, step + 1);
    let written = write_rows(
        dataset,
        step,
        if writes {
            std::slice::from_ref(&value)
        } else {
            &[]
        },
    );
    extended.and(written)
}
