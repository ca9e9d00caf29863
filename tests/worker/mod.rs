//! Shared by the tests that call the library on several ranks: they start themselves by mpirun.

use std::env;
use std::process::{Command, ExitCode};

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Session;

#[path = "../mpi_environment/mod.rs"]
mod mpi_environment;
use mpi_environment::FEW_CORES;

const WORKER: &str = "--worker";

/// Runs `worker` on each of these numbers of ranks, and says whether it passed.
pub fn on_ranks(name: &str, numbers: &[usize], worker: fn(&SimpleCommunicator)) -> ExitCode {
    if env::args().any(|arg| arg == WORKER) {
        work(worker);
        return ExitCode::SUCCESS;
    }
    let mut held = true;
    for ranks in numbers {
        let status = Command::new("timeout")
            .args(["120", "mpirun", "-n", &ranks.to_string()])
            .arg(env::current_exe().unwrap())
            .arg(WORKER)
            .envs(FEW_CORES)
            .status()
            .unwrap();
        let verdict = if status.success() { "ok" } else { "FAILED" };
        println!("test {name}_on_{ranks}_ranks ... {verdict}");
        held &= status.success();
    }
    if held {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn work(worker: fn(&SimpleCommunicator)) {
    let (universe, _) = mpi::initialize_with_threading(mpi::Threading::Funneled).unwrap();
    let world = universe.world();
    // A rank that fails must not leave the others waiting.
    let passed = std::panic::catch_unwind(|| {
        let _session = Session::new(&env::args().take(1).collect::<Vec<_>>()).unwrap();
        worker(&world);
    });
    if passed.is_err() {
        world.abort(1);
    }
}
