//! The derivatives over one accepted step.

use std::rc::Rc;

use cpu_time::ProcessTime;
use petsc::{AlphaParameters, CallbackError, Vector, VectorRef};

use super::released::ReleasedSlopes;
use super::solve::{Tangent, Wanted};
use super::tracked::{Scheme, Tracked};
use super::{Beside, Cost, Slopes};
use crate::case::Parameter;
use crate::contact::ContactState;
use crate::ranks;
use crate::system::{
    CondensedSolve, EvaluatedStep, EvaluationError, History, JacobianEntries, System,
};

/// The derivatives of a run by its parameters.
pub struct Sensitivity {
    pub(super) system: Rc<System>,
    solve: Rc<CondensedSolve>,
    entries: JacobianEntries,
    pub(super) tracked: Vec<Tracked>,
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
    /// The most Gauss points over the parameters that begin or cease to yield within a millionth of its value.
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
        let evaluated = system.local().evaluated(step.before, step.t, &u, &a);
        let failing = ranks::lowest_failing(system.comm(), evaluated.is_err());
        let evaluated = evaluated.ok().filter(|_| failing.is_none() && !self.lost);
        self.lost = evaluated.is_none();
        self.cost.shared_seconds += began.elapsed().as_secs_f64();

        let began = ProcessTime::now();
        let mut slopes = StepSlopes {
            changed_points: u32::try_from(changed)?,
            ..StepSlopes::default()
        };
        let tangent = Tangent {
            system: &system,
            entries: &self.entries,
            solve: &self.solve,
            closed: &closed,
            scheme: scheme.as_ref(),
        };
        match &evaluated {
            Some(evaluated) => {
                self.cost.solves += follow(&mut self.tracked, evaluated, &tangent, &mut slopes)?
            }
            None => slopes.by_parameter = vec![NOT_KNOWN; self.tracked.len()],
        }
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
}

/// Follows a step whose tangent is factorised, by all parameters, and returns the number of solves. Collective.
fn follow(
    tracked: &mut [Tracked],
    step: &EvaluatedStep<'_>,
    tangent: &Tangent<'_>,
    slopes: &mut StepSlopes,
) -> petsc::Result<u64> {
    let count = tangent.system.owned_displacements();
    let mut wanted = Vec::with_capacity(tracked.len());
    for tracked in &*tracked {
        wanted.push(Wanted {
            unknowns: tracked.guess(tangent.scheme, count)?,
            history: &tracked.history,
            tracked,
        });
    }
    let solves = tangent.solve(step, &mut wanted)?;
    let unknowns: Vec<Vector> = wanted.into_iter().map(|one| one.unknowns).collect();
    for (tracked, unknowns) in tracked.iter_mut().zip(unknowns) {
        let (by, doubtful) = tracked.advance(step, tangent, unknowns)?;
        slopes.by_parameter.push(by);
        slopes.doubtful_points = slopes.doubtful_points.max(doubtful);
    }
    Ok(solves)
}

impl Tracked {
    /// Takes the derivatives of the unknowns at the end of a step over. What follows from them, and the number of doubtful
    /// points. Collective.
    fn advance(
        &mut self,
        step: &EvaluatedStep<'_>,
        tangent: &Tangent<'_>,
        unknowns: Vector,
    ) -> petsc::Result<(Slopes, u32)> {
        let system = tangent.system;
        let du = system.local_values(&unknowns)?;
        let advanced = self.variation.advance(step, &du, &mut self.history);
        self.move_on(unknowns, tangent.scheme, system.owned_displacements())?;
        let mine = [advanced.force, advanced.doubtful_points as f64];
        let [force, doubtful] = ranks::sums(system.comm(), mine);
        let [dy_a, angle] = self
            .variation
            .shape_slopes(step, &du)
            .over_ranks(system.comm());
        let force = system.problem().whole_sheet * force;
        Ok((Slopes { force, angle, dy_a }, doubtful as u32))
    }
}

/// In place of derivatives that cannot be had.
const NOT_KNOWN: Slopes = Slopes {
    force: f64::NAN,
    angle: f64::NAN,
    dy_a: f64::NAN,
};

fn count_changes<T: PartialEq>(now: &[T], before: &[T]) -> u64 {
    now.iter().zip(before).filter(|(a, b)| a != b).count() as u64
}
