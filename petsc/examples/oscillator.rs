//! An oscillator in time by the generalized-alpha method: `u'' + u = 0`, u(0) = 1, u'(0) = 0, one on each rank.
//!
//!     cargo run -p petsc --example oscillator -- -radius 0.5
//!     cargo run -p petsc --example oscillator -- -ts_monitor
//!
//! The steps are halved three times. The program prints error and order of each, and ends with code 1 if the method is
//! not of second order. `-own_start` leaves the first step to PETSc, which is of first order before PETSc 3.22.

use std::{error::Error, process::ExitCode};

use mpi::{
    Threading,
    topology::{Communicator, SimpleCommunicator},
};
use petsc::{Matrix, Session, Ts, Vector, options};

fn main() -> ExitCode {
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        return ExitCode::FAILURE;
    };
    match study(&universe.world()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("oscillator: {error}");
            universe.world().abort(1)
        }
    }
}

/// Whether the method is of second order.
fn study(comm: &SimpleCommunicator) -> Result<bool, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let session = Session::new(&arguments)?;
    let radius: f64 = options::get("radius")?.map_or(Ok(0.5), |text| text.parse())?;
    let own_start = options::has("own_start")?;
    let mut order = 0.0;
    let mut before = None;
    for steps in [50, 100, 200, 400] {
        let error = integrate(comm, radius, own_start, steps)?;
        let mut line = format!("{steps:>4} steps  error {error:.3e}");
        if let Some(before) = before.replace(error) {
            order = f64::log2(before / error);
            line += &format!("  order {order:.2}");
        }
        if comm.rank() == 0 {
            println!("{line}");
        }
    }
    if comm.rank() == 0 {
        println!("PETSc {}", session.version());
    }
    Ok((order - 2.0).abs() < 0.1)
}

/// The error of displacement and velocity at t = 1.
fn integrate(
    comm: &SimpleCommunicator,
    radius: f64,
    own_start: bool,
    steps: i32,
) -> petsc::Result<f64> {
    let mut u = Vector::new(comm, 1)?;
    u.set_all(1.0)?;
    let v = u.duplicate()?; // zero
    let own = u.ownership_range()?.start;
    let matrix = Matrix::from_coo(comm, 1, &[own], &[own])?;
    let mut ts = Ts::new(comm)?;
    ts.set_second_order(
        &u,
        matrix,
        |_t, u, _v, a, f| Ok(f.waxpy(1.0, u, a)?),
        |_t, _u, _v, _a, _shift_v, shift_a, matrix| Ok(matrix.set_values_coo(&[1.0 + shift_a])?),
    )?;
    ts.set_solution2(&u, &v)?;
    ts.set_max_time(1.0)?;
    ts.set_max_steps(steps + 1)?;
    ts.set_time_step(1.0 / f64::from(steps))?;
    ts.set_from_options()?;
    ts.alpha2_set_radius(radius)?;
    ts.alpha2_set_own_start(own_start)?;
    let reason = ts.solve()?;
    assert!(reason.is_converged(), "{reason}");
    let (u, v) = ts.solution2()?;
    Ok((u.read()?[0] - 1f64.cos()).hypot(v.read()?[0] + 1f64.sin()))
}
