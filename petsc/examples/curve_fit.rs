//! Least squares within bounds: the constants of `y = a exp(-b t)` from samples that all ranks share out among them.
//!
//!     cargo run -p petsc --example curve_fit -- -tao_monitor
//!     cargo build -p petsc --example curve_fit && mpirun -n 2 target/debug/examples/curve_fit -tao_view
//!
//! The program ends with code 1 if the constants found are not those of the samples.

use std::{error::Error, process::ExitCode};

use mpi::{
    Threading,
    topology::{Communicator, SimpleCommunicator},
    traits::Root,
};
use petsc::{Matrix, Session, Tao, Vector, VectorRef};

/// Samples of each rank.
const SAMPLES: usize = 20;
/// What the samples are made with.
const EXACT: [f64; 2] = [2.0, 0.7];
/// Where the search starts.
const START: [f64; 2] = [1.0, 1.5];

fn main() -> ExitCode {
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        return ExitCode::FAILURE;
    };
    match fit(&universe.world()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("curve_fit: {error}");
            universe.world().abort(1)
        }
    }
}

/// The constants, which rank 0 owns, on every rank.
fn constants(comm: &SimpleCommunicator, x: &VectorRef) -> petsc::Result<[f64; 2]> {
    let mut all = [0.0; 2];
    if let &[a, b] = &x.read()?[..] {
        all = [a, b];
    }
    comm.process_at_rank(0).broadcast_into(&mut all[..]);
    Ok(all)
}

/// Whether the constants found are the exact ones.
fn fit(comm: &SimpleCommunicator) -> Result<bool, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let _session = Session::new(&arguments)?;
    let owned = if comm.rank() == 0 { 2 } else { 0 };
    let mut x = Vector::new(comm, owned)?;
    let (mut lower, mut upper) = (x.duplicate()?, x.duplicate()?);
    x.write()?.copy_from_slice(&START[..owned]);
    lower.set_all(0.0)?;
    upper.set_all(10.0)?;

    let samples = Vector::new(comm, SAMPLES)?;
    let first = samples.ownership_range()?.start;
    let times = (first..).take(SAMPLES).map(|i| 0.1 * f64::from(i));
    let times: Vec<f64> = times.collect();
    let mut tao = Tao::new(comm)?;
    let (world, t) = (comm.duplicate(), times.clone());
    tao.set_residual(&samples, move |x, r| {
        let [a, b] = constants(&world, x)?;
        for (r, t) in r.write()?.iter_mut().zip(&t) {
            *r = a * (-b * t).exp() - EXACT[0] * (-EXACT[1] * t).exp();
        }
        Ok(())
    })?;
    let rows: Vec<i32> = (first..).take(SAMPLES).flat_map(|i| [i, i]).collect();
    let columns = [0, 1].repeat(SAMPLES);
    let matrix = Matrix::rectangular_from_coo(comm, [SAMPLES, owned], &rows, &columns)?;
    let world = comm.duplicate();
    tao.set_residual_jacobian(matrix, move |x, matrix| {
        let [a, b] = constants(&world, x)?;
        let row = |t: &f64| [(-b * t).exp(), -a * t * (-b * t).exp()];
        let entries: Vec<f64> = times.iter().flat_map(row).collect();
        Ok(matrix.set_values_coo(&entries)?)
    })?;
    tao.set_variable_bounds(&lower, &upper)?;
    tao.set_gradient_tolerance(1e-10)?;
    tao.set_from_options()?;
    let reason = tao.solve(&mut x)?;
    let found = constants(comm, &x)?;
    if comm.rank() == 0 {
        println!("{reason} after {} iterations", tao.iteration_number()?);
        println!("a = {}, b = {}", found[0], found[1]);
    }
    let near = |(found, exact): (&f64, &f64)| (found - exact).abs() < 1e-6;
    Ok(reason.is_converged() && found.iter().zip(&EXACT).all(near))
}
