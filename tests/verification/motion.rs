//! Problems in time, by PETSc's generalized-alpha method as in a simulation.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{CallbackError, Failure, Ts, TsReason, VectorRef};
use ssnp155::system::{Problem, System};

use crate::row::Result;
use crate::statics::{Touching, start_unknowns};

/// Density of aluminium, g/mm³.
pub const DENSITY: f64 = 2.7e-3;

/// Where the nodes are at the start, and how fast, for their reference coordinates.
pub struct Start<'a> {
    pub displacement: &'a dyn Fn([f64; 2]) -> [f64; 2],
    pub velocity: &'a dyn Fn([f64; 2]) -> [f64; 2],
}

/// Integrates with a spectral radius and `steps` of a length; gives what `observe` says of system, time,
/// unknowns and velocities after each step.
pub fn integrate<T: 'static>(
    world: &SimpleCommunicator,
    model: Problem,
    start: &Start,
    radius: f64,
    (dt, steps): (f64, usize),
    observe: impl Fn(&System, f64, &VectorRef, &VectorRef) -> std::result::Result<T, CallbackError>
    + 'static,
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
    ts.set_second_order(
        &u,
        system.matrix()?,
        move |t, u, _, a, out| for_residual.residual(t, u, Some(a), out),
        move |t, u, _, _, _, shift, out| {
            let evaluated = for_jacobian.jacobian(t, u, shift, out);
            evaluated.map_err(|failure| match failure {
                Failure::Fatal(error) => error,
                Failure::Domain => CallbackError::from("no tangent"),
            })
        },
    )?;
    ts.set_solution2(&u, &v)?;
    let record: Rc<RefCell<Vec<T>>> = Rc::default();
    let (seen, this) = (Rc::clone(&record), Rc::clone(&system));
    ts.set_post_step(move |ts| {
        if ts.converged_reason()?.is_diverged() {
            return Ok(());
        }
        let (u, v) = ts.solution2()?;
        seen.borrow_mut().push(observe(&this, ts.time()?, u, v)?);
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
