//! The condensed solve against PETSc's LU of the whole system, on 1, 2 and 3 ranks. Starts itself by
//! mpirun.

mod common;

use std::env;
use std::process::{Command, ExitCode};
use std::rc::Rc;

use common::{Noise, small_problem};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Ksp, MatrixOption, Session, Vector, VectorRef, options};
use ssnp155::system::{CondensedSolve, System};

const WORKER: &str = "--worker";

fn main() -> ExitCode {
    if env::args().any(|arg| arg == WORKER) {
        worker();
        return ExitCode::SUCCESS;
    }
    let mut held = true;
    for ranks in ["1", "2", "3"] {
        let status = Command::new("mpirun")
            .args(["--timeout", "120", "-n", ranks])
            .arg(env::current_exe().unwrap())
            .arg(WORKER)
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
            .env("OMPI_MCA_hwloc_base_binding_policy", "none")
            .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
            .env("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe")
            .env("OMPI_MCA_btl_vader_single_copy_mechanism", "none")
            .env("OPENBLAS_NUM_THREADS", "1")
            .status()
            .unwrap();
        println!(
            "test the_condensed_solve_is_petsc_s_on_{ranks}_ranks ... {}",
            if status.success() { "ok" } else { "FAILED" }
        );
        held &= status.success();
    }
    if held {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn worker() {
    let (universe, _) = mpi::initialize_with_threading(mpi::Threading::Funneled).unwrap();
    let world = universe.world();
    // A rank that fails must not leave the others waiting.
    let passed = std::panic::catch_unwind(|| {
        let _session = Session::new(&env::args().take(1).collect::<Vec<_>>()).unwrap();
        for (name, value) in [
            ("ksp_type", "preonly"),
            ("pc_type", "lu"),
            ("pc_factor_mat_solver_type", "mumps"),
        ] {
            options::set(&format!("whole_{name}"), value).unwrap();
        }
        for friction in [0.0, 0.2] {
            for solver in ["default", "lu"] {
                if solver != "default" {
                    options::set("condensed_pc_type", solver).unwrap();
                }
                agrees(&world, friction);
                options::clear("condensed_pc_type").unwrap();
            }
        }
    });
    if passed.is_err() {
        world.abort(1);
    }
}

/// One Jacobian with points of every kind, two active sets with one analysis.
fn agrees(world: &SimpleCommunicator, friction: f64) {
    let mut problem = small_problem(12, 2);
    problem.friction_coefficient = friction;
    let system = Rc::new(System::new(problem, world.duplicate()).unwrap());
    let mut noise = Noise::new(17 + world.rank() as u64);
    let owned = system.owned_displacements();

    let mut unknowns = system.vector().unwrap();
    for (i, value) in unknowns.write().unwrap().iter_mut().enumerate() {
        *value = if i < owned { 1e-4 } else { 1e-5 } * noise.next();
    }
    let mut jacobian = system.matrix().unwrap();
    assert!(system.jacobian(30.0, &unknowns, 2.5, &mut jacobian).is_ok());
    let condensed = CondensedSolve::new(Rc::clone(&system)).unwrap();

    for every in [3, 4] {
        let mut right_side = system.vector().unwrap();
        let first = right_side.ownership_range().unwrap().start;
        let size = right_side.local_size().unwrap();
        let is_active = |i: usize| i > owned && (i - owned) % (2 * every) == 1;
        let active: Vec<i32> = (0..size)
            .filter(|&i| is_active(i))
            .map(|i| first + i as i32)
            .collect();
        assert!(!active.is_empty() || size == owned);
        for (i, value) in right_side.write().unwrap().iter_mut().enumerate() {
            *value = if is_active(i) { 0.0 } else { noise.next() };
        }

        let whole = {
            let mut matrix = jacobian.duplicate().unwrap();
            matrix
                .set_option(MatrixOption::KeepNonzeroPattern, true)
                .unwrap();
            matrix.zero_rows_columns(&active, 1.0).unwrap();
            let mut solver = Ksp::new(world).unwrap();
            solver.set_options_prefix("whole_").unwrap();
            solver.set_operator(&matrix).unwrap();
            solver.set_from_options().unwrap();
            let mut step = system.vector().unwrap();
            assert!(solver.solve(&right_side, &mut step).unwrap().is_converged());
            step
        };

        let reduced_right_side = reduced(world, &right_side, &is_active);
        let mut step = reduced_right_side.duplicate().unwrap();
        assert!(condensed.factor(&active).unwrap());
        condensed.solve(&reduced_right_side, &mut step).unwrap();
        let expected = reduced(world, &whole, &is_active);
        step.axpy(-1.0, &expected).unwrap();
        let error = step.norm2().unwrap() / expected.norm2().unwrap();
        assert!(error < 1e-10, "friction {friction}: {error:.1e}");
    }
}

/// The part of a vector that is not active.
fn reduced(
    world: &SimpleCommunicator,
    whole: &VectorRef,
    is_active: &impl Fn(usize) -> bool,
) -> Vector {
    let values = whole.read().unwrap();
    let kept: Vec<f64> = (0..values.len())
        .filter(|&i| !is_active(i))
        .map(|i| values[i])
        .collect();
    let mut part = Vector::new(world, kept.len()).unwrap();
    part.write().unwrap().copy_from_slice(&kept);
    part
}
