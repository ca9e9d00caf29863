//! What a sheet remembers, by numbers of the mesh, so that any partition can read it.

use mpi::traits::Communicator;

use super::System;
use super::error::WrongSize;
use super::history::History;
use super::mesh_order::{MeshOrder, gather_blocks};
use crate::contact::FrictionState;
use crate::material::PointState;
use crate::plane::PlaneTensor;
use crate::ranks::rows;

/// Numbers per Gauss point: C_p⁻¹ (xx, xy, yy, zz) and equivalent plastic strain.
const PER_GAUSS_POINT: usize = 5;
/// Numbers per contact point: friction force, arc length, x and y of the edge's three nodes.
const PER_CONTACT_POINT: usize = 8;

/// The committed history over all ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Element by element, Gauss point by Gauss point.
    pub gauss_points: Vec<f64>,
    /// Contact point by contact point, edge by edge along the surface.
    pub contact_points: Vec<f64>,
    /// Work of friction that each rank has added up, mJ per mm of width.
    pub friction_work: Vec<f64>,
}

impl Snapshot {
    /// Of a system's history; complete on rank 0, empty elsewhere. Collective.
    pub fn of(system: &System, history: &History) -> Self {
        let (order, local, comm) = (MeshOrder::of(system), system.local(), system.comm());
        let gauss_points: Vec<f64> = history.gauss_points.iter().flat_map(gauss_point).collect();
        let contact_points: Vec<f64> = history.friction.iter().flat_map(contact_point).collect();
        let rank = comm.rank() as usize;
        Self {
            gauss_points: gather_blocks(
                comm,
                &local.elements,
                PER_GAUSS_POINT * history.per_element,
                &gauss_points,
                local.problem.mesh.elements.len(),
            ),
            contact_points: gather_blocks(
                comm,
                &order.contact_points,
                PER_CONTACT_POINT,
                &contact_points,
                order.contact_point_count,
            ),
            friction_work: gather_blocks(
                comm,
                &[rank],
                1,
                &[history.friction_work],
                comm.size() as usize,
            ),
        }
    }

    /// This rank's history from a snapshot that every rank has in full, also one of another number of ranks.
    ///
    /// # Errors
    /// Which part does not have the size of this system's.
    pub fn restore(&self, system: &System) -> Result<History, WrongSize> {
        let (order, local) = (MeshOrder::of(system), system.local());
        let per_element = local.problem.quadrature.point_count();
        let count = per_element * local.problem.mesh.elements.len();
        WrongSize::check(
            "the Gauss points",
            self.gauss_points.len(),
            PER_GAUSS_POINT * count,
        )?;
        WrongSize::check(
            "the contact points",
            self.contact_points.len(),
            PER_CONTACT_POINT * order.contact_point_count,
        )?;
        let (gauss, contact) = (rows(&self.gauss_points), rows(&self.contact_points));
        let numbers = local
            .elements
            .iter()
            .flat_map(|element| per_element * element..per_element * (element + 1));
        let (rank, ranks) = (system.comm().rank() as usize, system.comm().size() as usize);
        Ok(History {
            gauss_points: numbers.map(|number| point_state(&gauss[number])).collect(),
            per_element,
            friction: order
                .contact_points
                .iter()
                .map(|&number| friction_state(&contact[number]))
                .collect(),
            friction_work: match self.friction_work.len() {
                same if same == ranks => self.friction_work[rank],
                _ if rank == 0 => self.friction_work.iter().sum(),
                _ => 0.0,
            },
        })
    }
}

pub(super) fn gauss_point(state: &PointState) -> [f64; PER_GAUSS_POINT] {
    let PointState {
        cp_inverse: PlaneTensor { xx, yy, zz, xy },
        equivalent_plastic_strain,
    } = *state;
    [xx, xy, yy, zz, equivalent_plastic_strain]
}

pub(super) fn point_state(numbers: &[f64; PER_GAUSS_POINT]) -> PointState {
    let [xx, xy, yy, zz, equivalent_plastic_strain] = *numbers;
    PointState {
        cp_inverse: PlaneTensor { xx, yy, zz, xy },
        equivalent_plastic_strain,
    }
}

pub(super) fn contact_point(state: &FrictionState) -> [f64; PER_CONTACT_POINT] {
    let FrictionState {
        traction,
        arc_length,
        nodes: [a, b, c],
    } = *state;
    [traction, arc_length, a[0], a[1], b[0], b[1], c[0], c[1]]
}

pub(super) fn friction_state(numbers: &[f64; PER_CONTACT_POINT]) -> FrictionState {
    let [traction, arc_length, a, b, c, d, e, f] = *numbers;
    FrictionState {
        traction,
        arc_length,
        nodes: [[a, b], [c, d], [e, f]],
    }
}
