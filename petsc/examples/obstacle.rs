//! An obstacle problem: a string under its own weight, `-u'' + 1 = 0` with u(0) = u(1) = 0, that must stay above -0.08.
//!
//!     cargo run -p petsc --example obstacle -- -snes_monitor
//!     cargo build -p petsc --example obstacle && mpirun -n 2 target/debug/examples/obstacle -n 400
//!
//! PETSc's reduced-space active-set Newton method solves the variational inequality. The exact solution touches the
//! obstacle for 0.4 <= x <= 0.6; the program ends with code 1 if the computed one is another.

use std::{error::Error, process::ExitCode};

use mpi::{
    Threading,
    collective::SystemOperation,
    topology::{Communicator, SimpleCommunicator},
    traits::CommunicatorCollectives,
};
use petsc::{Matrix, Scatter, Session, Snes, Vector, options};

const OBSTACLE: f64 = -0.08;

fn main() -> ExitCode {
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        return ExitCode::FAILURE;
    };
    // PETSc starts after MPI and ends before it: when `solve` returns, every object is gone.
    match solve(&universe.world()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("obstacle: {error}");
            universe.world().abort(1) // the other ranks may be waiting for this one
        }
    }
}

/// Whether the computed solution is the exact one.
fn solve(comm: &SimpleCommunicator) -> Result<bool, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let _session = Session::new(&arguments)?;
    // So that 0.4 and 0.6 are nodes.
    let intervals: i32 = options::get("n")?.map_or(Ok(50), |text| text.parse())?;
    if intervals < 5 || intervals % 5 != 0 {
        return Err(format!("-n {intervals} must be a multiple of 5, and positive").into());
    }
    let (nodes, spacing) = (intervals - 1, 1.0 / f64::from(intervals));

    // Each rank has a stretch of the string, and needs one node more at each end.
    let (rank, ranks) = (comm.rank(), comm.size());
    let mine = usize::try_from(nodes * (rank + 1) / ranks - nodes * rank / ranks)?;
    let mut u = Vector::new(comm, mine)?;
    let own = u.ownership_range()?;
    let inside = |i: &i32| (0..nodes).contains(i);
    let needed: Vec<i32> = (own.start - 1..=own.end).filter(inside).collect();
    let scatter = Scatter::new(&u, &needed)?;

    // The tangent matrix, entry by entry; entries in column -1 are ignored.
    let neighbours = |i: i32| [i, i - 1, i + 1].map(|j| if inside(&j) { j } else { -1 });
    let rows: Vec<i32> = own.clone().flat_map(|i| [i; 3]).collect();
    let columns: Vec<i32> = own.clone().flat_map(neighbours).collect();
    let matrix = Matrix::from_coo(comm, mine, &rows, &columns)?;
    let stiffness: Vec<f64> = [2.0, -1.0, -1.0].map(|k| k / spacing.powi(2)).repeat(mine);

    let mut snes = Snes::new(comm)?;
    snes.set_function(&u, {
        let own = own.clone();
        move |u, f| {
            let mut around = vec![0.0; needed.len()];
            scatter.forward(u, &mut around)?;
            let at = |i: i32| needed.binary_search(&i).map_or(0.0, |place| around[place]);
            for (i, f) in own.clone().zip(f.write()?.iter_mut()) {
                *f = (2.0 * at(i) - at(i - 1) - at(i + 1)) / spacing.powi(2) + 1.0;
            }
            Ok(())
        }
    })?;
    snes.set_jacobian(matrix, move |_, matrix| {
        Ok(matrix.set_values_coo(&stiffness)?)
    })?;

    snes.set_type("vinewtonrsls")?;
    // A direct solve unless the options choose another one.
    if petsc::has_external_package("mumps")? {
        options::set_default("pc_type", "lu")?;
        options::set_default("pc_factor_mat_solver_type", "mumps")?;
    } else {
        options::set_default("pc_type", "redundant")?;
    }
    snes.set_from_options()?;
    let (mut lower, mut upper) = (u.duplicate()?, u.duplicate()?);
    lower.set_all(OBSTACLE)?;
    upper.set_all(petsc::INFINITY)?;
    snes.set_variable_bounds(&lower, &upper)?;

    let reason = snes.solve(&mut u)?;
    let touching = i32::try_from(snes.active_set()?.len())?;
    let mut error: f64 = 0.0;
    for (i, u) in own.zip(u.read()?.iter()) {
        let x = f64::from(i + 1) * spacing;
        let x = x.min(1.0 - x).min(0.4);
        error = error.max((u - (x * x / 2.0 - 0.4 * x)).abs());
    }
    let (mut all_touching, mut largest) = (0, 0.0);
    comm.all_reduce_into(&touching, &mut all_touching, SystemOperation::sum());
    comm.all_reduce_into(&error, &mut largest, SystemOperation::max());
    if rank == 0 {
        println!("{reason} after {} iterations", snes.iteration_number()?);
        println!("{all_touching} of {nodes} nodes touch the obstacle");
        println!("largest error {largest:.1e}");
    }
    Ok(reason.is_converged() && largest < 1e-8)
}
