//! The sheet without its tools, held by the forces they had, which then go away.

use mpi::traits::Communicator;
use petsc::{Vector, VectorRef};

use super::System;
use super::error::{FailedElement, SystemError};
use super::history::History;
use super::problem::{Factor, NodalValue, Problem};
use crate::ranks::{gather_lists, rows};

/// A sheet whose tools have just been taken away, at the unknowns it had with them.
pub struct Released {
    /// The sheet with dead loads in place of the tools.
    pub system: System,
    /// Its material's history.
    pub history: History,
    /// Its displacements.
    pub unknowns: Vector,
}

/// What holds a node of the sheet when the tools are gone.
struct HeldNode {
    node: usize,
    /// Internal force divided by Young's modulus, mm.
    force: [f64; 2],
    /// Displacement in y, mm.
    height: f64,
}

impl Released {
    /// The sheet of `system` with its history, without tools, at the accepted unknowns `u`: the tools' forces
    /// are dead loads whose factor goes from one at `start` to zero at `end` (ms), and point A keeps
    /// its height, because nothing else does. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated, the same on every rank.
    pub fn new(
        system: &System,
        history: &History,
        u: &VectorRef,
        start: f64,
        end: f64,
    ) -> Result<Self, SystemError> {
        let local = system.local();
        let values = system.local_values(u)?;
        let held = held_nodes(system, history, &values)?;
        let fade = Factor(vec![(start, 1.0), (end, 0.0)]);
        let young = local.problem.young_modulus;
        let loads = held.iter().flat_map(|held| {
            [0, 1].map(|component| NodalValue {
                node: held.node,
                component,
                value: young * held.force[component],
                factor: fade.clone(),
            })
        });
        let mut problem = Problem {
            loads: loads.collect(),
            lower_tool: None,
            upper_tool: None,
            density: 0.0,
            ..local.problem.clone()
        };
        let point_a = problem.mesh.point_a;
        let at_point_a = held.iter().filter(|held| held.node == point_a);
        problem.supports.extend(at_point_a.map(|held| NodalValue {
            node: point_a,
            component: 1,
            value: held.height,
            factor: Factor(vec![(start, 1.0)]),
        }));
        let comm = system.comm().duplicate();
        let released = System::with_partition(problem, system.partition().clone(), comm)?;
        let mut unknowns = released.vector()?;
        let mut write = unknowns.write()?;
        // Rows a rank owns are in the order of its owned nodes.
        let owned = (0..local.nodes.len()).filter(|&n| local.owned[n]);
        for (row, node) in owned.enumerate() {
            write[2 * row..2 * row + 2].copy_from_slice(&values[2 * node..2 * node + 2]);
        }
        drop(write);
        Ok(Self {
            system: released,
            history: history.without_contact(),
            unknowns,
        })
    }
}

/// All nodes of the mesh in ascending order, the same on every rank. Collective.
fn held_nodes(
    system: &System,
    history: &History,
    values: &[f64],
) -> Result<Vec<HeldNode>, SystemError> {
    let local = system.local();
    let mut forces = vec![0.0; values.len()];
    let evaluated = local.add_internal_forces(history, values, None, &mut forces);
    FailedElement::agree(system.comm(), evaluated)?;
    system.sum_over_ranks(&mut forces)?;
    let owned = (0..local.nodes.len()).filter(|&n| local.owned[n]);
    let mine: Vec<f64> = owned
        .flat_map(|n| {
            let [x, y] = [forces[2 * n], forces[2 * n + 1]];
            [local.nodes[n] as f64, x, y, values[2 * n + 1]]
        })
        .collect();
    let all = gather_lists(system.comm(), &mine);
    let mut held: Vec<HeldNode> = rows(&all)
        .into_iter()
        .map(|[node, x, y, height]| HeldNode {
            node: node as usize,
            force: [x, y],
            height,
        })
        .collect();
    held.sort_by_key(|held| held.node);
    Ok(held)
}
