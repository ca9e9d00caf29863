//! The derivatives over one accepted step.

use std::rc::Rc;

use cpu_time::ProcessTime;
use mpi::traits::Communicator;
use petsc::{AlphaParameters, CallbackError, VectorRef};

use super::released::ReleasedSlopes;
use super::solve::on_reduced_set;
use super::tracked::{Scheme, Tracked};
use super::{Beside, Cost, Slopes};
use crate::case::Parameter;
use crate::contact::ContactState;
use crate::ranks;
use crate::system::{
    CondensedSolve, Directions, ElementFailure, EvaluationError, History, JacobianEntries,
    LocalStep, System, Workspace,
};

/// The derivatives of a run by its parameters.
pub struct Sensitivity {
    pub(super) system: Rc<System>,
    solve: Rc<CondensedSolve>,
    entries: JacobianEntries,
    pub(super) tracked: Vec<Tracked>,
    work: Workspace,
    /// What the points did in the last step: Gauss points that yielded, and contact points.
    pub(super) flowing: Vec<bool>,
    contact: Vec<ContactState>,
    pub(super) cost: Cost,
    pub(super) released: Vec<ReleasedSlopes>,
    /// Whether derivatives cannot be had any more.
    pub(super) lost: bool,
}

/// A step that was accepted.
pub struct AcceptedStep<'a> {
    /// The history it started from.
    pub before: &'a History,
    /// The history it left.
    pub after: &'a History,
    /// Time at its end, ms.
    pub t: f64,
    /// Unknowns at its end.
    pub unknowns: &'a VectorRef,
    /// None in statics.
    pub inertia: Option<Inertia<'a>>,
}

/// How a step of the generalized-alpha method counts inertia.
pub struct Inertia<'a> {
    /// Length of the step, ms.
    pub dt: f64,
    /// Parameters in it.
    pub parameters: AlphaParameters,
    /// Acceleration in its equations, mm/ms².
    pub stage_acceleration: &'a VectorRef,
}

/// What a step adds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepSlopes {
    /// Points that did something else than in the step before.
    pub changed_points: u32,
    /// The most Gauss points over the parameters that yield on one side of its value only.
    pub doubtful_points: u32,
    /// In the order of the parameters; NaN where they cannot be had.
    pub by_parameter: Vec<Slopes>,
}

impl Sensitivity {
    /// At the accepted `unknowns` with their history, where nothing has happened yet. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn start(
        system: &Rc<System>,
        solve: Rc<CondensedSolve>,
        beside: Vec<Beside>,
        history: &History,
        unknowns: &VectorRef,
    ) -> petsc::Result<Self> {
        let tracked = beside
            .into_iter()
            .map(|beside| Tracked::start(system, beside));
        let u = system.local_values(unknowns)?;
        Ok(Self {
            solve,
            entries: system.jacobian_entries(),
            tracked: tracked.collect::<petsc::Result<_>>()?,
            work: Workspace::new(system.local()),
            flowing: history.flowing(history),
            contact: history.contact_states_at(system.local(), &u),
            system: Rc::clone(system),
            cost: Cost::default(),
            released: Vec::new(),
            lost: false,
        })
    }

    /// The parameters.
    pub fn parameters(&self) -> Vec<Parameter> {
        let parameter = |tracked: &Tracked| tracked.parameter;
        self.tracked.iter().map(parameter).collect()
    }

    /// What it has cost on this rank.
    pub fn cost(&self) -> Cost {
        self.cost
    }

    /// The derivatives of the released angles so far.
    pub fn into_released(self) -> Vec<ReleasedSlopes> {
        self.released
    }

    /// Follows an accepted step. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn step(&mut self, step: &AcceptedStep<'_>) -> Result<StepSlopes, CallbackError> {
        let began = ProcessTime::now();
        let system = Rc::clone(&self.system);
        let u = system.local_values(step.unknowns)?;
        let a = match &step.inertia {
            Some(inertia) => system.local_values(inertia.stage_acceleration)?,
            None => vec![0.0; u.len()],
        };
        let flowing = step.before.flowing(step.after);
        let contact = step.after.contact_states_at(system.local(), &u);
        let changed =
            count_changes(&flowing, &self.flowing) + count_changes(&contact, &self.contact);
        let [changed] = ranks::sums(system.comm(), [changed]);
        (self.flowing, self.contact) = (flowing, contact);
        let scheme = step.inertia.as_ref();
        let scheme = scheme.map(|inertia| Scheme::new(inertia.dt, inertia.parameters));
        let closed = system.closed_gaps(&u);
        self.lost = self.lost || !self.factor(step, scheme.as_ref(), &closed)?;
        self.cost.shared_seconds += began.elapsed().as_secs_f64();

        let began = ProcessTime::now();
        let mut slopes = StepSlopes {
            changed_points: u32::try_from(changed)?,
            ..StepSlopes::default()
        };
        let flowing = std::mem::take(&mut self.flowing);
        let local = LocalStep {
            before: step.before,
            after: step.after,
            flowing: &flowing,
            t: step.t,
            u: &u,
            a: &a,
        };
        for index in 0..self.tracked.len() {
            let found = match self.lost {
                true => None,
                false => self.by_parameter(index, &local, scheme.as_ref(), &closed)?,
            };
            self.lost |= found.is_none();
            let (by, doubtful) = found.unwrap_or((NOT_KNOWN, 0));
            slopes.by_parameter.push(by);
            slopes.doubtful_points = slopes.doubtful_points.max(doubtful);
        }
        self.flowing = flowing;
        self.cost.parameter_seconds += began.elapsed().as_secs_f64();
        Ok(slopes)
    }

    /// Factorises the tangent of the converged state. Whether it can be used, the same on every rank. Collective.
    fn factor(
        &mut self,
        step: &AcceptedStep<'_>,
        scheme: Option<&Scheme>,
        closed: &[i32],
    ) -> petsc::Result<bool> {
        let shift = scheme.map_or(0.0, Scheme::shift);
        let (system, entries) = (&self.system, &mut self.entries);
        let evaluated = system.jacobian(step.before, step.t, step.unknowns, shift, entries);
        let failed = match evaluated {
            Err(EvaluationError::Petsc(error)) => return Err(error),
            Err(EvaluationError::Element(_)) => true,
            Ok(()) => false,
        };
        if ranks::lowest_failing(system.comm(), failed).is_some() {
            return Ok(false);
        }
        self.cost.factorisations += 1;
        self.solve.factor(&self.entries, closed)
    }

    /// The derivatives by one parameter, and its number of doubtful points; none if an element cannot be evaluated beside
    /// the solution. Collective.
    fn by_parameter(
        &mut self,
        index: usize,
        step: &LocalStep<'_>,
        scheme: Option<&Scheme>,
        closed: &[i32],
    ) -> petsc::Result<Option<(Slopes, u32)>> {
        let Self {
            system,
            tracked,
            work,
            ..
        } = self;
        let (comm, tracked) = (system.comm(), &mut tracked[index]);
        let displacements = system.owned_displacements();
        // Near the derivatives to come nearly all points yield or do not yield on both sides as they do in the solution,
        // which at held unknowns they would not: the guess is those of the last step.
        let mut guess = system.local_values(&tracked.unknowns)?;
        system.local().limit_guess(step.u, &mut guess);
        let mut acceleration = system.vector()?;
        if let Some(scheme) = scheme {
            tracked.guess_acceleration(scheme, displacements, &mut acceleration)?;
        }
        let along = Directions {
            history: &tracked.history,
            u: &guess,
            a: &system.local_values(&acceleration)?,
        };
        let mut shares = vec![0.0; step.u.len()];
        let evaluated = tracked
            .variation
            .residual_slope(step, &along, work, &mut shares);
        if fails(comm, &evaluated) {
            return Ok(None);
        }
        let mut right_side = system.vector()?;
        system.sum_of_shares(&shares, &mut right_side)?;
        right_side.scale(-1.0)?;
        let correction = on_reduced_set(system, &self.solve, closed, &right_side)?;
        self.cost.solves += 1;
        let mut du = system.local_values(&correction)?;
        du.iter_mut()
            .zip(&guess)
            .for_each(|(du, guess)| *du += guess);
        let unknowns = system.own_values(&du)?;
        let advanced = tracked
            .variation
            .advance(step, &du, work, &mut tracked.history);
        if fails(comm, &advanced) {
            return Ok(None);
        }
        tracked.move_on(unknowns, scheme, displacements)?;
        let (force, doubtful) = advanced.unwrap_or_default();
        let [force, doubtful] = ranks::sums(comm, [force, doubtful as f64]);
        let shape = tracked.variation.shape_slopes(step.u, &du);
        let [dy_a, angle] = shape.over_ranks(comm);
        let force = system.problem().whole_sheet * force;
        Ok(Some((Slopes { force, angle, dy_a }, doubtful as u32)))
    }
}

/// In place of derivatives that cannot be had.
const NOT_KNOWN: Slopes = Slopes {
    force: f64::NAN,
    angle: f64::NAN,
    dy_a: f64::NAN,
};

/// Whether it failed on any rank. Collective.
fn fails<T>(comm: &impl Communicator, mine: &Result<T, ElementFailure>) -> bool {
    ranks::lowest_failing(comm, mine.is_err()).is_some()
}

fn count_changes<T: PartialEq>(now: &[T], before: &[T]) -> u64 {
    now.iter().zip(before).filter(|(a, b)| a != b).count() as u64
}
