//! Fields for pictures: nodal averages of what the Gauss points say, and the contact points' values.

use super::evaluate::ElementFailure;
use super::local::LocalContact;
use super::{LocalSystem, System, SystemError};
use crate::contact::ContactState;
use crate::element::{NODES, gauss_points};
use crate::mesh::SurfaceSide;
use crate::plane::{determinant, interpolate};

/// Values summed at a node over its elements and contact points: four stress components and the
/// plastic strain (each weighted by one per element), the number of elements, contact force (N per
/// mm of width) and contact length (mm), and of the force what points that stick, slip forward and slip
/// backward carry.
pub(super) const NODE_CHANNELS: usize = 12;

/// What is known at a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointSample {
    /// Position in the reference configuration, mm; of a moving point the middle of its edge.
    pub reference: [f64; 2],
    /// From there to where it is now, mm.
    pub displacement: [f64; 2],
    /// Contact pressure, MPa.
    pub pressure: f64,
    /// Signed distance to the tool, mm.
    pub gap: f64,
    /// Friction traction on the sheet along the tool, committed, MPa.
    pub friction: f64,
    /// Whether it carries a force and slips.
    pub state: ContactState,
}

/// What is known at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeSample {
    /// Displacement, mm.
    pub displacement: [f64; 2],
    /// Cauchy stress xx, yy, zz, xy, MPa.
    pub stress: [f64; 4],
    /// Von Mises stress of that stress, MPa.
    pub von_mises_stress: f64,
    /// Equivalent plastic strain.
    pub equivalent_plastic_strain: f64,
    /// Contact pressure, averaged over the half edges at the node, MPa.
    pub contact_pressure: f64,
    /// Signed distance to the tool the node's face can touch (inside the sheet: to the nearer tool),
    /// mm.
    pub gap: f64,
    /// State of contact at the node; none where nothing can touch it: inside the sheet, and on a face
    /// without a tool. It is that of the contact points on the half edges at the node: open if none of
    /// them carries a force, otherwise the state of those that carry most of it.
    pub contact_state: Option<ContactState>,
}

/// Extrapolates Gauss point values to the nodes of an element by a least squares bilinear fit.
#[derive(Clone, Debug)]
pub struct FieldSampler {
    /// Value at node a = Σ_q weights[a][q] · value at Gauss point q.
    weights: Vec<[f64; 8]>,
}

impl System {
    /// What is known at each local node at time `t` (ms) and local unknowns `u`. Averages are over the
    /// elements of all ranks, so they do not depend on the partition. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated.
    pub fn node_samples(
        &self,
        sampler: &FieldSampler,
        t: f64,
        u: &[f64],
    ) -> Result<Vec<NodeSample>, SystemError> {
        let mut sums = self.local().nodal_sums(sampler, t, u)?;
        let mut pairs = vec![0.0; u.len()];
        for first in (0..NODE_CHANNELS).step_by(2) {
            pairs.fill(0.0);
            for (pair, sum) in pairs.chunks_exact_mut(2).zip(&sums) {
                pair.copy_from_slice(&sum[first..first + 2]);
            }
            self.sum_over_ranks(&mut pairs)?;
            for (pair, sum) in pairs.chunks_exact(2).zip(&mut sums) {
                sum[first..first + 2].copy_from_slice(pair);
            }
        }
        let local = self.local();
        let gaps = local.nodal_gaps(t, u);
        let displacements = u.chunks_exact(2);
        Ok(sums
            .iter()
            .zip(gaps)
            .zip(displacements)
            .enumerate()
            .map(|(node, ((sum, gap), displacement))| {
                let [xx, yy, zz, xy, plastic] = [0, 1, 2, 3, 4].map(|i| sum[i] / sum[5]);
                let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
                NodeSample {
                    displacement: [displacement[0], displacement[1]],
                    stress: [xx, yy, zz, xy],
                    von_mises_stress: (0.5 * differences + 3.0 * xy * xy).sqrt(),
                    equivalent_plastic_strain: plastic.max(0.0),
                    contact_pressure: if sum[7] > 0.0 {
                        (sum[6] / sum[7]).max(0.0)
                    } else {
                        0.0
                    },
                    gap,
                    contact_state: local
                        .touched_face(node)
                        .map(|_| prevailing_state([sum[8], sum[9], sum[10]])),
                }
            })
            .collect())
    }
}

impl LocalSystem {
    /// Reference coordinates of the local nodes, mm.
    pub fn node_coordinates(&self) -> &[[f64; 2]] {
        &self.coordinates
    }

    /// Local nodes of the local elements, in VTK's order.
    pub fn element_nodes(&self) -> &[[usize; 8]] {
        &self.connectivity
    }

    /// The sampler for this problem's Gauss rule.
    pub fn field_sampler(&self) -> FieldSampler {
        let points = gauss_points(self.problem.quadrature);
        let count = points.len() as f64;
        // On a symmetric tensor rule 1, ξ, η and ξη are orthogonal: the fit needs no solve.
        let mean_square = points.iter().map(|(x, _)| x[0] * x[0]).sum::<f64>() / count;
        let weights = points
            .iter()
            .map(|([xi, eta], _)| {
                NODES.map(|[xa, ea]| {
                    let (along, across) = (xi * xa / mean_square, eta * ea / mean_square);
                    (1.0 + along) * (1.0 + across) / count
                })
            })
            .collect();
        FieldSampler { weights }
    }

    /// This rank's nodal sums at time `t` (ms) and unknowns `u` (local), [`NODE_CHANNELS`] per local node.
    pub(super) fn nodal_sums(
        &self,
        sampler: &FieldSampler,
        t: f64,
        u: &[f64],
    ) -> Result<Vec<[f64; NODE_CHANNELS]>, ElementFailure> {
        let mut sums = vec![[0.0; NODE_CHANNELS]; self.nodes.len()];
        for (element, nodes) in self.connectivity.iter().enumerate() {
            let values = self.element_values(element, u);
            for (point, state) in self.element_states(element).iter().enumerate() {
                let (response, f, _) = self.kernels[element]
                    .point_response(point, &values, &self.problem.material, state)
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                let volume_ratio = determinant(&f);
                let cauchy = response.kirchhoff.map(|s| s / volume_ratio);
                let [xx, yy, zz, xy] = cauchy.components();
                let channels = [xx, yy, zz, xy, state.equivalent_plastic_strain];
                for (&node, weight) in nodes.iter().zip(sampler.weights[point]) {
                    for (sum, channel) in sums[node].iter_mut().zip(channels) {
                        *sum += weight * channel;
                    }
                }
            }
            for &node in nodes {
                sums[node][5] += 1.0;
            }
        }
        for (point, contact) in self.contacts.iter().enumerate() {
            let m = self.multiplier(point);
            let force = self.problem.young_modulus * u[m];
            let state = contact.committed_state(u[m], u[m + 1]);
            let share =
                half_edge_hats(&contact.position(&self.edge_positions(contact, u), t).shape);
            for (&node, share) in contact.nodes.iter().zip(share) {
                sums[node][6] += share * force;
                sums[node][7] += share * contact.length;
                match state {
                    ContactState::Open => {}
                    ContactState::Stick => sums[node][8] += share * force,
                    ContactState::SlipForward => sums[node][9] += share * force,
                    ContactState::SlipBackward => sums[node][10] += share * force,
                }
            }
        }
        Ok(sums)
    }

    /// Signed distance of every local node to the tool its face can touch (inner nodes: to the
    /// nearer one) at time `t` (ms), mm.
    pub(super) fn nodal_gaps(&self, t: f64, u: &[f64]) -> Vec<f64> {
        let gap = |side: SurfaceSide, x: [f64; 2]| {
            let tool = self.problem.tool(side);
            tool.map_or(f64::MAX, |tool| tool.distance(x, t).value)
        };
        self.coordinates
            .iter()
            .enumerate()
            .map(|(n, [x, y])| {
                let now = [x + u[2 * n], y + u[2 * n + 1]];
                match self.face(n) {
                    Some(side) => gap(side, now),
                    None => gap(SurfaceSide::Bottom, now).min(gap(SurfaceSide::Top, now)),
                }
            })
            .collect()
    }

    /// The face of the sheet a local node lies on; none inside.
    fn face(&self, node: usize) -> Option<SurfaceSide> {
        let thickness = self.problem.mesh.nodes[self.problem.mesh.point_a][1];
        match self.coordinates[node][1] {
            y if y <= 0.0 => Some(SurfaceSide::Bottom),
            y if y >= thickness => Some(SurfaceSide::Top),
            _ => None,
        }
    }

    /// The face of the sheet a local node lies on, if a tool can touch it there.
    fn touched_face(&self, node: usize) -> Option<SurfaceSide> {
        self.face(node)
            .filter(|&side| self.problem.tool(side).is_some())
    }

    /// States of this rank's contact points at an iterate: time `t` (ms) and local unknowns `u`.
    pub fn contact_states(&self, t: f64, u: &[f64]) -> Vec<ContactState> {
        let state = |(point, contact): (usize, &LocalContact)| {
            let m = self.multiplier(point);
            if u[m + 1] > 0.0 || u[m] <= 0.0 {
                return ContactState::Open;
            }
            let position = self.contact_position(contact, t, u);
            let traction = contact.law.traction(&position, u[m], &contact.state);
            match traction.by_multiplier {
                0.0 => ContactState::Stick,
                _ => ContactState::slipping_against(traction.value),
            }
        };
        self.contacts.iter().enumerate().map(state).collect()
    }

    /// Where one of this rank's contact points lies on the undeformed sheet (mm; of a moving point the middle of its
    /// edge), and on which face.
    pub fn contact_reference(&self, point: usize) -> ([f64; 2], SurfaceSide) {
        let contact = &self.contacts[point];
        let nodes = contact.nodes.map(|n| self.coordinates[n]);
        (interpolate(contact.law.shape, &nodes), contact.side)
    }

    /// All contact points of this rank at time `t` (ms) and unknowns `u` (local).
    pub fn contact_points(&self, t: f64, u: &[f64]) -> Vec<ContactPointSample> {
        self.contacts
            .iter()
            .enumerate()
            .map(|(point, contact)| {
                let m = self.multiplier(point);
                let position = contact.position(&self.edge_positions(contact, u), t);
                let (reference, _) = self.contact_reference(point);
                ContactPointSample {
                    reference,
                    displacement: [position.x[0] - reference[0], position.x[1] - reference[1]],
                    pressure: self.problem.young_modulus * u[m] / contact.length,
                    gap: position.distance.value,
                    friction: self.problem.young_modulus * contact.state.traction / contact.length,
                    state: contact.committed_state(u[m], u[m + 1]),
                }
            })
            .collect()
    }
}

/// The state that most of the force is carried in, of what sticking points and those that slip forward
/// and backward carry; open if nothing is carried.
fn prevailing_state([stick, forward, backward]: [f64; 3]) -> ContactState {
    if stick.max(forward).max(backward) <= 0.0 {
        ContactState::Open
    } else if stick >= forward.max(backward) {
        ContactState::Stick
    } else if forward >= backward {
        ContactState::SlipForward
    } else {
        ContactState::SlipBackward
    }
}

/// Piecewise linear hats of the three nodes of an edge (left, right, middle) at the point with the
/// given quadratic shape functions.
fn half_edge_hats(shape: &[f64; 3]) -> [f64; 3] {
    // The right minus the left shape function is ξ.
    let xi = shape[1] - shape[0];
    [(-xi).max(0.0), xi.max(0.0), 1.0 - xi.abs()]
}
