//! The system over all ranks: PETSc's vectors and matrices around each rank's share.

use std::cell::{Ref, RefCell};

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Root};
use petsc::log::Event;
use petsc::{Evaluation, Failure, Matrix, MatrixRef, Scatter, Vector, VectorRef};

use super::evaluate::ElementFailure;
use super::{LocalSystem, Measures, Numbering, PartialMeasures, Problem, UNKNOWNS_PER_POINT};
use crate::contact::ContactState;
use crate::mesh::{Partition, PartitionError, partition};

/// The system could not be set up or evaluated.
#[derive(Debug, thiserror::Error)]
pub enum SystemError {
    /// METIS refused.
    #[error(transparent)]
    Partition(#[from] PartitionError),
    /// An accepted state cannot be evaluated.
    #[error(transparent)]
    Element(#[from] ElementFailure),
    /// PETSc failed.
    #[error(transparent)]
    Petsc(#[from] petsc::Error),
}

/// Work arrays of one rank, allocated once.
struct Scratch {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    residual: Vec<f64>,
    jacobian: Vec<f64>,
}

/// The discrete problem over all ranks of a communicator. Evaluations leave the committed history
/// alone; [`System::commit`] moves it on.
pub struct System {
    comm: SimpleCommunicator,
    /// Rank of every element.
    pub(super) parts: Partition,
    pub(super) numbering: Numbering,
    pub(super) local: RefCell<LocalSystem>,
    scatter: Scatter,
    template: Vector,
    scratch: RefCell<Scratch>,
    /// Why the last evaluation on this rank failed.
    failure: RefCell<Option<ElementFailure>>,
    events: Events,
}

struct Events {
    residual: Event,
    jacobian: Event,
}

impl System {
    /// Partitions the mesh on rank 0 and builds every rank's share. Collective.
    ///
    /// # Errors
    /// If METIS or PETSc fails.
    pub fn new(problem: Problem, comm: SimpleCommunicator) -> Result<Self, SystemError> {
        let parts = partition_on_root(&problem, &comm)?;
        Ok(Self::with_partition(problem, parts, comm)?)
    }

    /// As [`System::new`] with the elements' ranks given.
    pub(super) fn with_partition(
        problem: Problem,
        parts: Partition,
        comm: SimpleCommunicator,
    ) -> petsc::Result<Self> {
        let (ranks, rank) = (comm.size() as usize, comm.rank() as usize);
        let numbering = Numbering::new(&problem, &parts, ranks);
        let local = LocalSystem::new(problem, &parts, &numbering, rank);
        let template = Vector::new(&comm, numbering.row_count(rank))?;
        let scatter = Scatter::new(&template, local.rows())?;
        let unknowns = local.unknown_count();
        Ok(Self {
            scratch: RefCell::new(Scratch {
                u: vec![0.0; unknowns],
                v: vec![0.0; unknowns],
                a: vec![0.0; unknowns],
                residual: vec![0.0; unknowns],
                jacobian: vec![0.0; local.jacobian_entries()],
            }),
            comm,
            parts,
            numbering,
            local: RefCell::new(local),
            scatter,
            template,
            failure: RefCell::new(None),
            events: Events {
                residual: Event::new("SheetResidual")?,
                jacobian: Event::new("SheetJacobian")?,
            },
        })
    }

    /// The communicator.
    pub fn comm(&self) -> &SimpleCommunicator {
        &self.comm
    }

    /// This rank's share.
    pub fn local(&self) -> Ref<'_, LocalSystem> {
        self.local.borrow()
    }

    /// Unknowns over all ranks.
    pub fn unknown_count(&self) -> usize {
        self.numbering.rank_rows[self.numbering.rank_rows.len() - 1]
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
        let (rows, columns) = self.local().jacobian_pattern();
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

    /// Number of displacements this rank owns; they come first among its rows.
    pub fn owned_displacements(&self) -> usize {
        self.numbering.displacement_count(self.comm.rank() as usize)
    }

    /// Positions of the gaps among the rows this rank owns. They follow the displacements.
    fn owned_gaps(&self) -> impl Iterator<Item = usize> {
        let first = self.owned_displacements();
        (0..self.local().contacts.len()).map(move |point| first + UNKNOWNS_PER_POINT * point + 1)
    }

    /// The undeformed sheet resting on the die, with the gaps it has and a first guess of where it
    /// will be held: see [`LocalSystem::seeds`].
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn initial_unknowns(&self) -> petsc::Result<Vector> {
        let mut unknowns = self.vector()?;
        unknowns.set_all(0.0)?;
        let local = self.local();
        let seeds = local.seeds(|mine| {
            let mut all = vec![0.0; mine.len() * self.comm.size() as usize];
            self.comm.all_gather_into(mine, &mut all[..]);
            all
        });
        let mut write = unknowns.write()?;
        for (point, gap) in self.owned_gaps().enumerate() {
            let seed = &seeds[point];
            write[gap - 1] = seed.multiplier;
            write[gap] = seed.gap;
        }
        drop(write);
        Ok(unknowns)
    }

    /// Residual at time `t`, unknowns `u` and accelerations `a` (none in statics). Collective.
    ///
    /// # Errors
    /// [`Failure::Domain`] if an element is inverted; [`System::take_failure`] tells which.
    pub fn residual(
        &self,
        t: f64,
        u: &VectorRef,
        a: Option<&VectorRef>,
        out: &mut VectorRef,
    ) -> Evaluation {
        let _event = self.events.residual.begin();
        let mut scratch = self.scratch.borrow_mut();
        let Scratch {
            u: local_u,
            a: local_a,
            residual,
            ..
        } = &mut *scratch;
        self.scatter.forward(u, local_u)?;
        match a {
            Some(a) => self.scatter.forward(a, local_a)?,
            None => local_a.fill(0.0),
        }
        let evaluated = self.local().residual(t, local_u, local_a, residual);
        // The sum is collective: every rank takes part, whatever happened on it.
        out.set_all(0.0)?;
        self.scatter.reverse_add(residual, out)?;
        self.note(evaluated)
    }

    /// Jacobian at time `t` and unknowns `u`, with `shift` the derivative of the acceleration by the
    /// unknown, for `out` (unless it is a placeholder) and for [`CondensedSolve`](super::CondensedSolve).
    /// Collective.
    ///
    /// # Errors
    /// As [`System::residual`].
    pub fn jacobian(&self, t: f64, u: &VectorRef, shift: f64, out: &mut MatrixRef) -> Evaluation {
        let _event = self.events.jacobian.begin();
        let mut scratch = self.scratch.borrow_mut();
        let Scratch {
            u: local_u,
            jacobian,
            ..
        } = &mut *scratch;
        self.scatter.forward(u, local_u)?;
        let evaluated = self.local().jacobian(t, local_u, shift, jacobian);
        if out.takes_values()? {
            out.set_values_coo(jacobian)?;
        }
        self.note(evaluated)
    }

    /// Vertical sum of the equilibrium rows of a residual as a force of the whole sheet, N. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn vertical_sum(&self, residual: &VectorRef) -> petsc::Result<f64> {
        let count = self.owned_displacements();
        let mine: f64 = residual.read()?[..count]
            .chunks_exact(2)
            .map(|xy| xy[1])
            .sum();
        let mut sum = 0.0;
        self.comm
            .all_reduce_into(&mine, &mut sum, SystemOperation::sum());
        let local = self.local();
        let problem = local.problem();
        Ok(problem.whole_sheet * problem.young_modulus * sum)
    }

    /// Strongest pull of a contact point among the unknowns `u` as a force of the whole sheet, N; 0 if
    /// none pulls. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn strongest_pull(&self, u: &VectorRef) -> petsc::Result<f64> {
        let first = self.owned_displacements();
        let mine = u.read()?[first..]
            .chunks_exact(UNKNOWNS_PER_POINT)
            .fold(0.0_f64, |pull, point| pull.max(-point[0]));
        let mut pull = 0.0;
        self.comm
            .all_reduce_into(&mine, &mut pull, SystemOperation::max());
        let local = self.local();
        let problem = local.problem();
        Ok(problem.whole_sheet * problem.young_modulus * pull)
    }

    /// Largest displacement among the unknowns `u`, mm. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn largest_displacement(&self, u: &VectorRef) -> petsc::Result<f64> {
        let count = self.owned_displacements();
        let mine = u.read()?[..count]
            .iter()
            .fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let mut largest = 0.0;
        self.comm
            .all_reduce_into(&mine, &mut largest, SystemOperation::max());
        Ok(largest)
    }

    /// This rank's entries of the last Jacobian, in the order of [`LocalSystem::jacobian_pattern`].
    pub(super) fn jacobian_values(&self) -> Ref<'_, [f64]> {
        Ref::map(self.scratch.borrow(), |scratch| &scratch.jacobian[..])
    }

    fn note(&self, evaluated: Result<(), ElementFailure>) -> Evaluation {
        evaluated.map_err(|failure| {
            self.failure.replace(Some(failure));
            Failure::Domain
        })
    }

    /// Takes why the last evaluation on this rank failed, if it did since it was last asked.
    pub fn take_failure(&self) -> Option<ElementFailure> {
        self.failure.take()
    }

    /// Takes the states at time `t` and unknowns `u` as history. Collective.
    ///
    /// # Errors
    /// If an element cannot be evaluated at `u`.
    pub fn commit(&self, t: f64, u: &VectorRef) -> Result<(), SystemError> {
        let mut scratch = self.scratch.borrow_mut();
        self.scatter.forward(u, &mut scratch.u)?;
        self.local.borrow_mut().commit(t, &scratch.u)?;
        Ok(())
    }

    /// Measures of the state at time `t`, unknowns `u` and velocities `v`; accelerations are those of
    /// the last residual. The history must be that of `u`. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated at `u`.
    pub fn measures(
        &self,
        t: f64,
        u: &VectorRef,
        v: Option<&VectorRef>,
    ) -> Result<Measures, SystemError> {
        let mut scratch = self.scratch.borrow_mut();
        let Scratch {
            u: local_u,
            v: local_v,
            a,
            ..
        } = &mut *scratch;
        self.scatter.forward(u, local_u)?;
        match v {
            Some(v) => self.scatter.forward(v, local_v)?,
            None => local_v.fill(0.0),
        }
        let local = self.local();
        let mine = local.measure(t, local_u, local_v, a)?;
        let mut all = PartialMeasures::default();
        let sum = SystemOperation::sum();
        self.comm
            .all_reduce_into(&mine.sums[..], &mut all.sums[..], sum);
        let max = SystemOperation::max();
        self.comm
            .all_reduce_into(&mine.maxima[..], &mut all.maxima[..], max);
        Ok(Measures::from_reduced(&all, local.problem().whole_sheet))
    }

    /// States of this rank's contact points at an iterate. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn contact_states(&self, t: f64, u: &VectorRef) -> petsc::Result<Vec<ContactState>> {
        let values = self.local_values(u)?;
        Ok(self.local().contact_states(t, &values))
    }

    /// Sums of counts over the ranks. Collective.
    pub fn count_over_ranks<const N: usize>(&self, mine: [usize; N]) -> [usize; N] {
        let mine = mine.map(|count| count as u64);
        let mut all = [0_u64; N];
        self.comm
            .all_reduce_into(&mine[..], &mut all[..], SystemOperation::sum());
        all.map(|count| count as usize)
    }

    /// The local values of `u`: x and y of each local node, multiplier and gap of each local contact
    /// point. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn local_values(&self, u: &VectorRef) -> petsc::Result<Vec<f64>> {
        let mut values = vec![0.0; self.scratch.borrow().u.len()];
        self.scatter.forward(u, &mut values)?;
        Ok(values)
    }

    /// Adds the local pairs of all ranks node by node, so that each rank has the sum at each of its
    /// nodes. Collective.
    pub(super) fn sum_over_ranks(&self, local: &mut [f64]) -> petsc::Result<()> {
        let mut global = self.vector()?;
        global.set_all(0.0)?;
        self.scatter.reverse_add(local, &mut global)?;
        self.scatter.forward(&global, local)
    }
}

/// Every element's rank: METIS runs on rank 0, its result or its failure is the same everywhere.
fn partition_on_root(
    problem: &Problem,
    comm: &SimpleCommunicator,
) -> Result<Partition, PartitionError> {
    let ranks = comm.size() as usize;
    if ranks == 1 {
        return partition(&problem.mesh, 1);
    }
    // METIS is deterministic, so a rank that needs the message of a failure can ask it again.
    let mut parts: Vec<u64> = vec![u64::MAX; problem.mesh.elements.len()];
    if comm.rank() == 0
        && let Ok(found) = partition(&problem.mesh, ranks)
    {
        parts = found.into_iter().map(|part| part as u64).collect();
    }
    comm.process_at_rank(0).broadcast_into(&mut parts[..]);
    if parts[0] == u64::MAX {
        return partition(&problem.mesh, ranks);
    }
    Ok(parts.into_iter().map(|part| part as usize).collect())
}
