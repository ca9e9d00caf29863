//! One rank's part of the problem: its elements, the nodes they touch, its contact points.
//!
//! Local unknowns are x and y of each local node (node by node, owned and foreign), then multiplier
//! and gap of each local contact point.

use std::collections::HashMap;
use std::sync::Arc;

use super::error::ElementFailure;
use super::numbering::{Numbering, UNKNOWNS_PER_POINT};
use super::problem::{Factor, NodalValue, Problem, Tool};
use crate::contact::{ContactLaw, ContactSample, Friction, FrictionState, PointPosition};
use crate::element::{GaussPointFailure, Quad8};
use crate::mesh::{Partition, SurfaceSide};
use crate::plane::interpolate;

/// A contact point of this rank.
#[derive(Clone, Debug)]
pub(super) struct LocalContact {
    /// Face of the sheet.
    pub side: SurfaceSide,
    /// The tool that face can touch.
    pub tool: Arc<Tool>,
    /// Local nodes of its edge: left end, right end, middle.
    pub nodes: [usize; 3],
    /// Its constants.
    pub law: ContactLaw,
    /// Length of sheet it stands for, mm.
    pub length: f64,
    /// Whether it is the first point of its edge.
    pub first_of_edge: bool,
}

impl LocalContact {
    /// Position of the point and its distance to its tool at time `t` (ms), for the current positions
    /// of its edge's nodes.
    pub fn position(
        &self,
        nodes: &[[f64; 2]; 3],
        t: f64,
        committed: &FrictionState,
    ) -> PointPosition {
        let shift = self.tool.motion.shift(t);
        self.law
            .position(nodes, &self.tool.profile, shift, committed)
    }

    /// Where it lies between these positions of its edge's nodes; a moving point in its middle position.
    pub fn reference(&self, nodes: &[[f64; 2]; 3]) -> [f64; 2] {
        interpolate(self.law.shape, nodes)
    }
}

/// A prescribed displacement or a load at a local unknown.
#[derive(Clone, Debug)]
pub(super) struct LocalValue {
    /// Local number of the unknown.
    pub unknown: usize,
    /// Value at factor one, mm or N per mm of width.
    pub value: f64,
    /// The factor against time.
    pub factor: Factor,
}

/// This rank's part of the problem. It does not change.
#[derive(Debug)]
pub struct Subdomain {
    pub(super) problem: Problem,
    /// Mesh number of each local node.
    pub(super) nodes: Vec<usize>,
    /// Reference coordinates of the local nodes, mm.
    pub(super) coordinates: Vec<[f64; 2]>,
    /// Whether this rank owns the local node.
    pub(super) owned: Vec<bool>,
    /// Mesh number of each local element.
    pub(super) elements: Vec<usize>,
    /// Local nodes of each local element.
    pub(super) connectivity: Vec<[usize; 8]>,
    pub(super) kernels: Vec<Quad8>,
    pub(super) contacts: Vec<LocalContact>,
    /// Prescribed displacements.
    pub(super) supports: Vec<LocalValue>,
    /// Dead loads at nodes this rank owns.
    pub(super) loads: Vec<LocalValue>,
    /// Global row of each local unknown.
    pub(super) rows: Vec<i32>,
}

impl Subdomain {
    /// The part of `rank`.
    pub fn new(
        problem: Problem,
        partition: &Partition,
        numbering: &Numbering,
        rank: usize,
    ) -> Self {
        let mesh = &problem.mesh;
        let mut elements: Vec<usize> = (0..mesh.elements.len())
            .filter(|&e| partition[e] == rank)
            .collect();
        // As the linear solver goes through them.
        elements.sort_by_key(|&e| mesh.column(e));
        let nodes = nodes_of(elements.iter().map(|&e| &mesh.elements[e]));
        let local_of: HashMap<usize, usize> = nodes
            .iter()
            .enumerate()
            .map(|(local, &node)| (node, local))
            .collect();
        let owned: Vec<bool> = nodes
            .iter()
            .map(|&n| numbering.node_owner[n] == rank)
            .collect();
        let mut rows: Vec<i32> = nodes
            .iter()
            .map(|&n| numbering.node_row[n] as i32)
            .flat_map(|row| [row, row + 1])
            .collect();
        let mut contacts = Vec::new();
        for (index, edge) in mesh.surface.iter().enumerate() {
            if partition[edge.element] != rank {
                continue;
            }
            for (k, contact) in contacts_of(&problem, index, &local_of)
                .into_iter()
                .enumerate()
            {
                let row = (numbering.edge_row[index] + UNKNOWNS_PER_POINT * k) as i32;
                rows.extend([row, row + 1]);
                contacts.push(contact);
            }
        }
        let mut loads = local_values(&problem.loads, &local_of);
        loads.retain(|load| owned[load.unknown / 2]);
        Self {
            coordinates: nodes.iter().map(|&n| mesh.nodes[n]).collect(),
            connectivity: elements
                .iter()
                .map(|&e| mesh.elements[e].map(|node| local_of[&node]))
                .collect(),
            kernels: elements
                .iter()
                .map(|&e| Quad8::new(&mesh.elements[e].map(|n| mesh.nodes[n]), problem.quadrature))
                .collect(),
            supports: local_values(&problem.supports, &local_of),
            loads,
            owned,
            nodes,
            elements,
            contacts,
            rows,
            problem,
        }
    }

    /// The problem, the same on every rank.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Global row of each local unknown.
    pub fn rows(&self) -> &[i32] {
        &self.rows
    }

    /// Number of local unknowns.
    pub fn unknown_count(&self) -> usize {
        self.rows.len()
    }

    /// Reference coordinates of the local nodes, mm.
    pub fn node_coordinates(&self) -> &[[f64; 2]] {
        &self.coordinates
    }

    /// Local nodes of the local elements, in VTK's order.
    pub fn element_nodes(&self) -> &[[usize; 8]] {
        &self.connectivity
    }

    /// Places of this rank's contact points on the undeformed sheet, mm; of moving points the middles of their edges.
    pub fn contact_references(&self) -> Vec<[f64; 2]> {
        let place = |contact| self.contact_reference(contact);
        self.contacts.iter().map(place).collect()
    }

    /// Place of a contact point on the undeformed sheet, mm.
    pub(super) fn contact_reference(&self, contact: &LocalContact) -> [f64; 2] {
        contact.reference(&contact.nodes.map(|n| self.coordinates[n]))
    }

    /// Local number of the multiplier of contact point `point`; the gap follows.
    pub(super) fn multiplier(&self, point: usize) -> usize {
        2 * self.nodes.len() + UNKNOWNS_PER_POINT * point
    }

    /// Displacements of the nodes of a local element.
    pub(super) fn element_values(&self, element: usize, u: &[f64]) -> [[f64; 2]; 8] {
        self.connectivity[element].map(|n| [u[2 * n], u[2 * n + 1]])
    }

    /// Current positions of the nodes of a contact point's edge, mm.
    pub(super) fn edge_positions(&self, contact: &LocalContact, u: &[f64]) -> [[f64; 2]; 3] {
        contact.nodes.map(|n| {
            let [x, y] = self.coordinates[n];
            [x + u[2 * n], y + u[2 * n + 1]]
        })
    }

    /// What is wrong with a local element, in numbers of the mesh.
    pub(super) fn element_failure(
        &self,
        element: usize,
        u: &[f64],
        cause: GaussPointFailure,
    ) -> ElementFailure {
        let corner = self.connectivity[element][0];
        let [x, y] = self.coordinates[corner];
        ElementFailure {
            element: self.elements[element],
            position: [x + u[2 * corner], y + u[2 * corner + 1]],
            cause,
        }
    }
}

/// The nodes of some elements, ascending, each once.
fn nodes_of<'a>(elements: impl Iterator<Item = &'a [usize; 8]>) -> Vec<usize> {
    let mut nodes: Vec<usize> = elements.flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Those of these values that are at local nodes.
fn local_values(values: &[NodalValue], local_of: &HashMap<usize, usize>) -> Vec<LocalValue> {
    let local_value = |value: &NodalValue| {
        let local = local_of.get(&value.node)?;
        Some(LocalValue {
            unknown: 2 * local + value.component,
            value: value.value,
            factor: value.factor.clone(),
        })
    };
    values.iter().filter_map(local_value).collect()
}

/// The contact points of a surface edge of the mesh; none on a face without a tool.
fn contacts_of(
    problem: &Problem,
    index: usize,
    local_of: &HashMap<usize, usize>,
) -> Vec<LocalContact> {
    let (mesh, edge) = (&problem.mesh, &problem.mesh.surface[index]);
    let Some(tool) = problem.tool(edge.side) else {
        return Vec::new();
    };
    let nodes = mesh.edge_nodes(edge);
    let [left, right] = [mesh.nodes[nodes[0]], mesh.nodes[nodes[1]]];
    let edge_length = (right[0] - left[0]).hypot(right[1] - left[1]);
    let point = |(k, sample): (usize, ContactSample)| LocalContact {
        side: edge.side,
        tool: Arc::clone(tool),
        nodes: nodes.map(|n| local_of[&n]),
        law: contact_law(problem, &sample, edge_length),
        length: sample.weight * edge_length,
        first_of_edge: k == 0,
    };
    let samples = problem.contact_samples(index).into_iter();
    samples.enumerate().map(point).collect()
}

/// The constants of a contact point on an edge of this length, mm.
fn contact_law(problem: &Problem, sample: &ContactSample, edge_length: f64) -> ContactLaw {
    let length = sample.weight * edge_length;
    let friction = (problem.friction_coefficient > 0.0).then(|| Friction {
        coefficient: problem.friction_coefficient,
        compliance: problem.friction_compliance * problem.young_modulus / length,
    });
    ContactLaw {
        shape: sample.shape,
        moves_on: sample.moves.then_some(edge_length),
        compliance: problem.contact_compliance * problem.young_modulus / length,
        friction,
    }
}
