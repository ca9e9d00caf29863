//! A matrix that is a closure: `A = I + e eᵀ`, full, but with a cheap product. Conjugate gradients need two iterations.
//!
//!     cargo run -p petsc --example shell_matrix -- -ksp_monitor
//!     cargo build -p petsc --example shell_matrix && mpirun -n 2 target/debug/examples/shell_matrix
//!
//! The program ends with code 1 if the solution found is not the exact one.

use std::{error::Error, process::ExitCode};

use mpi::{
    Threading,
    topology::{Communicator, SimpleCommunicator},
};
use petsc::{Ksp, Matrix, Session, Vector};

/// Rows of each rank.
const ROWS: usize = 1000;

fn main() -> ExitCode {
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        return ExitCode::FAILURE;
    };
    match solve(&universe.world()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("shell_matrix: {error}");
            universe.world().abort(1)
        }
    }
}

/// Whether the solution is the exact one.
fn solve(comm: &SimpleCommunicator) -> Result<bool, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let _session = Session::new(&arguments)?;
    let mut exact = Vector::new(comm, ROWS)?;
    let first = exact.ownership_range()?.start;
    for (i, x) in (first..).zip(exact.write()?.iter_mut()) {
        *x = f64::from(i).sin();
    }
    let mut ones = exact.duplicate()?;
    ones.set_all(1.0)?;
    let matrix = Matrix::shell(comm, ROWS, move |x, y| {
        let sum = x.sum()?; // collective, and reached by every rank
        Ok(y.waxpy(sum, &ones, x)?)
    })?;

    let (mut b, mut x) = (exact.duplicate()?, exact.duplicate()?);
    matrix.mult(&exact, &mut b)?;
    let mut ksp = Ksp::new(comm)?;
    ksp.set_operator(&matrix)?;
    ksp.set_type("cg")?;
    ksp.set_preconditioner("none")?; // nothing can be built from a closure
    ksp.set_from_options()?;
    let reason = ksp.solve(&b, &mut x)?;
    x.axpy(-1.0, &exact)?;
    let error = x.norm_max()?;
    if comm.rank() == 0 {
        println!("{reason} after {} iterations", ksp.iteration_number()?);
        println!("largest error {error:.1e}");
    }
    Ok(reason.is_converged() && error < 1e-8)
}
