//! Least squares within bounds: the minimum, bounds that hold it off, points outside the domain, and closures that fail.

mod common;

use std::{cell::Cell, rc::Rc};

use common::vector;
use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{Error, Evaluation, Failure, Matrix, Tao, TaoReason, Vector, options};

fn main() {
    common::run(&[
        ("the_minimum_is_found", minimum),
        ("a_bound_holds_the_minimum_off", bound),
        ("the_line_search_comes_back_from_outside", domain),
        ("a_start_outside_the_domain_is_an_error", bad_start),
        ("an_error_of_a_closure_comes_back_as_itself", closure_error),
        ("a_panic_of_a_closure_comes_back_as_an_error", closure_panic),
        ("an_option_ends_the_search", few_iterations),
        ("a_problem_without_a_derivative_is_refused", no_derivative),
    ]);
}

/// One unknown per rank, two residuals of each with their slopes.
fn problem(
    comm: &SimpleCommunicator,
    start: f64,
    r: impl Fn(f64) -> Evaluation<[f64; 2]> + 'static,
    slopes: impl Fn(f64) -> [f64; 2] + 'static,
) -> (Tao, Vector) {
    let x = vector(comm, 1, |_| start);
    let template = vector(comm, 2, |_| 0.0);
    let own = comm.rank();
    let mut tao = Tao::new(comm).unwrap();
    tao.set_residual(&template, move |x, out| {
        out.write()?.copy_from_slice(&r(x.read()?[0])?);
        Ok(())
    })
    .unwrap();
    let rows = [2 * own, 2 * own + 1];
    let matrix = Matrix::rectangular_from_coo(comm, [2, 1], &rows, &[own; 2]).unwrap();
    tao.set_residual_jacobian(matrix, move |x, matrix| {
        Ok(matrix.set_values_coo(&slopes(x.read()?[0]))?)
    })
    .unwrap();
    tao.set_gradient_tolerance(1e-10).unwrap();
    (tao, x)
}

/// Two residuals that cannot both vanish: x - 1 and x² - 2, whose sum of squares is least where
/// x - 1 + 2 x (x² - 2) = 0.
fn compromise(comm: &SimpleCommunicator, start: f64) -> (Tao, Vector) {
    problem(
        comm,
        start,
        |x| Ok([x - 1.0, x * x - 2.0]),
        |x| [1.0, 2.0 * x],
    )
}

fn bounded(tao: &mut Tao, x: &Vector, lower: f64, upper: f64) {
    let (mut low, mut high) = (x.duplicate().unwrap(), x.duplicate().unwrap());
    low.set_all(lower).unwrap();
    high.set_all(upper).unwrap();
    tao.set_variable_bounds(&low, &high).unwrap();
}

fn minimum(comm: &SimpleCommunicator) {
    let (mut tao, mut x) = compromise(comm, 4.0);
    tao.set_from_options().unwrap();
    let reason = tao.solve(&mut x).unwrap();
    assert!(reason.is_converged(), "{reason}");
    let found = x.read().unwrap()[0];
    let slope = found - 1.0 + 2.0 * found * (found * found - 2.0);
    assert!(slope.abs() < 1e-9, "{found}: {slope}");
    assert!(tao.iteration_number().unwrap() > 1);
}

fn bound(comm: &SimpleCommunicator) {
    let (mut tao, mut x) = compromise(comm, 4.0);
    bounded(&mut tao, &x, 1.5, 5.0); // the free minimum is at 1.31
    tao.set_from_options().unwrap();
    let reason = tao.solve(&mut x).unwrap();
    assert!(reason.is_converged(), "{reason}");
    assert_eq!(x.read().unwrap()[0], 1.5);
}

fn domain(comm: &SimpleCommunicator) {
    options::set("tao_brgn_subsolver_tao_ls_type", "armijo").unwrap();
    let outside = Rc::new(Cell::new(0));
    let count = Rc::clone(&outside);
    // From 20 the first step leads to 20 (1 - ln(20/3)) = -18, where there is no logarithm.
    let logarithm = move |x: f64| {
        if x > 0.0 {
            return Ok([(x / 3.0).ln(), 0.0]);
        }
        count.set(count.get() + 1);
        Err(Failure::Domain)
    };
    let (mut tao, mut x) = problem(comm, 20.0, logarithm, |x| {
        assert!(x > 0.0, "the derivative is asked for outside the domain");
        [1.0 / x, 0.0]
    });
    tao.set_from_options().unwrap();
    let reason = tao.solve(&mut x).unwrap();
    assert!(reason.is_converged(), "{reason}");
    assert!((x.read().unwrap()[0] - 3.0).abs() < 1e-8);
    assert!(outside.get() > 0);
    options::clear("tao_brgn_subsolver_tao_ls_type").unwrap();
}

fn bad_start(comm: &SimpleCommunicator) {
    let (mut tao, mut x) = problem(comm, 1.0, |_| Err(Failure::Domain), |_| [1.0; 2]);
    tao.set_from_options().unwrap();
    let error = tao.solve(&mut x).unwrap_err();
    assert!(matches!(error, Error::Petsc { .. }), "{error:?}");
    assert_eq!(x.read().unwrap()[0], 1.0);
}

fn closure_error(comm: &SimpleCommunicator) {
    let own = comm.rank();
    let failing = move |x: f64| match own {
        0 if x < 2.0 => Err(Failure::Fatal("the furnace is cold".into())),
        _ => Ok([x - 1.0, 0.0]),
    };
    let (mut tao, mut x) = problem(comm, 4.0, failing, |_| [1.0, 0.0]);
    tao.set_from_options().unwrap();
    let error = tao.solve(&mut x).unwrap_err();
    match own {
        0 => assert_eq!(error.to_string(), "the furnace is cold"),
        _ => assert!(matches!(error, Error::Elsewhere), "{error:?}"),
    }
}

fn closure_panic(comm: &SimpleCommunicator) {
    let (mut tao, mut x) = problem(comm, 4.0, |x| Ok([x, 0.0]), |_| panic!("no derivative"));
    tao.set_from_options().unwrap();
    let error = tao.solve(&mut x).unwrap_err();
    assert_eq!(error.to_string(), "panic in a callback: no derivative");
}

fn few_iterations(comm: &SimpleCommunicator) {
    options::set("tao_max_it", "1").unwrap();
    let (mut tao, mut x) = compromise(comm, 4.0);
    tao.set_from_options().unwrap();
    let reason = tao.solve(&mut x).unwrap();
    assert_eq!(reason, TaoReason::DivergedIterations);
    assert_eq!(tao.iteration_number().unwrap(), 1);
    options::clear("tao_max_it").unwrap();
}

fn no_derivative(comm: &SimpleCommunicator) {
    let mut tao = Tao::new(comm).unwrap();
    let mut x = vector(comm, 1, |_| 1.0);
    let template = vector(comm, 1, |_| 0.0);
    tao.set_residual(&template, |_, _| Ok(())).unwrap();
    let error = tao.solve(&mut x).unwrap_err();
    assert_eq!(error.to_string(), "set residual and derivative before");
}
