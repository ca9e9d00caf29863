//! The condensed solve against PETSc's LU of the whole system, on 1, 2 and 3 ranks. Starts itself by
//! mpirun.

mod common;
mod worker;

use std::process::ExitCode;

use common::{Noise, small_problem};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Ksp, MatrixOption, Vector, VectorRef, options};
use ssnp155::system::{CondensedMethod, CondensedSolve, History, SolverChoice, System};

fn main() -> ExitCode {
    worker::on_ranks("the_condensed_solve_is_petsc_s", &[1, 2, 3], compare)
}

fn compare(world: &SimpleCommunicator) {
    for (name, value) in [
        ("ksp_type", "preonly"),
        ("pc_type", "lu"),
        ("pc_factor_mat_solver_type", "mumps"),
    ] {
        options::set(&format!("whole_{name}"), value).unwrap();
    }
    for friction in [0.0, 0.2] {
        for method in [CondensedMethod::Substructures, CondensedMethod::Whole] {
            agrees(world, friction, method);
        }
    }
}

/// One Jacobian with points of every kind, two active sets with one analysis.
fn agrees(world: &SimpleCommunicator, friction: f64, method: CondensedMethod) {
    // Enough columns of elements for several layers of slices.
    let mut problem = small_problem(24, 2);
    problem.friction_coefficient = friction;
    let system = System::new(problem, world.duplicate()).unwrap();
    let history = History::virgin(system.local());
    let mut noise = Noise::new(17 + world.rank() as u64);
    let owned = system.owned_displacements();

    let mut unknowns = system.vector().unwrap();
    for (i, value) in unknowns.write().unwrap().iter_mut().enumerate() {
        *value = if i < owned { 1e-4 } else { 1e-5 } * noise.next();
    }
    let mut jacobian = system.matrix().unwrap();
    let mut entries = system.jacobian_entries();
    let evaluated = system.jacobian(&history, 30.0, &unknowns, 2.5, &mut entries);
    assert!(evaluated.is_ok());
    jacobian.set_values_coo(entries.values()).unwrap();
    let choice = SolverChoice {
        method,
        options_prefix: "condensed_",
    };
    let condensed = CondensedSolve::new(&system, choice).unwrap();

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
        assert!(condensed.factor(&entries, &active).unwrap());
        condensed.solve(&reduced_right_side, &mut step).unwrap();
        let expected = reduced(world, &whole, &is_active);
        step.axpy(-1.0, &expected).unwrap();
        let error = step.norm2().unwrap() / expected.norm2().unwrap();
        assert!(
            error < 1e-10,
            "friction {friction}, {method:?}: {error:.1e}"
        );
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
