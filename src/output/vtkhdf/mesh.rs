//! The mesh of a file: the parts of all ranks, one after the other.

use mpi::traits::Communicator;

use super::types::{CellType, Part};
use crate::ranks::gather_on_first;

/// The parts of all ranks, on rank 0. Connectivity and offsets of a part count from its own beginning, as VTKHDF wants them.
pub(super) struct Mesh {
    /// Points, cells and entries of the connectivity, of each part.
    pub(super) counts: [Vec<i64>; 3],
    /// Coordinates, mm: three for each point.
    pub(super) points: Vec<f64>,
    pub(super) connectivity: Vec<i64>,
    /// One more for each part than it has cells.
    pub(super) offsets: Vec<i64>,
    pub(super) cell_type: CellType,
}

impl Mesh {
    /// Gathers the parts on rank 0; the other ranks get nothing. Collective.
    pub(super) fn gather(comm: &impl Communicator, part: &Part) -> Option<Self> {
        let lengths = [part.points.len(), part.cells(), part.connectivity.len()];
        let [points, cells, entries] =
            lengths.map(|length| gather_on_first(comm, &[length as i64]));
        let coordinates = gather_on_first(comm, part.points.as_flattened());
        let connectivity = gather_on_first(comm, &part.connectivity);
        let offsets = gather_on_first(comm, &part.offsets);
        Some(Self {
            counts: [points?, cells?, entries?],
            points: coordinates?,
            connectivity: connectivity?,
            offsets: offsets?,
            cell_type: part.cell_type,
        })
    }

    /// Number of parts, one of each rank.
    pub(super) fn parts(&self) -> usize {
        self.counts[0].len()
    }

    pub(super) fn point_count(&self) -> usize {
        self.points.len() / 3
    }

    pub(super) fn cell_count(&self) -> usize {
        self.offsets.len() - self.parts()
    }
}
