//! The table of steps of a VTKHDF file: for each step its time, and where its data start.

use hdf5::{Attribute, Dataset, Group};

use super::datasets::{append_rows, extend, extendable};
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
    /// Makes the empty table and the counter of steps of a mesh with so many parts.
    pub(super) fn define(
        root: &Group,
        point_arrays: &[ArraySpec],
        cell_arrays: &[&str],
        parts: usize,
    ) -> hdf5::Result<(Self, Attribute)> {
        let steps = root.create_group("Steps")?;
        let count = steps.new_attr::<i64>().create("NSteps")?;
        count.write_scalar(&0_i64)?;
        let times = extendable::<f64>(&steps, "Values", 1, STEPS_PER_CHUNK)?;
        let builder = || steps.new_dataset::<i64>();
        let part_counts = builder().chunk(STEPS_PER_CHUNK).fill_value(parts as i64);
        let part_counts = part_counts.shape(0..).create("NumberOfParts")?;
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
            constants: [part_counts, zeros, zero_rows],
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

    /// Adds the row of step number `step` (counted from 0) whose point data start at row `first_row`.
    pub(super) fn append(&self, step: usize, t_ms: f64, first_row: usize) -> hdf5::Result<()> {
        append_rows(&self.times, step, &[t_ms])?;
        if let Some(offsets) = &self.point_offsets {
            append_rows(offsets, step, &[first_row as i64])?;
        }
        self.constants
            .iter()
            .try_for_each(|dataset| extend(dataset, step + 1))
    }
}
