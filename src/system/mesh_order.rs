//! Unknowns and histories in the order of the mesh, which no partition changes.
//!
//! In mesh order the unknowns are x and y of node after node, then multiplier and gap of contact point after contact
//! point, edge by edge along the surface.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Root};
use petsc::{Vector, VectorRef};

use super::System;
use super::error::{MeshOrderError, WrongSize};
use super::numbering::UNKNOWNS_PER_POINT;
use crate::ranks::gather_lists;

/// Mesh numbers of what a rank holds.
pub(super) struct MeshOrder {
    /// Of each row this rank owns, its place among the unknowns in mesh order.
    unknowns: Vec<usize>,
    /// Of each contact point of this rank, its number along the surface.
    pub contact_points: Vec<usize>,
    pub contact_point_count: usize,
}

impl MeshOrder {
    pub fn of(system: &System) -> Self {
        let (local, rank) = (system.local(), system.comm().rank() as usize);
        let mesh = &local.problem.mesh;
        let (mut contact_points, mut count) = (Vec::new(), 0);
        for (index, edge) in mesh.surface.iter().enumerate() {
            if local.problem.tool(edge.side).is_none() {
                continue;
            }
            let samples = local.problem.contact_samples(index).len();
            if system.partition()[edge.element] == rank {
                contact_points.extend(count..count + samples);
            }
            count += samples;
        }
        let owned = (0..local.nodes.len()).filter(|&n| local.owned[n]);
        let mut unknowns: Vec<usize> = owned
            .map(|n| 2 * local.nodes[n])
            .flat_map(|x| [x, x + 1])
            .collect();
        let first = 2 * mesh.nodes.len();
        unknowns.extend(
            contact_points
                .iter()
                .map(|point| first + UNKNOWNS_PER_POINT * point)
                .flat_map(|row| [row, row + 1]),
        );
        Self {
            unknowns,
            contact_points,
            contact_point_count: count,
        }
    }
}

/// Blocks of `size` numbers at the places of `numbers` among `count`; complete on rank 0, empty elsewhere.
/// The bits travel as they are: a sum would lose the sign of zero. Collective.
pub(super) fn gather_blocks(
    comm: &SimpleCommunicator,
    numbers: &[usize],
    size: usize,
    values: &[f64],
    count: usize,
) -> Vec<f64> {
    let mut mine = vec![0_u64; size * count];
    for (block, &number) in values.chunks_exact(size).zip(numbers) {
        for (bits, value) in mine[size * number..].iter_mut().zip(block) {
            *bits = value.to_bits();
        }
    }
    let root = comm.process_at_rank(0);
    let or = SystemOperation::bitwise_or();
    if comm.rank() != 0 {
        root.reduce_into(&mine[..], or);
        return Vec::new();
    }
    let mut all = vec![0_u64; mine.len()];
    root.reduce_into_root(&mine[..], &mut all[..], or);
    all.into_iter().map(f64::from_bits).collect()
}

impl System {
    /// A vector of unknowns in mesh order; complete on rank 0, empty elsewhere. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn in_mesh_order(&self, vector: &VectorRef) -> petsc::Result<Vec<f64>> {
        let order = MeshOrder::of(self);
        let (values, count) = (vector.read()?, self.unknown_count());
        Ok(gather_blocks(
            self.comm(),
            &order.unknowns,
            1,
            &values,
            count,
        ))
    }

    /// The vector whose unknowns every rank has in mesh order.
    ///
    /// # Errors
    /// If there are too few or too many, the same on every rank, or PETSc fails.
    pub fn from_mesh_order(&self, values: &[f64]) -> Result<Vector, MeshOrderError> {
        WrongSize::check("the unknowns", values.len(), self.unknown_count())?;
        let mut vector = self.vector()?;
        let mut write = vector.write()?;
        for (value, place) in write.iter_mut().zip(MeshOrder::of(self).unknowns) {
            *value = values[place];
        }
        drop(write);
        Ok(vector)
    }

    /// Node of the mesh of each local node, and number of each local contact point along the surface.
    pub fn own_file_numbers(&self) -> [Vec<usize>; 2] {
        let nodes = self.local().nodes.clone();
        [nodes, MeshOrder::of(self).contact_points]
    }

    /// Node of the mesh of each row of a field file of the sheet, and number of the contact point of each row of one of
    /// the contact points: rank after rank, in the order of each rank's own. Complete on every rank. Collective.
    pub fn file_rows(&self) -> [Vec<u64>; 2] {
        self.own_file_numbers().map(|mine| {
            let mine: Vec<u64> = mine.into_iter().map(|number| number as u64).collect();
            gather_lists(self.comm(), &mine)
        })
    }
}
