//! The condensed system solved by substructures: each rank eliminates what only its own elements touch, and what is left,
//! the unknowns between the ranks, is solved by all of them alike.
//!
//! Most of a rank's unknowns are eliminated slice by slice with dense matrices ([`Fronts`]); what is left of them is one
//! sparse matrix, much smaller, and none of its fronts is tiny. The same numbers come out in every run, which the dynamic
//! scheduling of a parallel multifrontal solver does not promise.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};
use petsc::{FactorKind, Ksp, Matrix, Vector};

use super::System;
use super::condensation::{CondensedEntries, CondensedPattern};
use super::condensed_solve::{direct_solver, factorise};
use super::fronts::Fronts;
use super::interface::{Interface, Shared};

/// Beyond this number of shared unknowns the dense matrix between the ranks costs more than it saves.
const MOST_SHARED: usize = 2000;

/// One rank's part of the solve.
pub(super) struct Substructures {
    fronts: Fronts,
    /// What they leave of this rank's entries, summed over nobody else's.
    matrix: Matrix,
    rest: Rest,
    right_side: Vector,
    solution: Vector,
    /// All local displacements.
    values: Vec<f64>,
    /// Local displacements this rank shares but does not own.
    foreign: Vec<usize>,
    /// Owned displacements: local, and place among those owned.
    owned: Vec<(usize, usize)>,
}

/// Who solves for what the fronts leave.
enum Rest {
    /// A solver of PETSc, where there is one rank.
    Alone(Ksp),
    /// All ranks.
    Together(Box<Interface>),
}

impl Substructures {
    /// For the pattern of this rank's entries in local displacements; gives it back where a rank has nothing of its own or
    /// too much is shared. Collective.
    pub(super) fn new(
        system: &System,
        pattern: CondensedPattern,
        kind: FactorKind,
        options_prefix: &str,
    ) -> petsc::Result<Result<Self, CondensedPattern>> {
        let comm = system.comm();
        let all = 2 * system.local().nodes.len();
        let (shared, count) = shared_unknowns(system);
        let mut unfit = i32::from(count > MOST_SHARED || shared.len() == all);
        let mine = unfit;
        comm.all_reduce_into(&mine, &mut unfit, SystemOperation::max());
        if unfit > 0 {
            return Ok(Err(pattern));
        }
        let mut kept = vec![false; all];
        shared.iter().for_each(|shared| kept[shared.unknown] = true);
        let foreign = shared.iter().filter(|shared| !shared.owned);
        let foreign = foreign.map(|shared| shared.unknown).collect();

        let (fronts, pattern) = Fronts::new(&pattern, &kept, kind);
        let size = fronts.left().len();
        let alone = SimpleCommunicator::self_comm();
        let mut matrix = Matrix::from_coo(&alone, size, &pattern.rows, &pattern.columns)?;
        // The analysis wants entries, and must not depend on which: a restart begins with others.
        matrix.set_values_coo(&vec![1.0; pattern.rows.len()])?;
        let rest = if comm.size() == 1 {
            Rest::Alone(direct_solver(&alone, &matrix, kind, options_prefix)?)
        } else {
            let mut place = vec![0; all];
            for (new, &old) in fronts.left().iter().enumerate() {
                place[old] = new;
            }
            let mut shared = shared;
            for shared in &mut shared {
                shared.unknown = place[shared.unknown];
            }
            Rest::Together(Box::new(Interface::new(
                comm,
                &matrix,
                kind,
                shared,
                count,
                options_prefix,
            )?))
        };
        Ok(Ok(Self {
            right_side: Vector::new(&alone, size)?,
            solution: Vector::new(&alone, size)?,
            values: vec![0.0; all],
            fronts,
            matrix,
            rest,
            foreign,
            owned: owned_unknowns(system),
        }))
    }

    /// Factorises for the entries of this rank. Says whether the matrix can be used. Collective.
    pub(super) fn factor(&mut self, entries: CondensedEntries<'_>) -> petsc::Result<bool> {
        let left = self.fronts.eliminate(entries);
        if let Some(left) = left {
            self.matrix.set_values_coo(left)?;
        }
        let usable = left.is_some();
        match &mut self.rest {
            Rest::Alone(solver) => Ok(usable && factorise(solver, &self.matrix)?),
            Rest::Together(interface) => interface.factor(&self.matrix, usable),
        }
    }

    /// Solves for the right-hand side `b`, of which this rank knows all its local displacements, and returns
    /// those it owns in `out`. Collective.
    pub(super) fn solve(&mut self, b: &[f64], out: &mut Vector) -> petsc::Result<()> {
        let values = &mut self.values;
        values.copy_from_slice(b);
        // Of what is shared the owner brings the right-hand side, and the others what their own parts add.
        self.foreign
            .iter()
            .for_each(|&unknown| values[unknown] = 0.0);
        self.fronts.forward(values);
        let mut right_side = self.right_side.write()?;
        for (value, &unknown) in right_side.iter_mut().zip(self.fronts.left()) {
            *value = values[unknown];
        }
        drop(right_side);
        match &mut self.rest {
            Rest::Alone(solver) => {
                solver.solve(&self.right_side, &mut self.solution)?;
            }
            Rest::Together(interface) => interface.solve(&self.right_side, &mut self.solution)?,
        }
        for (&value, &unknown) in self.solution.read()?.iter().zip(self.fronts.left()) {
            values[unknown] = value;
        }
        self.fronts.backward(values);
        let mut out = out.write()?;
        for &(local, place) in &self.owned {
            out[place] = values[local];
        }
        Ok(())
    }

    /// The package that factorises, or the method that chooses it on each rank.
    pub(super) fn factor_solver(&self) -> petsc::Result<Option<String>> {
        match &self.rest {
            Rest::Alone(solver) => Ok(solver.factor_solver()?.or(solver.preconditioner()?)),
            Rest::Together(_) => Ok(Some("mumps, substructures".to_owned())),
        }
    }
}

/// The shared unknowns of this rank, and the number of those of all ranks.
fn shared_unknowns(system: &System) -> (Vec<Shared>, usize) {
    let (local, places) = (system.local(), shared_nodes(system));
    let mine = (0..2 * local.nodes.len()).filter_map(|unknown| {
        let place = places[local.nodes[unknown / 2]]?;
        Some(Shared {
            unknown,
            place: 2 * place + unknown % 2,
            owned: local.owned[unknown / 2],
        })
    });
    (mine.collect(), 2 * places.iter().flatten().count())
}

/// The owned displacements of this rank: local number, and place among those owned.
fn owned_unknowns(system: &System) -> Vec<(usize, usize)> {
    let (local, numbering) = (system.local(), system.numbering());
    let first = numbering.rank_displacements[system.comm().rank() as usize];
    (0..2 * local.nodes.len())
        .filter(|unknown| local.owned[unknown / 2])
        .map(|unknown| {
            let row = numbering.displacement_row(local.nodes[unknown / 2]);
            (unknown, row + unknown % 2 - first)
        })
        .collect()
}

/// For each node of the mesh its place among those that elements of several ranks touch.
fn shared_nodes(system: &System) -> Vec<Option<usize>> {
    let local = system.local();
    let mesh = &local.problem.mesh;
    let owner = &system.numbering().node_owner;
    let mut shared = vec![false; mesh.nodes.len()];
    for (nodes, &rank) in mesh.elements.iter().zip(system.partition()) {
        for &node in nodes {
            shared[node] |= owner[node] != rank;
        }
    }
    let mut next = 0;
    shared
        .into_iter()
        .map(|shared| {
            shared.then(|| {
                next += 1;
                next - 1
            })
        })
        .collect()
}
