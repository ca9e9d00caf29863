//! What a system remembers and where it stands, by numbers of the mesh, so that any partition can read it.
//!
//! In mesh order the unknowns are x and y of node after node, then multiplier and gap of contact point after contact
//! point, edge by edge along the surface.

use mpi::collective::SystemOperation;
use mpi::traits::{Communicator, CommunicatorCollectives, Root};
use petsc::{Vector, VectorRef};

use super::{System, UNKNOWNS_PER_POINT};
use crate::contact::FrictionState;
use crate::material::PointState;
use crate::plane::PlaneTensor;

/// Numbers per Gauss point: C_p⁻¹ (xx, xy, yy, zz) and equivalent plastic strain.
const PER_GAUSS_POINT: usize = 5;
/// Numbers per contact point: friction force, arc length, x and y of the edge's three nodes.
const PER_CONTACT_POINT: usize = 8;

/// The committed history over all ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Element by element, Gauss point by Gauss point.
    pub gauss_points: Vec<f64>,
    /// Contact point by contact point.
    pub contact_points: Vec<f64>,
    /// Work of friction that each rank has added up, mJ per mm of width.
    pub friction_work: Vec<f64>,
}

/// Mesh numbers of what a rank holds.
struct MeshOrder {
    /// Of each row this rank owns, its place among the unknowns in mesh order.
    unknowns: Vec<usize>,
    /// Of each contact point of this rank, its number along the surface.
    contact_points: Vec<usize>,
    contact_point_count: usize,
}

impl System {
    fn mesh_order(&self) -> MeshOrder {
        let (local, rank) = (self.local(), self.comm().rank() as usize);
        let mesh = &local.problem.mesh;
        let (mut contact_points, mut count) = (Vec::new(), 0);
        for (index, edge) in mesh.surface.iter().enumerate() {
            if local.problem.tool(edge.side).is_none() {
                continue;
            }
            let samples = local.problem.contact_samples(index).len();
            if self.parts[edge.element] == rank {
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
        MeshOrder {
            unknowns,
            contact_points,
            contact_point_count: count,
        }
    }

    /// The committed history; complete on rank 0, empty elsewhere. Collective.
    pub fn snapshot(&self) -> Snapshot {
        let (order, local) = (self.mesh_order(), self.local());
        let block = PER_GAUSS_POINT * local.problem.quadrature.point_count();
        let gauss_points: Vec<f64> = local
            .states
            .iter()
            .flat_map(|state| {
                let PointState {
                    cp_inverse: PlaneTensor { xx, yy, zz, xy },
                    equivalent_plastic_strain,
                } = *state;
                [xx, xy, yy, zz, equivalent_plastic_strain]
            })
            .collect();
        let contact_points: Vec<f64> = local
            .contacts
            .iter()
            .flat_map(|contact| {
                let FrictionState {
                    traction,
                    arc_length,
                    nodes: [a, b, c],
                } = contact.state;
                [traction, arc_length, a[0], a[1], b[0], b[1], c[0], c[1]]
            })
            .collect();
        let elements = local.problem.mesh.elements.len();
        Snapshot {
            gauss_points: self.gather(&local.elements, block, &gauss_points, elements),
            contact_points: self.gather(
                &order.contact_points,
                PER_CONTACT_POINT,
                &contact_points,
                order.contact_point_count,
            ),
            friction_work: self.gather(
                &[self.comm().rank() as usize],
                1,
                &[local.friction_work],
                self.comm().size() as usize,
            ),
        }
    }

    /// Takes over a committed history, which every rank has in full, also one of another number of ranks.
    ///
    /// # Errors
    /// Which part does not have the size of this system's.
    pub fn restore(&self, snapshot: &Snapshot) -> Result<(), String> {
        let order = self.mesh_order();
        let mut local = self.local.borrow_mut();
        let points = local.problem.quadrature.point_count();
        let elements = local.problem.mesh.elements.len();
        let expect = |what: &str, found: usize, expected: usize| {
            if found == expected {
                Ok(())
            } else {
                Err(format!("{what} have {found} numbers instead of {expected}"))
            }
        };
        let (gauss, contact) = (&snapshot.gauss_points, &snapshot.contact_points);
        expect(
            "the Gauss points",
            gauss.len(),
            PER_GAUSS_POINT * points * elements,
        )?;
        expect(
            "the contact points",
            contact.len(),
            PER_CONTACT_POINT * order.contact_point_count,
        )?;
        let (gauss, _) = gauss.as_chunks::<PER_GAUSS_POINT>();
        let (contact, _) = contact.as_chunks::<PER_CONTACT_POINT>();
        let numbers: Vec<usize> = local
            .elements
            .iter()
            .flat_map(|element| points * element..points * (element + 1))
            .collect();
        for (state, number) in local.states.iter_mut().zip(numbers) {
            let [xx, xy, yy, zz, equivalent_plastic_strain] = gauss[number];
            *state = PointState {
                cp_inverse: PlaneTensor { xx, yy, zz, xy },
                equivalent_plastic_strain,
            };
        }
        for (point, &number) in local.contacts.iter_mut().zip(&order.contact_points) {
            let [traction, arc_length, a, b, c, d, e, f] = contact[number];
            point.state = FrictionState {
                traction,
                arc_length,
                nodes: [[a, b], [c, d], [e, f]],
            };
        }
        let (rank, ranks) = (self.comm().rank() as usize, self.comm().size() as usize);
        local.friction_work = match snapshot.friction_work.len() {
            same if same == ranks => snapshot.friction_work[rank],
            _ if rank == 0 => snapshot.friction_work.iter().sum(),
            _ => 0.0,
        };
        Ok(())
    }

    /// A vector of unknowns in mesh order; complete on rank 0, empty elsewhere. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn in_mesh_order(&self, vector: &VectorRef) -> petsc::Result<Vec<f64>> {
        let order = self.mesh_order();
        let values = vector.read()?;
        Ok(self.gather(&order.unknowns, 1, &values, self.unknown_count()))
    }

    /// The vector whose unknowns every rank has in mesh order.
    ///
    /// # Errors
    /// If PETSc fails, or as a text if there are too few or too many.
    pub fn from_mesh_order(&self, values: &[f64]) -> petsc::Result<Result<Vector, String>> {
        if values.len() != self.unknown_count() {
            let (found, expected) = (values.len(), self.unknown_count());
            return Ok(Err(format!(
                "a vector has {found} unknowns instead of {expected}"
            )));
        }
        let mut vector = self.vector()?;
        let mut write = vector.write()?;
        for (value, place) in write.iter_mut().zip(self.mesh_order().unknowns) {
            *value = values[place];
        }
        drop(write);
        Ok(Ok(vector))
    }

    /// Node of the mesh of each local node, and number of each local contact point along the surface.
    pub fn own_file_numbers(&self) -> [Vec<usize>; 2] {
        let nodes = self.local().nodes.clone();
        [nodes, self.mesh_order().contact_points]
    }

    /// Node of the mesh of each row of a field file of the sheet, and number of the contact point of each row of one of
    /// the contact points: rank after rank, in the order of each rank's own. Complete on every rank. Collective.
    pub fn file_rows(&self) -> [Vec<u64>; 2] {
        self.own_file_numbers().map(|mine| {
            let mut counts = vec![0_u64; self.comm().size() as usize];
            self.comm()
                .all_gather_into(&(mine.len() as u64), &mut counts[..]);
            let rank = self.comm().rank() as usize;
            let first = counts[..rank].iter().sum::<u64>() as usize;
            let mut own = vec![0_u64; counts.iter().sum::<u64>() as usize];
            for (row, number) in own[first..].iter_mut().zip(mine) {
                *row = number as u64;
            }
            let mut all = vec![0_u64; own.len()];
            let or = SystemOperation::bitwise_or();
            self.comm().all_reduce_into(&own[..], &mut all[..], or);
            all
        })
    }

    /// Blocks of `size` numbers at the places of `numbers` among `count`; complete on rank 0, empty elsewhere.
    /// The bits travel as they are: a sum would lose the sign of zero. Collective.
    fn gather(&self, numbers: &[usize], size: usize, values: &[f64], count: usize) -> Vec<f64> {
        let mut mine = vec![0_u64; size * count];
        for (block, &number) in values.chunks_exact(size).zip(numbers) {
            for (bits, value) in mine[size * number..].iter_mut().zip(block) {
                *bits = value.to_bits();
            }
        }
        let root = self.comm().process_at_rank(0);
        let or = SystemOperation::bitwise_or();
        if self.comm().rank() != 0 {
            root.reduce_into(&mine[..], or);
            return Vec::new();
        }
        let mut all = vec![0_u64; mine.len()];
        root.reduce_into_root(&mine[..], &mut all[..], or);
        all.into_iter().map(f64::from_bits).collect()
    }
}
