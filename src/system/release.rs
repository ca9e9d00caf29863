//! The sheet without its tools, held by the forces they had, which then go away.

use mpi::traits::Communicator;
use petsc::{Vector, VectorRef};

use super::problem::{Factor, NodalValue};
use super::{Problem, System, SystemError};

impl System {
    /// The same sheet with its history, without tools, at the accepted unknowns `u`: the tools' forces
    /// are dead loads whose factor goes from one at `start` to zero at `end` (ms), and point A keeps
    /// its height, because nothing else does. Gives the system and its unknowns. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated.
    pub fn released(
        &self,
        u: &VectorRef,
        start: f64,
        end: f64,
    ) -> Result<(System, Vector), SystemError> {
        let values = self.local_values(u)?;
        let mut forces = vec![0.0; values.len()];
        let evaluated = self.local().add_internal_forces(&values, &mut forces);
        let unbalanced = 2 * self.local().nodes.len();
        forces[unbalanced..].fill(0.0);
        self.sum_over_ranks(&mut forces)?;
        evaluated?;

        let local = self.local();
        let fade = Factor(vec![(start, 1.0), (end, 0.0)]);
        let loads = (0..unbalanced).map(|unknown| NodalValue {
            node: local.nodes[unknown / 2],
            component: unknown % 2,
            value: local.problem.young_modulus * forces[unknown],
            factor: fade.clone(),
        });
        let mut problem = Problem {
            loads: loads.collect(),
            lower_tool: None,
            upper_tool: None,
            density: 0.0,
            ..local.problem.clone()
        };
        if let Some(a) = local.nodes.iter().position(|&n| n == problem.mesh.point_a) {
            problem.supports.push(NodalValue {
                node: problem.mesh.point_a,
                component: 1,
                value: values[2 * a + 1],
                factor: Factor(vec![(start, 1.0)]),
            });
        }
        let released =
            System::with_partition(problem, self.parts.clone(), self.comm().duplicate())?;
        released.local.borrow_mut().states.clone_from(&local.states);
        let mut unknowns = released.vector()?;
        let mut write = unknowns.write()?;
        // Rows a rank owns are in the order of its owned nodes.
        let owned = (0..local.nodes.len()).filter(|&n| local.owned[n]);
        for (row, node) in owned.enumerate() {
            write[2 * row..2 * row + 2].copy_from_slice(&values[2 * node..2 * node + 2]);
        }
        drop(write);
        Ok((released, unknowns))
    }
}
