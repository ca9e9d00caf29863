//! The table of steps of a VTKHDF file: for each step its time, and where its data start.

use hdf5::{Attribute, Dataset, Group, H5Type};

use super::collective::RowWriter;
use super::datasets::{extend, extendable};
use super::types::ArraySpec;
use crate::output::space::BESIDE_VALUES;

/// Steps per chunk of the step table: small enough to waste nothing, large enough for a whole run in a few chunks.
const STEPS_PER_CHUNK: usize = 512;
/// Datasets of the table: times, where point data start, and what is the same in every step.
pub(super) const DATASETS: usize = 5;

/// `Steps`: for each step its time and where its data start. The mesh starts at 0 for every step.
///
/// What many arrays have in common is one dataset with a name for each of them (hard links), and what every step has in
/// common is a dataset that only grows: its fill value is what it holds.
pub(super) struct StepTable {
    times: Dataset,
    point_offsets: Option<Dataset>,
    constants: [Dataset; 3],
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
        let builder = || steps.new_dataset::<i64>();
        let parts = builder().chunk(STEPS_PER_CHUNK).fill_value(ranks as i64);
        let parts = parts.shape(0..).create("NumberOfParts")?;
        let zeros = builder().chunk(STEPS_PER_CHUNK).fill_value(0_i64);
        let zeros = zeros.shape(0..).create("PartOffsets")?;
        let zero_rows = builder().chunk((STEPS_PER_CHUNK, 1)).fill_value(0_i64);
        let zero_rows = zero_rows.shape((0.., 1)).create("CellOffsets")?;
        steps.link_hard("PartOffsets", "PointOffsets")?;
        steps.link_hard("CellOffsets", "ConnectivityIdOffsets")?;
        steps.create_group("CellDataOffsets")?;
        for name in cell_arrays {
            steps.link_hard("PartOffsets", &format!("CellDataOffsets/{name}"))?;
        }
        let offsets = steps.create_group("PointDataOffsets")?;
        let mut point_offsets = None;
        if let Some((first, others)) = point_arrays.split_first() {
            let offset = extendable::<i64>(&offsets, first.name, 1, STEPS_PER_CHUNK)?;
            point_offsets = Some(offset);
            for other in others {
                offsets.link_hard(first.name, other.name)?;
            }
        }
        let this = Self {
            times,
            point_offsets,
            constants: [parts, zeros, zero_rows],
        };
        Ok((this, count))
    }

    /// What it can grow by with step number `step` (counted from 0), bytes: its chunks are begun together.
    pub(super) fn growth(&self, step: usize) -> u64 {
        if step % STEPS_PER_CHUNK != 0 {
            return 0;
        }
        let chunk = STEPS_PER_CHUNK * size_of::<f64>();
        DATASETS as u64 * (chunk as u64 + BESIDE_VALUES)
    }

    /// Adds the row of step number `step` (counted from 0) whose point data start at row `first_row`. Collective;
    /// rank 0 writes. Every rank makes all calls, the first failure is returned.
    pub(super) fn append(
        &self,
        writer: &RowWriter,
        step: usize,
        t_ms: f64,
        first_row: i64,
        writes: bool,
    ) -> Result<(), String> {
        let mut results = vec![append_one(writer, &self.times, step, t_ms, writes)];
        let offsets = self.point_offsets.iter();
        results.extend(offsets.map(|offsets| append_one(writer, offsets, step, first_row, writes)));
        results.extend(
            self.constants
                .iter()
                .map(|dataset| extend(dataset, step + 1)),
        );
        results.into_iter().collect()
    }
}

fn append_one<T: H5Type>(
    writer: &RowWriter,
    dataset: &Dataset,
    step: usize,
    value: T,
    writes: bool,
) -> Result<(), String> {
    let extended = extend(dataset, step + 1);
    let written = writer.write(
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
