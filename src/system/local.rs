//! One rank's share of the problem: its elements, the nodes they touch, its contact points.
//!
//! Local unknowns are x and y of each local node (node by node, owned and foreign), then multiplier
//! and gap of each local contact point.

use std::collections::HashMap;
use std::sync::Arc;

use super::problem::{Factor, NodalValue, Tool};
use super::{Numbering, Problem, UNKNOWNS_PER_POINT};
use crate::contact::{
    ContactLaw, ContactSample, ContactState, Friction, FrictionState, PointPosition,
};
use crate::element::Quad8;
use crate::material::PointState;
use crate::mesh::{Partition, SurfaceSide};
use crate::plane::interpolate;

/// Committed friction this close to its limit, as a share of it, is at the limit.
const AT_LIMIT: f64 = 1e-9;

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
    /// Committed friction.
    pub state: FrictionState,
}

impl LocalContact {
    /// Position of the point and its distance to its tool at time `t` (ms), for the current positions
    /// of its edge's nodes.
    pub fn position(&self, nodes: &[[f64; 2]; 3], t: f64) -> PointPosition {
        self.law.position(
            nodes,
            &self.tool.profile,
            self.tool.motion.shift(t),
            &self.state,
        )
    }

    /// Its state at the accepted multiplier and gap (mm), with the committed friction.
    pub fn committed_state(&self, multiplier: f64, gap: f64) -> ContactState {
        if gap > 0.0 || multiplier <= 0.0 {
            return ContactState::Open;
        }
        let traction = self.state.traction;
        match self.law.friction {
            Some(Friction { coefficient, .. })
                if traction.abs() >= coefficient * multiplier * (1.0 - AT_LIMIT) =>
            {
                ContactState::slipping_against(traction)
            }
            _ => ContactState::Stick,
        }
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

/// This rank's share of the problem and the committed history of its material points.
#[derive(Debug)]
pub struct LocalSystem {
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
    /// Committed states, Gauss point by Gauss point, element by element.
    pub(super) states: Vec<PointState>,
    /// Committed work of friction, mJ per mm of width.
    pub(super) friction_work: f64,
}

impl LocalSystem {
    /// The share of `rank`.
    pub fn new(
        problem: Problem,
        partition: &Partition,
        numbering: &Numbering,
        rank: usize,
    ) -> Self {
        let mesh = &problem.mesh;
        let elements: Vec<usize> = (0..mesh.elements.len())
            .filter(|&e| partition[e] == rank)
            .collect();
        let mut nodes: Vec<usize> = elements
            .iter()
            .flat_map(|&e| mesh.elements[e].iter().copied())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let local_of: HashMap<usize, usize> = nodes
            .iter()
            .enumerate()
            .map(|(local, &node)| (node, local))
            .collect();
        let connectivity: Vec<[usize; 8]> = elements
            .iter()
            .map(|&e| mesh.elements[e].map(|node| local_of[&node]))
            .collect();
        let coordinates: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n]).collect();
        let kernels: Vec<Quad8> = elements
            .iter()
            .map(|&e| Quad8::new(&mesh.elements[e].map(|n| mesh.nodes[n]), problem.quadrature))
            .collect();

        let mut rows: Vec<i32> = nodes
            .iter()
            .flat_map(|&n| {
                [
                    numbering.node_row[n] as i32,
                    numbering.node_row[n] as i32 + 1,
                ]
            })
            .collect();
        let mut contacts = Vec::new();
        for (index, edge) in mesh.surface.iter().enumerate() {
            let Some(tool) = problem.tool(edge.side) else {
                continue;
            };
            if partition[edge.element] != rank {
                continue;
            }
            let edge_nodes = mesh.edge_nodes(edge);
            let [left, right] = [mesh.nodes[edge_nodes[0]], mesh.nodes[edge_nodes[1]]];
            let edge_length = (right[0] - left[0]).hypot(right[1] - left[1]);
            for (k, sample) in problem.contact_samples(index).iter().enumerate() {
                let length = sample.weight * edge_length;
                contacts.push(LocalContact {
                    side: edge.side,
                    tool: Arc::clone(tool),
                    nodes: edge_nodes.map(|n| local_of[&n]),
                    state: starting_friction(&problem, tool, edge_nodes, sample),
                    law: ContactLaw {
                        shape: sample.shape,
                        moves_on: sample.moves.then_some(edge_length),
                        compliance: problem.contact_compliance * problem.young_modulus / length,
                        friction: (problem.friction_coefficient > 0.0).then(|| Friction {
                            coefficient: problem.friction_coefficient,
                            compliance: problem.friction_compliance * problem.young_modulus
                                / length,
                        }),
                    },
                    length,
                    first_of_edge: k == 0,
                });
                let row = numbering.edge_row[index] + UNKNOWNS_PER_POINT * k;
                rows.extend([row as i32, row as i32 + 1]);
            }
        }
        let owned: Vec<bool> = nodes
            .iter()
            .map(|&n| numbering.node_owner[n] == rank)
            .collect();
        let local_value = |value: &NodalValue| {
            let local = local_of.get(&value.node)?;
            Some(LocalValue {
                unknown: 2 * local + value.component,
                value: value.value,
                factor: value.factor.clone(),
            })
        };
        let supports = problem.supports.iter().filter_map(local_value).collect();
        let loads = problem
            .loads
            .iter()
            .filter_map(local_value)
            .filter(|load| owned[load.unknown / 2])
            .collect();
        let states = vec![PointState::VIRGIN; elements.len() * problem.quadrature.point_count()];
        Self {
            owned,
            supports,
            loads,
            friction_work: 0.0,
            nodes,
            coordinates,
            elements,
            connectivity,
            kernels,
            contacts,
            rows,
            states,
            problem,
        }
    }

    /// The problem.
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

    /// Committed states of a local element.
    pub(super) fn element_states(&self, element: usize) -> &[PointState] {
        let count = self.problem.quadrature.point_count();
        &self.states[count * element..count * (element + 1)]
    }
}

/// Friction before anything has moved: none, at the foot point of the point's first position.
fn starting_friction(
    problem: &Problem,
    tool: &Tool,
    edge_nodes: [usize; 3],
    sample: &ContactSample,
) -> FrictionState {
    let nodes = edge_nodes.map(|n| problem.mesh.nodes[n]);
    let x = interpolate(sample.shape, &nodes);
    FrictionState {
        traction: 0.0,
        arc_length: tool.profile.distance(x).arc_length,
        nodes,
    }
}
