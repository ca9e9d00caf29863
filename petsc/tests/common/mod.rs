//! Runs the tests of one file on the main thread: MPI and PETSc start once per process, and belong
//! to the thread that started them.
//!
//! `cargo test -p petsc` uses one rank. For two, let cargo start the tests by mpirun:
//! `CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="mpirun -n 2" cargo test -p petsc --tests`.

use std::panic::{AssertUnwindSafe, catch_unwind};

use mpi::{
    Threading,
    topology::{Communicator, SimpleCommunicator},
};

pub type Test = (&'static str, fn(&SimpleCommunicator));

/// Runs the tests whose names hold the filter, if one is given. Arguments with a dash go to PETSc.
pub fn run(tests: &[Test]) {
    let args: Vec<String> = std::env::args().collect();
    let filter = args
        .iter()
        .skip(1)
        .find(|arg| !arg.starts_with('-'))
        .cloned()
        .unwrap_or_default();
    let (universe, _) = mpi::initialize_with_threading(Threading::Funneled).unwrap();
    let world = universe.world();
    let mut failed = 0;
    {
        // A test harness's own flags (`--nocapture`, ...) are no options of PETSc.
        let (flags, rest): (Vec<_>, Vec<_>) = args.into_iter().partition(|a| a.starts_with("--"));
        drop(flags);
        let session = petsc::Session::new(&rest).unwrap();
        assert_eq!(session.version(), petsc::BUILT_WITH);
        println!("PETSc {}, MUMPS: {}", session.version(), has_mumps());
        for (name, test) in tests.iter().filter(|(name, _)| name.contains(&filter)) {
            let passed = catch_unwind(AssertUnwindSafe(|| test(&world))).is_ok();
            if world.rank() == 0 {
                println!("test {name} ... {}", if passed { "ok" } else { "FAILED" });
            }
            if !passed && world.size() > 1 {
                world.abort(1); // the other ranks may be waiting for this one
            }
            failed += i32::from(!passed);
        }
    }
    drop(universe);
    if failed > 0 {
        std::process::exit(1);
    }
}

/// The minor version of PETSc 3.
#[allow(dead_code, reason = "not used by every file")]
pub fn minor() -> u32 {
    let minor = petsc::BUILT_WITH.split('.').nth(1);
    minor.unwrap().parse().unwrap()
}

/// Whether MUMPS is there.
pub fn has_mumps() -> bool {
    petsc::has_external_package("mumps").unwrap()
}

/// A vector whose entries are given by their global indices.
#[allow(dead_code, reason = "not used by every file")]
pub fn vector(
    comm: &SimpleCommunicator,
    local_size: usize,
    entry: impl Fn(i32) -> f64,
) -> petsc::Vector {
    let mut vector = petsc::Vector::new(comm, local_size).unwrap();
    fill(&mut vector, entry);
    vector
}

/// Sets the entries by their global indices.
#[allow(dead_code, reason = "not used by every file")]
pub fn fill(vector: &mut petsc::VectorRef, entry: impl Fn(i32) -> f64) {
    let first = vector.ownership_range().unwrap().start;
    for (i, value) in (first..).zip(vector.write().unwrap().iter_mut()) {
        *value = entry(i);
    }
}
