//! Nonlinear solvers with bounds: the active set, the line search, a preconditioner of closures.

mod common;
#[path = "common/obstacle.rs"]
mod obstacle;

use std::{
    cell::{Cell, RefCell},
    rc::Rc,
};

use mpi::topology::{Communicator, SimpleCommunicator};
use obstacle::{Obstacle, touches};
use petsc::{
    FactorKind, FactorStatus, Factorization, Failure, MatrixOption, SnesReason, SnesRef, Vector,
    options,
};

fn main() {
    common::run(&[
        ("the_string_lies_on_the_obstacle", string_on_obstacle),
        (
            "the_active_set_is_known_in_monitors",
            active_set_in_monitors,
        ),
        ("bounds_may_change_between_solves", changed_bounds),
        ("the_callers_line_search_is_used", callers_line_search),
        ("damping_slows_convergence_down", damping),
        (
            "the_option_replaces_the_callers_line_search",
            option_replaces_line_search,
        ),
        (
            "the_callers_convergence_test_ends_the_solve",
            convergence_test,
        ),
        (
            "one_symbolic_factorisation_serves_all_active_sets",
            one_symbolic_factorisation,
        ),
        ("without_bounds_the_string_hangs_free", free_string),
        ("a_matrix_free_operator_follows_the_iterate", matrix_free),
        ("hooks_cannot_pull_the_solver_to_pieces", parts_are_held),
        (
            "an_unusable_matrix_is_a_failure_of_the_linear_solver",
            unusable_matrix,
        ),
    ]);
}

fn check_active_set(snes: &SnesRef) {
    let own = snes.solution().unwrap().ownership_range().unwrap();
    let (active, inactive): (Vec<i32>, Vec<i32>) = own.partition(|&i| touches(i));
    assert_eq!(snes.active_set().unwrap(), active);
    assert_eq!(snes.inactive_set().unwrap(), inactive);
}

fn string_on_obstacle(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "string_");
    string.snes.set_from_options().unwrap();
    let reason = string.snes.solve(&mut string.u).unwrap();
    assert!(reason.is_converged(), "{reason}");
    string.check_solution();
    check_active_set(&string.snes);
    let ksp = string.snes.ksp().unwrap();
    if common::has_mumps() {
        assert_eq!(ksp.factor_solver().unwrap().as_deref(), Some("mumps"));
    } else {
        assert_eq!(ksp.preconditioner().unwrap().as_deref(), Some("redundant"));
    }
    assert!(string.snes.ksp_reason().unwrap().is_converged());
}

fn active_set_in_monitors(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "monitor_");
    string.snes.set_from_options().unwrap();
    let sizes: Rc<RefCell<Vec<usize>>> = Rc::default();
    let seen = Rc::clone(&sizes);
    let monitor = move |snes: &SnesRef, iteration: i32, norm: f64| {
        assert_eq!(snes.iteration_number()?, iteration);
        assert_eq!(snes.function_norm()?, norm);
        let (x, f) = (snes.solution()?, snes.function()?);
        assert!(x.local_size()? == f.local_size()? && f.norm2()? >= norm * (1.0 - 1e-14));
        seen.borrow_mut()
            .push(snes.active_set()?.len() + snes.inactive_set()?.len());
        Ok(())
    };
    string.snes.set_monitor(monitor).unwrap();
    string.snes.solve(&mut string.u).unwrap();
    let iterations = usize::try_from(string.snes.iteration_number().unwrap()).unwrap();
    assert_eq!(
        *sizes.borrow(),
        vec![string.u.local_size().unwrap(); iterations + 1]
    );
}

fn changed_bounds(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "changed_");
    string.snes.set_from_options().unwrap();
    string.snes.solve(&mut string.u).unwrap();
    let (mut lower, mut upper) = (string.u.duplicate().unwrap(), string.u.duplicate().unwrap());
    lower.set_all(-1.0).unwrap();
    upper.set_all(petsc::INFINITY).unwrap();
    string.snes.set_variable_bounds(&lower, &upper).unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    assert!(string.snes.active_set().unwrap().is_empty());
    let smallest = -string.u.norm_max().unwrap();
    assert!((smallest + 0.125).abs() < 1e-10, "{smallest}"); // the free string
    let short = Vector::new(comm, 1).unwrap();
    assert!(string.snes.set_variable_bounds(&short, &short).is_err());
}

fn callers_line_search(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "shell_");
    string.snes.set_shell_line_search(|_| Ok(1.0)).unwrap();
    let monitored = Rc::new(RefCell::new(Vec::new()));
    let norms = Rc::clone(&monitored);
    string
        .snes
        .set_monitor(move |_, _, norm| {
            norms.borrow_mut().push(norm);
            Ok(())
        })
        .unwrap();
    string.snes.set_from_options().unwrap();
    let norms = Rc::clone(&monitored);
    let search = move |info: &petsc::LineSearchInfo<'_>| {
        assert_eq!(info.history, &norms.borrow()[..]);
        assert_eq!(info.history.last(), Some(&info.residual_norm));
        assert_eq!(info.history.len(), usize::try_from(info.iteration)? + 1);
        assert!(info.step.norm_max()? > 0.0 && info.snes.solution()?.size()? == 49);
        Ok(1.0)
    };
    string.snes.set_shell_line_search(search).unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    string.check_solution();
    check_active_set(&string.snes);
    assert!(monitored.borrow().len() > 2);
    // Norms, iterate and residual are those of the new point: the solver agrees with a fresh look.
    let norm = string.snes.function_norm().unwrap();
    assert_eq!(monitored.borrow().last(), Some(&norm));
}

fn iterations_with(comm: &SimpleCommunicator, prefix: &str, factor: f64) -> i32 {
    let mut string = Obstacle::bounded(comm, prefix);
    string
        .snes
        .set_shell_line_search(move |_| Ok(factor))
        .unwrap();
    string.snes.set_from_options().unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    string.snes.iteration_number().unwrap()
}

fn damping(comm: &SimpleCommunicator) {
    let (full, damped) = (
        iterations_with(comm, "full_", 1.0),
        iterations_with(comm, "damped_", 0.7),
    );
    assert!(
        damped > full,
        "{damped} iterations with damping, {full} without"
    );
}

fn option_replaces_line_search(comm: &SimpleCommunicator) {
    options::set("l2_snes_linesearch_type", "l2").unwrap();
    let calls = Rc::new(Cell::new(0));
    let count = Rc::clone(&calls);
    let mut string = Obstacle::bounded(comm, "l2_");
    let search = move |_: &petsc::LineSearchInfo<'_>| {
        count.set(count.get() + 1);
        Ok(1.0)
    };
    string.snes.set_shell_line_search(search).unwrap();
    string.snes.set_from_options().unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    string.check_solution();
    assert_eq!(calls.get(), 0);
    assert!(
        options::unused()
            .unwrap()
            .iter()
            .all(|(name, _)| !name.starts_with("l2_"))
    );
}

fn convergence_test(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "test_");
    string.snes.set_from_options().unwrap();
    let test = |snes: &SnesRef, check: &petsc::ConvergenceCheck| {
        assert!(snes.iteration_number()? == check.iteration);
        Ok(if check.iteration < 2 {
            check.default
        } else {
            SnesReason::ConvergedIterations
        })
    };
    string.snes.set_convergence_test(test).unwrap();
    let reason = string.snes.solve(&mut string.u).unwrap();
    assert_eq!(reason, SnesReason::ConvergedIterations);
    assert_eq!(string.snes.iteration_number().unwrap(), 2);
}

/// Instead of the matrix of the inactive unknowns, the whole matrix with rows and columns of the
/// active ones replaced by the identity is factorised: its pattern never changes.
fn one_symbolic_factorisation(comm: &SimpleCommunicator) {
    if !common::has_mumps() && comm.size() > 1 {
        return; // PETSc's own factorisation works on one rank only
    }
    let mut string = Obstacle::bounded(comm, "kept_");
    let factors: Rc<RefCell<Option<Factorization>>> = Rc::default();
    let positions: Rc<RefCell<Vec<usize>>> = Rc::default();
    let symbolic = Rc::new(Cell::new(0));
    let numeric = Rc::new(Cell::new(0));

    let (kept, places) = (Rc::clone(&factors), Rc::clone(&positions));
    let (symbolic_count, numeric_count) = (Rc::clone(&symbolic), Rc::clone(&numeric));
    let setup = move |snes: &SnesRef, reduced: &petsc::MatrixRef| {
        let first = snes.solution()?.ownership_range()?.start;
        *places.borrow_mut() = snes
            .inactive_set()?
            .iter()
            .map(|i| usize::try_from(i - first))
            .collect::<Result<_, _>>()?;
        let whole = snes.jacobian()?;
        assert!(reduced.nonzeros()? <= whole.nonzeros()?);
        let mut matrix = whole.duplicate()?;
        matrix.set_option(MatrixOption::KeepNonzeroPattern, true)?;
        matrix.zero_rows_columns(&snes.active_set()?, 1.0)?;
        let mut kept = kept.borrow_mut();
        if kept.is_none() {
            symbolic_count.set(symbolic_count.get() + 1);
            *kept = Some(Factorization::new(&matrix, FactorKind::General)?);
        }
        numeric_count.set(numeric_count.get() + 1);
        match kept
            .as_ref()
            .map(|factors| factors.factor(&matrix))
            .transpose()?
        {
            Some(FactorStatus::Ready) => Ok(()),
            _ => Err(Failure::Domain),
        }
    };
    let whole = RefCell::new((string.u.duplicate().unwrap(), string.u.duplicate().unwrap()));
    let apply = move |b: &petsc::VectorRef, x: &mut petsc::VectorRef| {
        let mut whole = whole.borrow_mut();
        let (whole_b, whole_x) = &mut *whole;
        whole_b.set_all(0.0)?;
        let places = positions.borrow();
        for (&place, &value) in places.iter().zip(b.read()?.iter()) {
            whole_b.write()?[place] = value;
        }
        if let Some(factors) = &*factors.borrow() {
            factors.solve(whole_b, whole_x)?;
        }
        let whole_x = whole_x.read()?;
        for (&place, value) in places.iter().zip(x.write()?.iter_mut()) {
            *value = whole_x[place];
        }
        Ok(())
    };
    options::set("kept_pc_type", "shell").unwrap();
    options::set("kept_ksp_type", "preonly").unwrap();
    string.snes.set_from_options().unwrap();
    string.snes.set_shell_preconditioner(setup, apply).unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    string.check_solution();
    assert_eq!(symbolic.get(), 1);
    assert_eq!(numeric.get(), string.snes.iteration_number().unwrap());
    assert!(numeric.get() > 2);
    if common::has_mumps() {
        options::mark_used("kept_pc_factor_mat_solver_type").unwrap();
    }
}

fn unusable_matrix(comm: &SimpleCommunicator) {
    options::set("unusable_pc_type", "shell").unwrap();
    let mut string = Obstacle::bounded(comm, "unusable_");
    string.snes.set_from_options().unwrap();
    string
        .snes
        .set_shell_preconditioner(|_, _| Err(Failure::Domain), |b, x| Ok(x.copy_from(b)?))
        .unwrap();
    let reason = string.snes.solve(&mut string.u).unwrap();
    assert_eq!(reason, SnesReason::DivergedLinearSolve);
    assert_eq!(
        string.snes.ksp_reason().unwrap(),
        petsc::KspReason::DivergedPreconditioner
    );
}

fn check_free(string: &Obstacle) {
    assert!((string.u.norm_max().unwrap() - 0.125).abs() < 1e-7);
    assert!(string.snes.active_set().unwrap().is_empty());
    let all: Vec<i32> = string.u.ownership_range().unwrap().collect();
    assert_eq!(string.snes.inactive_set().unwrap(), all);
}

fn free_string(comm: &SimpleCommunicator) {
    let mut string = Obstacle::new(comm, "free_");
    string.snes.set_from_options().unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    check_free(&string);
    assert_eq!(string.snes.iteration_number().unwrap(), 1);
}

fn matrix_free(comm: &SimpleCommunicator) {
    options::set("mf_snes_mf_operator", "").unwrap();
    let mut string = Obstacle::new(comm, "mf_");
    string.snes.set_from_options().unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    check_free(&string);
}

fn parts_are_held(comm: &SimpleCommunicator) {
    let mut string = Obstacle::bounded(comm, "held_");
    string.snes.set_from_options().unwrap();
    let template = string.u.duplicate().unwrap();
    let refused = Rc::new(Cell::new(0));
    let count = Rc::clone(&refused);
    string
        .snes
        .set_update(move |snes, _| {
            assert!(snes.set_type("newtonls").is_err());
            assert!(snes.set_from_options().is_err());
            assert!(snes.set_function(&template, |_, _| Ok(())).is_err());
            snes.set_monitor(|_, _, _| Ok(()))?; // hooks may change
            snes.set_update(|_, _| Ok(()))?; // even the one that runs
            count.set(count.get() + 1);
            Ok(())
        })
        .unwrap();
    assert!(string.snes.solve(&mut string.u).unwrap().is_converged());
    string.check_solution();
    assert_eq!(refused.get(), 1);
    string.snes.set_type("newtonls").unwrap(); // and now it may
}
