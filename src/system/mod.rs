//! In: the problem (mesh, material, tools, motion), the committed history of the sheet and this rank's unknowns.
//! Out: residual, Jacobian, the history after an accepted step, and what can be measured on a state.
//! Never: decides on steps, prints, reads options, or writes files.
//!
//! A [`System`] is what does not change, a [`History`] what an accepted step left; an evaluation takes both and returns
//! what it found.

mod condensation;
mod condensed_solve;
mod contact_guess;
mod contact_places;
mod contact_profile;
mod contact_samples;
mod convergence;
mod dense;
mod elimination_order;
mod error;
mod evaluated;
mod front;
mod fronts;
mod history;
mod history_slope;
mod initial;
mod interface;
mod measure_sums;
mod measures;
mod mesh_order;
mod node_samples;
mod numbering;
mod partition;
mod problem;
mod released;
mod residual;
mod shape_slope;
mod snapshot;
mod subdomain;
mod subdomain_size;
mod substructures;
mod tangent;
mod variation;
mod work;

use std::cell::RefCell;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::log::Event;
use petsc::{Matrix, Scatter, Vector, VectorRef};

pub use condensed_solve::{CondensedMethod, CondensedSolve, SolverChoice};
pub use contact_guess::{ContactProfiles, StateAt};
pub use contact_places::ContactPlace;
pub use contact_samples::ContactPointSample;
pub use error::{
    ElementFailure, EvaluationError, FailedElement, MeshOrderError, SystemError, WrongSize,
};
pub use evaluated::EvaluatedStep;
pub use history::History;
pub use measures::Measures;
pub use node_samples::NodeSample;
pub use numbering::Numbering;
use numbering::UNKNOWNS_PER_POINT;
pub use problem::{Factor, NodalValue, Problem, Tool};
pub use released::Released;
pub use shape_slope::ShapeSlopes;
pub use snapshot::Snapshot;
pub use subdomain::Subdomain;
pub use subdomain_size::SubdomainSize;
pub use tangent::JacobianEntries;
pub use variation::{Advanced, Variation};
pub use work::{AcceptedState, Work};

use crate::contact::ContactState;
use crate::mesh::Partition;
use crate::ranks;

/// The discrete problem over all ranks of a communicator: what does not change during a run.
pub struct System {
    comm: SimpleCommunicator,
    /// Rank of every element.
    partition: Partition,
    numbering: Numbering,
    local: Subdomain,
    /// Between the unknowns that ranks own and those that each rank sees.
    ghosts: Scatter,
    template: Vector,
    /// Local values of an evaluation under way; nothing in them outlives it.
    buffers: RefCell<Buffers>,
    events: Events,
}

struct Buffers {
    u: Vec<f64>,
    a: Vec<f64>,
    residual: Vec<f64>,
}

struct Events {
    residual: Event,
    both: Event,
    jacobian: Event,
}

/// Velocities and accelerations of the unknowns, mm/ms and mm/ms².
#[derive(Clone, Copy)]
pub struct Rates<'a> {
    /// First time derivatives.
    pub velocity: &'a VectorRef,
    /// Second time derivatives.
    pub acceleration: &'a VectorRef,
}

impl System {
    /// Partitions the mesh on rank 0 and builds every rank's subdomain. Collective.
    ///
    /// # Errors
    /// If METIS or PETSc fails.
    pub fn new(problem: Problem, comm: SimpleCommunicator) -> Result<Self, SystemError> {
        let partition = partition::on_root(&problem.mesh, &comm)?;
        Ok(Self::with_partition(problem, partition, comm)?)
    }

    /// As [`System::new`] with the elements' ranks chosen.
    fn with_partition(
        problem: Problem,
        partition: Partition,
        comm: SimpleCommunicator,
    ) -> petsc::Result<Self> {
        let (ranks, rank) = (comm.size() as usize, comm.rank() as usize);
        let numbering = Numbering::new(&problem, &partition, ranks);
        let local = Subdomain::new(problem, &partition, &numbering, rank);
        let template = Vector::new(&comm, numbering.row_count(rank))?;
        let ghosts = Scatter::new(&template, local.rows())?;
        let unknowns = local.unknown_count();
        Ok(Self {
            buffers: RefCell::new(Buffers {
                u: vec![0.0; unknowns],
                a: vec![0.0; unknowns],
                residual: vec![0.0; unknowns],
            }),
            comm,
            partition,
            numbering,
            local,
            ghosts,
            template,
            events: Events {
                residual: Event::new("SheetResidual")?,
                both: Event::new("SheetResAndJac")?,
                jacobian: Event::new("SheetJacobian")?,
            },
        })
    }

    /// The communicator.
    pub fn comm(&self) -> &SimpleCommunicator {
        &self.comm
    }

    /// The problem, the same on every rank.
    pub fn problem(&self) -> &Problem {
        self.local.problem()
    }

    /// This rank's subdomain.
    pub fn local(&self) -> &Subdomain {
        &self.local
    }

    fn numbering(&self) -> &Numbering {
        &self.numbering
    }

    fn partition(&self) -> &Partition {
        &self.partition
    }

    /// Unknowns over all ranks.
    pub fn unknown_count(&self) -> usize {
        self.numbering.rank_rows[self.numbering.rank_rows.len() - 1]
    }

    /// Number of displacements this rank owns; they come first among its rows.
    pub fn owned_displacements(&self) -> usize {
        self.numbering.displacement_count(self.comm.rank() as usize)
    }

    /// A vector with the layout of the unknowns.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn vector(&self) -> petsc::Result<Vector> {
        self.template.duplicate()
    }

    /// An empty Jacobian with its pattern.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn matrix(&self) -> petsc::Result<Matrix> {
        let (rows, columns) = self.local.jacobian_pattern();
        Matrix::from_coo(&self.comm, self.template.local_size()?, &rows, &columns)
    }

    /// A matrix of the Jacobian's size that keeps no entries, for a solver that is not asked for any.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn placeholder_matrix(&self) -> petsc::Result<Matrix> {
        Matrix::placeholder(&self.comm, self.template.local_size()?)
    }

    /// Lower and upper bounds: gaps are not negative, everything else is free.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn bounds(&self) -> petsc::Result<(Vector, Vector)> {
        let (mut lower, mut upper) = (self.vector()?, self.vector()?);
        lower.set_all(-petsc::INFINITY)?;
        upper.set_all(petsc::INFINITY)?;
        let mut write = lower.write()?;
        for gap in self.owned_gaps() {
            write[gap] = 0.0;
        }
        drop(write);
        Ok((lower, upper))
    }

    /// Positions of the gaps among the rows this rank owns. They follow the displacements.
    fn owned_gaps(&self) -> impl Iterator<Item = usize> {
        let first = self.owned_displacements();
        (0..self.local.contacts.len()).map(move |point| first + UNKNOWNS_PER_POINT * point + 1)
    }

    /// The undeformed sheet resting on the die, with the gaps it has and a first guess of where it
    /// will be held. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn initial_unknowns(&self) -> petsc::Result<Vector> {
        let mut unknowns = self.vector()?;
        unknowns.set_all(0.0)?;
        let starts = self
            .local
            .start_values(|mine| ranks::smallest(&self.comm, mine));
        let mut write = unknowns.write()?;
        for (gap, start) in self.owned_gaps().zip(starts) {
            write[gap - 1] = start.multiplier;
            write[gap] = start.gap;
        }
        drop(write);
        Ok(unknowns)
    }

    /// Residual at time `t`, unknowns `u` and accelerations `a` (none in statics), starting from the history.
    /// Collective.
    ///
    /// # Errors
    /// On a rank with an element that cannot be evaluated; the other ranks learn of it from PETSc.
    pub fn residual(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
        a: Option<&VectorRef>,
        out: &mut VectorRef,
    ) -> Result<(), EvaluationError> {
        let _event = self.events.residual.begin();
        self.evaluate(history, t, (u, a), None, out)
    }

    /// The residual, and in `entries` all of a Jacobian at the same place but its inertia, for [`System::jacobian`]: an
    /// element has its force on the way to its stiffness, so both take little more than the Jacobian alone. Collective.
    ///
    /// # Errors
    /// As [`System::residual`].
    pub fn residual_and_stiffness(
        &self,
        history: &History,
        t: f64,
        at: (&VectorRef, Option<&VectorRef>),
        entries: &mut JacobianEntries,
        out: &mut VectorRef,
    ) -> Result<(), EvaluationError> {
        let _event = self.events.both.begin();
        self.evaluate(history, t, at, Some(entries), out)
    }

    fn evaluate(
        &self,
        history: &History,
        t: f64,
        (u, a): (&VectorRef, Option<&VectorRef>),
        stiffness: Option<&mut JacobianEntries>,
        out: &mut VectorRef,
    ) -> Result<(), EvaluationError> {
        let buffers = &mut *self.buffers.borrow_mut();
        self.ghosts.forward(u, &mut buffers.u)?;
        match a {
            Some(a) => self.ghosts.forward(a, &mut buffers.a)?,
            None => buffers.a.fill(0.0),
        }
        let Buffers { u, a, residual } = buffers;
        let evaluated = self.local.residual(history, t, (u, a), stiffness, residual);
        // The sum is collective: every rank takes part, whatever happened on it.
        out.set_all(0.0)?;
        self.ghosts.reverse_add(residual, out)?;
        Ok(evaluated?)
    }

    /// Room for this rank's entries of a Jacobian.
    pub fn jacobian_entries(&self) -> JacobianEntries {
        JacobianEntries::new(&self.local)
    }

    /// Evaluates this rank's entries of the Jacobian at time `t` and unknowns `u`, with `shift` the derivative of the
    /// acceleration by the unknown, for a [`CondensedSolve`] or for the matrix of [`System::matrix`]. Collective.
    ///
    /// # Errors
    /// As [`System::residual`].
    pub fn jacobian(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
        shift: f64,
        entries: &mut JacobianEntries,
    ) -> Result<(), EvaluationError> {
        let _event = self.events.jacobian.begin();
        let buffers = &mut *self.buffers.borrow_mut();
        self.ghosts.forward(u, &mut buffers.u)?;
        Ok(self
            .local
            .jacobian(history, t, &buffers.u, shift, entries)?)
    }

    /// The history after an accepted step to time `t` and unknowns `u`. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated at `u`, the same on every rank.
    pub fn advance(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
    ) -> Result<History, SystemError> {
        let values = self.local_values(u)?;
        let mine = history.advanced(&self.local, t, &values);
        Ok(FailedElement::agree(&self.comm, mine)?)
    }

    /// Measures of the state at time `t` and unknowns `u`, whose history this is; without rates it rests. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated at `u`, the same on every rank.
    pub fn measures(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
        rates: Option<Rates<'_>>,
    ) -> Result<Measures, SystemError> {
        let u = self.local_values(u)?;
        let (v, a) = match rates {
            Some(rates) => (
                self.local_values(rates.velocity)?,
                self.local_values(rates.acceleration)?,
            ),
            None => (vec![0.0; u.len()], vec![0.0; u.len()]),
        };
        let mine = self.local.measure(history, t, &u, &v, &a);
        let mine = FailedElement::agree(&self.comm, mine)?;
        Ok(mine.over_ranks(&self.comm, self.problem().whole_sheet))
    }

    /// States of this rank's contact points at an iterate that starts from the history. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn contact_states(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
    ) -> petsc::Result<Vec<ContactState>> {
        let values = self.local_values(u)?;
        Ok(self.local.contact_states(history, t, &values))
    }

    /// The local values of `u`: x and y of each local node, multiplier and gap of each local contact
    /// point. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn local_values(&self, u: &VectorRef) -> petsc::Result<Vec<f64>> {
        let mut values = vec![0.0; self.local.unknown_count()];
        self.ghosts.forward(u, &mut values)?;
        Ok(values)
    }

    /// Adds the local pairs of all ranks node by node, so that each rank has the sum at each of its
    /// nodes. Collective.
    fn sum_over_ranks(&self, local: &mut [f64]) -> petsc::Result<()> {
        let mut global = self.vector()?;
        global.set_all(0.0)?;
        self.ghosts.reverse_add(local, &mut global)?;
        self.ghosts.forward(&global, local)
    }
}
