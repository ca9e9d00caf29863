//! Problems in time, by PETSc's generalized-alpha method as in a simulation.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Alpha2State, CallbackError, Ts, TsReason, VectorRef};
use ssnp155::system::{EvaluationError, History, Measures, Problem, Rates, System};

use crate::row::Result;
use crate::statics::{Touching, start_unknowns};

/// Density of aluminium, g/mm³.
pub const DENSITY: f64 = 2.7e-3;

/// Where the nodes are at the start, and how fast, for their reference coordinates.
pub struct Start<'a> {
    pub displacement: &'a dyn Fn([f64; 2]) -> [f64; 2],
    pub velocity: &'a dyn Fn([f64; 2]) -> [f64; 2],
}

/// A state of the motion of an elastic body.
pub struct Moment<'a> {
    pub system: &'a System,
    pub history: &'a History,
    pub t: f64,
    pub u: &'a VectorRef,
    pub rates: Rates<'a>,
}

impl Moment<'_> {
    pub fn measures(&self) -> std::result::Result<Measures, CallbackError> {
        let measures = self
            .system
            .measures(self.history, self.t, self.u, Some(self.rates));
        Ok(measures?)
    }
}

/// Integrates with a spectral radius and `steps` of a length; returns what `observe` says of the state after each step.
/// The body stays elastic and without friction: its history does not move on.
pub fn integrate<T: 'static>(
    world: &SimpleCommunicator,
    model: Problem,
    start: &Start,
    radius: f64,
    (dt, steps): (f64, usize),
    observe: impl Fn(&Moment<'_>) -> std::result::Result<T, CallbackError> + 'static,
) -> Result<Vec<T>> {
    let nodes = model.mesh.nodes.clone();
    let system = Rc::new(System::new(model, world.duplicate())?);
    let mut u = start_unknowns(&system, Touching::All)?;
    let mut v = system.vector()?;
    for (pair, &x) in u.write()?.chunks_exact_mut(2).zip(&nodes) {
        pair.copy_from_slice(&(start.displacement)(x));
    }
    for (pair, &x) in v.write()?.chunks_exact_mut(2).zip(&nodes) {
        pair.copy_from_slice(&(start.velocity)(x));
    }
    let mut ts = Ts::new(world)?;
    ts.set_options_prefix("motion_")?;
    let (for_residual, for_jacobian) = (Rc::clone(&system), Rc::clone(&system));
    let history = Rc::new(History::virgin(system.local()));
    let (at_residual, at_jacobian) = (Rc::clone(&history), Rc::clone(&history));
    let entries = RefCell::new(system.jacobian_entries());
    ts.set_second_order(
        &u,
        system.matrix()?,
        move |t, u, _, a, out| Ok(for_residual.residual(&at_residual, t, u, Some(a), out)?),
        move |t, u, _, _, _, shift, out| {
            let mut entries = entries.borrow_mut();
            let evaluated = for_jacobian.jacobian(&at_jacobian, t, u, shift, &mut entries);
            out.set_values_coo(entries.values())?;
            evaluated.map_err(|error| match error {
                EvaluationError::Petsc(error) => error.into(),
                EvaluationError::Element(failure) => CallbackError::from(failure),
            })
        },
    )?;
    ts.set_solution2(&u, &v)?;
    let record: Rc<RefCell<Vec<T>>> = Rc::default();
    let (seen, this) = (Rc::clone(&record), Rc::clone(&system));
    let at_rest = system.vector()?;
    let rates = Rc::new(RefCell::new(Alpha2State::new(&ts, &at_rest)?));
    let follower = Rc::clone(&rates);
    ts.set_pre_stage(move |ts, _| Ok(follower.borrow_mut().attempt(ts)?))?;
    ts.set_post_step(move |ts| {
        if ts.converged_reason()?.is_diverged() {
            return Ok(());
        }
        let rates = &mut *rates.borrow_mut();
        rates.accepted(ts)?;
        let moment = Moment {
            system: &this,
            history: &history,
            t: ts.time()?,
            u: ts.solution()?,
            rates: Rates {
                velocity: rates.velocity(),
                acceleration: rates.stage_acceleration(),
            },
        };
        seen.borrow_mut().push(observe(&moment)?);
        Ok(())
    })?;
    let snes = ts.snes_mut()?;
    snes.set_type("vinewtonrsls")?;
    snes.set_shell_line_search(|_| Ok(1.0))?;
    ts.set_from_options()?;
    let (lower, upper) = system.bounds()?;
    ts.snes_mut()?.set_variable_bounds(&lower, &upper)?;
    ts.alpha2_set_radius(radius)?;
    ts.set_time_step(dt)?;
    ts.set_max_time(dt * steps as f64)?;
    let reason = ts.solve()?;
    if reason != TsReason::ConvergedTime {
        return Err(format!("the integration ended early: {reason:?}").into());
    }
    drop(ts);
    let record = Rc::into_inner(record).ok_or("the record is held")?;
    Ok(record.into_inner())
}
