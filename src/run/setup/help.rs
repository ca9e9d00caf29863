//! `-help`: PETSc prints what its objects read, so the objects of a run have to be there.

use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Failure, Ts};

use super::{LinearSolve, defaults, linear};
use crate::case::{Case, Dynamics};
use crate::run::error::RunError;
use crate::system::{Problem, System};

/// Elements along and through the sheet that the objects are made for: enough for each rank to have some.
const ELEMENTS: [usize; 2] = [8, 2];

/// Makes the time stepper and the solvers of a run with this case, on a coarse sheet, and lets them read their options.
/// Collective.
///
/// # Errors
/// PETSc's words about a value it does not know.
pub(in crate::run) fn show(case: &Case, comm: &SimpleCommunicator) -> Result<(), RunError> {
    defaults::set(case)?;
    let mut coarse = case.clone();
    let ranks = comm.size().unsigned_abs() as usize;
    (coarse.discretisation.nx, coarse.discretisation.ny) = (ELEMENTS[0] * ranks, ELEMENTS[1]);
    let system = Rc::new(System::new(Problem::new(&coarse), comm.duplicate())?);
    let linear = LinearSolve::chosen(&system)?;
    let mut ts = Ts::new(system.comm())?;
    let start = system.initial_unknowns()?;
    let shift = pose(&mut ts, case.loading.dynamics, &start, &linear)?;
    ts.snes_mut()?.set_type(linear::SOLVER)?;
    linear.install(ts.snes_mut()?)?;
    ts.set_from_options()?;
    Ok(linear.read_options(&start, shift)?)
}

/// Makes the time stepper the one of these equations, which are not solved; returns a shift of the acceleration with which the
/// sheet at rest has a regular tangent.
fn pose(
    ts: &mut Ts,
    dynamics: Dynamics,
    start: &petsc::VectorRef,
    linear: &LinearSolve,
) -> Result<f64, RunError> {
    const NOT_SOLVED: &str = "nothing is solved for -help";
    let matrix = linear.matrix()?;
    match dynamics {
        Dynamics::Slow => {
            ts.set_second_order(
                start,
                matrix,
                |_, _, _, _, _| Err(Failure::Domain),
                |_, _, _, _, _, _, _| Err(NOT_SOLVED.into()),
            )?;
            Ok(1.0)
        }
        Dynamics::None => {
            ts.set_implicit(
                start,
                matrix,
                |_, _, _, _| Err(Failure::Domain),
                |_, _, _, _, _| Err(NOT_SOLVED.into()),
            )?;
            Ok(0.0)
        }
    }
}
