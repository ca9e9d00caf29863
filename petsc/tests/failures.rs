//! What becomes of errors and panics in closures, and of points where a residual cannot be computed.

mod common;

use std::{cell::Cell, rc::Rc};

use common::vector;
use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{
    CallbackError, Error, Evaluation, Failure, Matrix, Snes, SnesReason, Ts, TsReason, Vector,
    VectorRef,
};

fn main() {
    common::run(&[
        ("petsc_errors_carry_message_and_traceback", petsc_error),
        ("an_error_of_a_closure_comes_back_as_itself", closure_error),
        ("a_panic_of_a_closure_comes_back_as_an_error", closure_panic),
        (
            "an_error_on_one_rank_ends_the_solve_on_all",
            error_on_one_rank,
        ),
        ("errors_of_hooks_end_the_integration", hook_errors),
        ("a_petsc_error_inside_a_closure_is_its_cause", nested_error),
        (
            "outside_the_domain_the_basic_line_search_fails",
            domain_basic,
        ),
        (
            "outside_the_domain_the_callers_line_search_halves",
            domain_halves,
        ),
        (
            "halving_finds_a_domain_left_by_one_rank_only",
            domain_one_rank,
        ),
        ("a_domain_that_is_never_entered_is_a_reason", domain_never),
        ("a_residual_that_is_not_a_number_is_a_reason", not_a_number),
        ("a_stage_outside_the_domain_is_cut_back", stage_domain),
        ("a_refused_stage_is_cut_back", stage_refused),
        ("a_method_that_does_not_fit_is_refused", unfit_method),
    ]);
}

/// One unknown per rank, residual `f(x)` and slope `df(x)` of each.
fn scalar(
    comm: &SimpleCommunicator,
    start: f64,
    f: impl Fn(f64) -> Evaluation<f64> + 'static,
    df: impl Fn(f64) -> f64 + 'static,
) -> (Snes, Vector) {
    let x = vector(comm, 1, |_| start);
    let own = comm.rank();
    let mut snes = Snes::new(comm).unwrap();
    snes.set_function(&x, move |x, y| {
        y.write()?[0] = f(x.read()?[0])?;
        Ok(())
    })
    .unwrap();
    let matrix = Matrix::from_coo(comm, 1, &[own], &[own]).unwrap();
    snes.set_jacobian(matrix, move |x, matrix| {
        Ok(matrix.set_values_coo(&[df(x.read()?[0])])?)
    })
    .unwrap();
    snes.set_type("newtonls").unwrap();
    (snes, x)
}

#[derive(Debug)]
struct TurnedOver(i32);

impl std::fmt::Display for TurnedOver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "element {} has turned over", self.0)
    }
}

impl std::error::Error for TurnedOver {}

fn petsc_error(comm: &SimpleCommunicator) {
    let mut snes = Snes::new(comm).unwrap();
    let error = snes.set_type("newtonish").unwrap_err();
    let Error::Petsc {
        code,
        message,
        traceback,
    } = &error
    else {
        panic!("{error:?}")
    };
    assert_eq!(*code, 86);
    assert!(message.starts_with("Unknown type."), "{message}");
    assert!(
        message.ends_with("Unable to find requested SNES type newtonish"),
        "{message}"
    );
    assert!(traceback[0].starts_with("SNESSetType() ("), "{traceback:?}");
    assert_eq!(error.traceback(), traceback);
    assert!(
        error
            .to_string()
            .starts_with("PETSc error 86: Unknown type.")
    );
}

fn closure_error(comm: &SimpleCommunicator) {
    let (mut snes, mut x) = scalar(comm, 1.0, |_| Err(TurnedOver(12).into()), |_| 1.0);
    let error = snes.solve(&mut x).unwrap_err();
    assert_eq!(error.to_string(), "element 12 has turned over");
    let Error::Callback { source, traceback } = error else {
        panic!("{error:?}")
    };
    assert_eq!(source.downcast_ref::<TurnedOver>().unwrap().0, 12);
    assert!(
        traceback
            .iter()
            .any(|line| line.starts_with("SNESSolve() (")),
        "{traceback:?}"
    );
    assert!(x.norm2().is_ok());
}

fn closure_panic(comm: &SimpleCommunicator) {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {})); // this panic is expected
    let (mut snes, mut x) = scalar(comm, 1.0, |_| panic!("index {} of {}", 5, 3), |_| 1.0);
    let error = snes.solve(&mut x).unwrap_err();
    std::panic::set_hook(hook);
    let Error::Panic { message, .. } = &error else {
        panic!("{error:?}")
    };
    assert_eq!(message, "index 5 of 3");
    let (mut snes, mut x) = scalar(comm, 1.0, |x| Ok(x - 3.0), |_| 1.0); // and life goes on
    assert!(snes.solve(&mut x).unwrap().is_converged());
}

fn error_on_one_rank(comm: &SimpleCommunicator) {
    let (rank, last) = (comm.rank(), comm.size() - 1);
    let fail = move |_| {
        if rank == last {
            Err(TurnedOver(rank).into())
        } else {
            Ok(1.0)
        }
    };
    let (mut snes, mut x) = scalar(comm, 1.0, fail, |_| 1.0);
    match snes.solve(&mut x).unwrap_err() {
        Error::Callback { .. } => assert_eq!(rank, last),
        Error::Elsewhere => assert_ne!(rank, last),
        error => panic!("{error:?}"),
    }
}

/// `u' = f(u)`, one unknown per rank, from `u = start`, ten steps to time 1.
fn growth(
    comm: &SimpleCommunicator,
    start: f64,
    f: impl Fn(f64, f64) -> Evaluation<f64> + 'static,
    df: impl Fn(f64) -> f64 + 'static,
) -> Ts {
    let u = vector(comm, 1, |_| start);
    let own = comm.rank();
    let matrix = Matrix::from_coo(comm, 1, &[own], &[own]).unwrap();
    let mut ts = Ts::new(comm).unwrap();
    ts.set_implicit(
        &u,
        matrix,
        move |t, u, udot, y| {
            y.write()?[0] = udot.read()?[0] - f(t, u.read()?[0])?;
            Ok(())
        },
        move |_, u, _, shift, matrix| Ok(matrix.set_values_coo(&[shift - df(u.read()?[0])])?),
    )
    .unwrap();
    ts.set_solution(&u).unwrap();
    ts.set_time_step(0.1).unwrap();
    ts.set_max_time(1.0).unwrap();
    ts.set_exact_final_time(petsc::ExactFinalTime::MatchStep)
        .unwrap();
    ts.set_max_snes_failures(-1).unwrap();
    ts.set_from_options().unwrap();
    ts
}

fn hook_errors(comm: &SimpleCommunicator) {
    type SetHook = fn(&mut Ts);
    fn fail() -> Result<(), CallbackError> {
        Err(TurnedOver(7).into())
    }
    let hooks: [SetHook; 6] = [
        |ts| ts.set_pre_step(|_| fail()).unwrap(),
        |ts| ts.set_pre_stage(|_, _| fail()).unwrap(),
        |ts| ts.set_post_stage(|_, _, _| fail()).unwrap(),
        |ts| ts.set_post_step(|_| fail()).unwrap(),
        |ts| ts.set_monitor(|_, _, _, _| fail()).unwrap(),
        move |ts| {
            ts.set_stage_check(|_, _, _| Err(TurnedOver(7).into()))
                .unwrap()
        },
    ];
    for set_hook in hooks {
        let mut ts = growth(comm, 1.0, |_, u| Ok(-u), |_| -1.0);
        set_hook(&mut ts);
        let error = ts.solve().unwrap_err();
        assert_eq!(error.to_string(), "element 7 has turned over");
        assert!(
            error
                .traceback()
                .iter()
                .any(|line| line.starts_with("TSSolve()")),
            "{error:?}"
        );
    }
    let mut ts = growth(comm, 1.0, |_, u| Ok(-u), |_| -1.0);
    ts.set_post_step(|ts| Ok(ts.set_converged_reason(TsReason::ConvergedUser)?))
        .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedUser);
    assert_eq!(ts.step_number().unwrap(), 1);
}

fn nested_error(comm: &SimpleCommunicator) {
    let wrong = vector(comm, 2, f64::from);
    let (mut snes, mut x) = scalar(comm, 1.0, Ok, |_| 1.0);
    snes.set_function(&x, move |_, y| Ok(y.copy_from(&wrong)?))
        .unwrap();
    let Error::Callback { source, .. } = snes.solve(&mut x).unwrap_err() else {
        panic!()
    };
    let cause = source.downcast_ref::<Error>().unwrap();
    assert!(matches!(cause, Error::Petsc { code: 75, .. }), "{cause:?}");
}

/// ln x, whose first Newton step from 3 leads to a negative x.
fn logarithm(x: f64) -> Evaluation<f64> {
    if x > 0.0 {
        Ok(x.ln())
    } else {
        Err(Failure::Domain)
    }
}

fn domain_basic(comm: &SimpleCommunicator) {
    let (mut snes, mut x) = scalar(comm, 3.0, logarithm, |x| 1.0 / x);
    petsc::options::set("basic_snes_linesearch_type", "basic").unwrap();
    snes.set_options_prefix("basic_").unwrap();
    snes.set_type("vinewtonrsls").unwrap();
    snes.set_from_options().unwrap();
    assert_eq!(
        snes.solve(&mut x).unwrap(),
        SnesReason::DivergedFunctionDomain
    );
    x.set_all(2.0).unwrap(); // the failure does not stick
    assert!(snes.solve(&mut x).unwrap().is_converged());
}

fn domain_halves(comm: &SimpleCommunicator) {
    for solver in ["newtonls", "vinewtonrsls"] {
        let (mut snes, mut x) = scalar(comm, 3.0, logarithm, |x| 1.0 / x);
        snes.set_type(solver).unwrap();
        if snes.is_bounded().unwrap() {
            let (mut lower, mut upper) = (x.duplicate().unwrap(), x.duplicate().unwrap());
            lower.set_all(-petsc::INFINITY).unwrap();
            upper.set_all(4.0).unwrap();
            snes.set_variable_bounds(&lower, &upper).unwrap();
        }
        snes.set_shell_line_search(|_| Ok(1.0)).unwrap();
        let reason = snes.solve(&mut x).unwrap();
        assert!(reason.is_converged(), "{solver}: {reason}");
        assert!((x.norm_max().unwrap() - 1.0).abs() < 1e-6);
        // One evaluation per iteration, one at the start, one for the step that was halved.
        let expected = snes.iteration_number().unwrap() + 2;
        assert_eq!(snes.function_evaluations().unwrap(), expected, "{solver}");
    }
}

fn domain_one_rank(comm: &SimpleCommunicator) {
    // The other ranks start at their solution; nobody but the last leaves the domain.
    let last = comm.rank() == comm.size() - 1;
    let (mut snes, mut x) = scalar(comm, if last { 3.0 } else { 1.0 }, logarithm, |x| 1.0 / x);
    snes.set_shell_line_search(|_| Ok(1.0)).unwrap();
    let reason = snes.solve(&mut x).unwrap();
    assert!(reason.is_converged(), "{reason}");
    assert!((x.read().unwrap()[0] - 1.0).abs() < 1e-6);
}

fn domain_never(comm: &SimpleCommunicator) {
    for solver in ["newtonls", "vinewtonrsls"] {
        let calls = Rc::new(Cell::new(0));
        let count = Rc::clone(&calls);
        let once = move |_| {
            count.set(count.get() + 1);
            if count.get() == 1 {
                Ok(1.0)
            } else {
                Err(Failure::Domain)
            }
        };
        let (mut snes, mut x) = scalar(comm, 2.0, once, |_| 1.0);
        snes.set_type(solver).unwrap();
        snes.set_shell_line_search(|_| Ok(1.0)).unwrap();
        let reason = snes.solve(&mut x).unwrap();
        assert_eq!(reason, SnesReason::DivergedFunctionDomain, "{solver}");
        assert_eq!(calls.get(), 1 + 7, "{solver}");
    }
    let (mut snes, mut x) = scalar(comm, 2.0, |_| Err(Failure::Domain), |_| 1.0);
    assert_eq!(
        snes.solve(&mut x).unwrap(),
        SnesReason::DivergedFunctionDomain
    );
}

fn not_a_number(comm: &SimpleCommunicator) {
    let reasons = ["newtonls", "vinewtonrsls"].map(|solver| {
        let f = |x: f64| Ok(if x == 2.0 { 1.0 } else { f64::NAN });
        let (mut snes, mut x) = scalar(comm, 2.0, f, |_| 1.0);
        snes.set_type(solver).unwrap();
        snes.set_shell_line_search(|_| Ok(1.0)).unwrap();
        snes.solve(&mut x).unwrap()
    });
    // Since 3.25 the solver with bounds passes the reason of the line search on.
    let bounded = if common::minor() < 25 {
        SnesReason::DivergedLineSearch
    } else {
        SnesReason::DivergedNan
    };
    assert_eq!(reasons, [SnesReason::DivergedNan, bounded]);
    assert_eq!(reasons[0].sentence(), "the residual norm is not a number");
}

/// After time 0.55 the right-hand side exists only if the step is short.
fn stage_domain(comm: &SimpleCommunicator) {
    let step = Rc::new(Cell::new(0.0));
    let known = Rc::clone(&step);
    let f = move |t: f64, u: f64| {
        if t > 0.55 && known.get() > 0.06 {
            Err(Failure::Domain)
        } else {
            Ok(u)
        }
    };
    let mut ts = growth(comm, 1.0, f, |_| 1.0);
    ts.set_adapt_scale_solve_failed(0.5).unwrap();
    ts.set_pre_stage(move |ts, _| {
        step.set(ts.time_step()?);
        Ok(())
    })
    .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    // Since 3.19 the domain is no failure of the nonlinear solver.
    let failures = i32::from(common::minor() < 19);
    assert_eq!(
        (ts.snes_failures().unwrap(), ts.step_rejections().unwrap()),
        (failures, 1)
    );
    assert_eq!(ts.step_number().unwrap(), 5 + 10);
    assert!((ts.solution().unwrap().norm_max().unwrap() - 1f64.exp()).abs() < 0.2);
}

fn stage_refused(comm: &SimpleCommunicator) {
    let mut ts = growth(comm, 1.0, |_, _| Ok(1.0), |_| 0.0);
    ts.set_adapt_scale_solve_failed(0.25).unwrap();
    ts.set_stage_check(|ts, time, u: &VectorRef| {
        assert!((u.norm_max()? - (1.0 + time)).abs() < 1e-12);
        if ts.time_step()? > 0.06 {
            Err(Failure::Domain)
        } else {
            Ok(())
        }
    })
    .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    assert_eq!(
        (ts.snes_failures().unwrap(), ts.step_rejections().unwrap()),
        (0, 1)
    );
    assert_eq!(ts.step_number().unwrap(), 40);
}

fn unfit_method(comm: &SimpleCommunicator) {
    for unfit in ["alpha2", "euler", "rk", "rosw", "pseudo", "basicsymplectic"] {
        petsc::options::set("unfit_ts_type", unfit).unwrap();
        let mut ts = growth(comm, 1.0, |_, u| Ok(-u), |_| -1.0);
        ts.set_options_prefix("unfit_").unwrap();
        let error = ts.set_from_options().unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("-ts_type {unfit} does not fit")),
            "{error}"
        );
        assert_eq!(ts.solve().unwrap_err().to_string(), error);
    }
    petsc::options::set("unfit_ts_type", "beuler").unwrap();
    let u = vector(comm, 1, |_| 1.0);
    let matrix = Matrix::from_coo(comm, 1, &[comm.rank()], &[comm.rank()]).unwrap();
    let mut ts = Ts::new(comm).unwrap();
    ts.set_options_prefix("unfit_").unwrap();
    ts.set_second_order(
        &u,
        matrix,
        |_, _, _, a, f| Ok(f.copy_from(a)?),
        |_, _, _, _, _, shift_a, matrix| Ok(matrix.set_values_coo(&[shift_a])?),
    )
    .unwrap();
    assert!(
        ts.set_from_options()
            .unwrap_err()
            .to_string()
            .ends_with("use alpha2")
    );
    // What fits is not refused, and solves.
    for fit in ["beuler", "cn", "theta", "bdf", "alpha"] {
        petsc::options::set("unfit_ts_type", fit).unwrap();
        let mut ts = growth(comm, 1.0, |_, u| Ok(-u), |_| -1.0);
        ts.set_options_prefix("unfit_").unwrap();
        ts.set_from_options().unwrap();
        assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime, "{fit}");
        let end = ts.solution().unwrap().norm_max().unwrap();
        assert!((end - (-1f64).exp()).abs() < 0.03, "{fit}: {end}");
    }
    petsc::options::clear("unfit_ts_type").unwrap();
}
