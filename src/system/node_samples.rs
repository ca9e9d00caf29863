//! Fields for pictures: what the Gauss points and contact points say, averaged at the nodes.

use super::System;
use super::error::{ElementFailure, FailedElement, SystemError};
use super::history::History;
use super::subdomain::Subdomain;
use crate::contact::ContactState;
use crate::element::{NODES, Quadrature, gauss_points};
use crate::mesh::SurfaceSide;
use crate::plane::determinant;

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

/// Numbers of a [`NodeSums`].
const SUMS: usize = 12;

/// What adds up at a node over its elements and contact points, on all ranks.
#[derive(Clone, Debug, Default)]
struct NodeSums {
    /// Cauchy stress xx, yy, zz, xy and equivalent plastic strain of each element, extrapolated.
    stress: [f64; 4],
    plastic_strain: f64,
    /// Number of elements.
    elements: f64,
    /// Contact force, N per mm of width, and contact length, mm.
    force: f64,
    length: f64,
    /// The force of points that stick, that slip forward, and that slip backward.
    by_state: [f64; 3],
}

impl NodeSums {
    fn to_array(&self) -> [f64; SUMS] {
        let [xx, yy, zz, xy] = self.stress;
        let [stick, forward, backward] = self.by_state;
        let (strain, elements) = (self.plastic_strain, self.elements);
        [
            xx,
            yy,
            zz,
            xy,
            strain,
            elements,
            self.force,
            self.length,
            stick,
            forward,
            backward,
            0.0,
        ]
    }

    fn from_array(sums: [f64; SUMS]) -> Self {
        let [
            xx,
            yy,
            zz,
            xy,
            plastic_strain,
            elements,
            force,
            length,
            stick,
            forward,
            backward,
            _,
        ] = sums;
        Self {
            stress: [xx, yy, zz, xy],
            plastic_strain,
            elements,
            force,
            length,
            by_state: [stick, forward, backward],
        }
    }

    fn add_point(&mut self, share: f64, force: f64, length: f64, state: ContactState) {
        self.force += share * force;
        self.length += share * length;
        let [stick, forward, backward] = &mut self.by_state;
        match state {
            ContactState::Open => {}
            ContactState::Stick => *stick += share * force,
            ContactState::SlipForward => *forward += share * force,
            ContactState::SlipBackward => *backward += share * force,
        }
    }

    /// The state that most of the force is carried in; open if nothing is carried.
    fn prevailing_state(&self) -> ContactState {
        let [stick, forward, backward] = self.by_state;
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

    fn sample(&self, displacement: [f64; 2], gap: f64, can_touch: bool) -> NodeSample {
        let stress = self.stress.map(|sum| sum / self.elements);
        let [xx, yy, zz, xy] = stress;
        let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        NodeSample {
            displacement,
            stress,
            von_mises_stress: (0.5 * differences + 3.0 * xy * xy).sqrt(),
            equivalent_plastic_strain: (self.plastic_strain / self.elements).max(0.0),
            contact_pressure: if self.length > 0.0 {
                (self.force / self.length).max(0.0)
            } else {
                0.0
            },
            gap,
            contact_state: can_touch.then(|| self.prevailing_state()),
        }
    }
}

impl System {
    /// What is known at each local node at time `t` (ms) and local unknowns `u`, whose history this is. Averages are
    /// over the elements of all ranks, so they do not depend on the partition. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated, the same on every rank.
    pub fn node_samples(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
    ) -> Result<Vec<NodeSample>, SystemError> {
        let local = self.local();
        let mine = local.node_sums(history, t, u);
        let mine = FailedElement::agree(self.comm(), mine)?;
        let mut sums: Vec<[f64; SUMS]> = mine.iter().map(NodeSums::to_array).collect();
        // The exchange knows two numbers per node.
        let mut pairs = vec![0.0; u.len()];
        for first in (0..SUMS).step_by(2) {
            pairs.fill(0.0);
            for (pair, sum) in pairs.chunks_exact_mut(2).zip(&sums) {
                pair.copy_from_slice(&sum[first..first + 2]);
            }
            self.sum_over_ranks(&mut pairs)?;
            for (pair, sum) in pairs.chunks_exact(2).zip(&mut sums) {
                sum[first..first + 2].copy_from_slice(pair);
            }
        }
        let samples = sums.into_iter().enumerate().map(|(node, sums)| {
            let face = local.face(node);
            let can_touch = face.is_some_and(|side| local.problem.tool(side).is_some());
            let gap = local.node_gap(node, face, t, u);
            let sums = NodeSums::from_array(sums);
            sums.sample([u[2 * node], u[2 * node + 1]], gap, can_touch)
        });
        Ok(samples.collect())
    }
}

impl Subdomain {
    /// This rank's sums at its nodes at time `t` (ms) and unknowns `u` (local).
    fn node_sums(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
    ) -> Result<Vec<NodeSums>, ElementFailure> {
        let weights = extrapolation(self.problem.quadrature);
        let mut sums = vec![NodeSums::default(); self.nodes.len()];
        for (element, nodes) in self.connectivity.iter().enumerate() {
            let values = self.element_values(element, u);
            for (point, state) in history.element(element).iter().enumerate() {
                let (response, f, _) = self.kernels[element]
                    .point_response(point, &values, &self.problem.material, state)
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                let volume_ratio = determinant(&f);
                let cauchy = response.kirchhoff.map(|s| s / volume_ratio);
                for (&node, weight) in nodes.iter().zip(weights[point]) {
                    let sum = &mut sums[node];
                    for (sum, stress) in sum.stress.iter_mut().zip(cauchy.components()) {
                        *sum += weight * stress;
                    }
                    sum.plastic_strain += weight * state.equivalent_plastic_strain;
                }
            }
            for &node in nodes {
                sums[node].elements += 1.0;
            }
        }
        for (point, (contact, committed)) in self.contacts.iter().zip(&history.friction).enumerate()
        {
            let m = self.multiplier(point);
            let force = self.problem.young_modulus * u[m];
            let state = contact.law.committed_state(u[m], u[m + 1], committed);
            let shape = match contact.law.moves_on {
                Some(_) => self.contact_position(contact, committed, t, u).shape,
                None => contact.law.shape,
            };
            let shares = half_edge_hats(&shape);
            for (&node, share) in contact.nodes.iter().zip(shares) {
                sums[node].add_point(share, force, contact.length, state);
            }
        }
        Ok(sums)
    }

    /// Signed distance of a local node to the tool its face can touch (inside: to the nearer one) at time `t` (ms), mm.
    fn node_gap(&self, node: usize, face: Option<SurfaceSide>, t: f64, u: &[f64]) -> f64 {
        let [x, y] = self.coordinates[node];
        let now = [x + u[2 * node], y + u[2 * node + 1]];
        let gap = |side: SurfaceSide| {
            let tool = self.problem.tool(side);
            tool.map_or(f64::MAX, |tool| tool.signed_distance(now, t))
        };
        match face {
            Some(side) => gap(side),
            None => gap(SurfaceSide::Bottom).min(gap(SurfaceSide::Top)),
        }
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
}

/// Extrapolates values at the Gauss points to the nodes of an element by a least squares bilinear fit: the value at
/// node a is the sum over the points q of `[q][a]` times the value at q.
fn extrapolation(quadrature: Quadrature) -> Vec<[f64; 8]> {
    let points = gauss_points(quadrature);
    let count = points.len() as f64;
    // On a symmetric tensor rule 1, ξ, η and ξη are orthogonal: the fit needs no solve.
    let mean_square = [0, 1].map(|k| points.iter().map(|(x, _)| x[k] * x[k]).sum::<f64>() / count);
    points
        .iter()
        .map(|([xi, eta], _)| {
            NODES.map(|[xa, ea]| {
                let (along, across) = (xi * xa / mean_square[0], eta * ea / mean_square[1]);
                (1.0 + along) * (1.0 + across) / count
            })
        })
        .collect()
}

/// Piecewise linear hats of the three nodes of an edge (left, right, middle) at the point with the
/// given quadratic shape functions.
fn half_edge_hats(shape: &[f64; 3]) -> [f64; 3] {
    // The right minus the left shape function is ξ.
    let xi = shape[1] - shape[0];
    [(-xi).max(0.0), xi.max(0.0), 1.0 - xi.abs()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bilinear_field_is_extrapolated_exactly() {
        let field = |[xi, eta]: [f64; 2]| 1.0 - 2.0 * xi + 3.0 * eta + 0.5 * xi * eta;
        for (along, through) in [(2, 2), (3, 3), (2, 7), (3, 5)] {
            let quadrature = Quadrature::of(along, through);
            let (points, weights) = (gauss_points(quadrature), extrapolation(quadrature));
            for (node, place) in NODES.into_iter().enumerate() {
                let found: f64 = points
                    .iter()
                    .zip(&weights)
                    .map(|((xi, _), weights)| weights[node] * field(*xi))
                    .sum();
                assert!(
                    (found - field(place)).abs() < 1e-13,
                    "{along} x {through}, {node}"
                );
            }
        }
    }
}
