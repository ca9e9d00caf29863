//! TSALPHA2 on u'' + u = 0: the errors of PETSc 3.18's start are cured.

mod common;

use std::{cell::RefCell, rc::Rc};

use mpi::topology::SimpleCommunicator;
use petsc::{CallbackError, Matrix, Ts, TsReason, Vector};

fn main() {
    common::run(&[
        (
            "the_generalized_alpha_method_is_of_second_order",
            second_order,
        ),
        (
            "a_restarted_step_keeps_second_order",
            restart_keeps_second_order,
        ),
        ("without_the_cure_the_start_is_of_first_order", uncured),
        ("hooks_see_times_in_order", hooks),
    ]);
}

/// One unknown per rank, all the same.
fn oscillator(comm: &SimpleCommunicator, radius: f64, steps: i32) -> Ts {
    let mut ts = Ts::new(comm).unwrap();
    let mut u = Vector::new(comm, 1).unwrap();
    u.set_all(1.0).unwrap();
    let v = Vector::new(comm, 1).unwrap();
    let own = u.ownership_range().unwrap().start;
    let matrix = Matrix::from_coo(comm, 1, &[own], &[own]).unwrap();
    ts.set_second_order(
        &u,
        matrix,
        |_, u, _, a, f| Ok(f.waxpy(1.0, u, a)?),
        |_, _, _, _, _, shift_a, matrix| Ok(matrix.set_values_coo(&[1.0 + shift_a])?),
    )
    .unwrap();
    ts.set_solution2(&u, &v).unwrap();
    ts.set_max_time(1.0).unwrap();
    ts.set_max_steps(10_000).unwrap();
    ts.set_time_step(1.0 / f64::from(steps)).unwrap();
    ts.set_exact_final_time(petsc::ExactFinalTime::MatchStep)
        .unwrap();
    ts.set_from_options().unwrap();
    ts.alpha2_set_radius(radius).unwrap();
    ts
}

fn error(ts: &mut Ts) -> f64 {
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    let (u, v) = ts.solution2().unwrap();
    let (u, v) = (u.read().unwrap()[0], v.read().unwrap()[0]);
    (u - 1f64.cos()).hypot(v + 1f64.sin())
}

fn order(solve: impl Fn(i32) -> f64) -> f64 {
    (solve(50) / solve(100)).log2()
}

fn second_order(comm: &SimpleCommunicator) {
    for radius in [1.0, 0.9, 0.5, 0.0] {
        let order = order(|steps| error(&mut oscillator(comm, radius, steps)));
        assert!((order - 2.0).abs() < 0.1, "radius {radius}: order {order}");
    }
}

fn restart_keeps_second_order(comm: &SimpleCommunicator) {
    let order = order(|steps| {
        let mut ts = oscillator(comm, 0.5, steps);
        ts.set_post_step(move |ts| {
            if ts.step_number()? == steps / 2 {
                ts.restart_step()?;
            }
            Ok(())
        })
        .unwrap();
        error(&mut ts)
    });
    assert!((order - 2.0).abs() < 0.1, "order {order}");
}

fn uncured(comm: &SimpleCommunicator) {
    let order = order(|steps| {
        let mut ts = oscillator(comm, 0.5, steps);
        ts.set_pre_step(|ts| Ok(ts.alpha2_set_radius(0.5)?))
            .unwrap();
        error(&mut ts)
    });
    assert!(
        (order - 1.0).abs() < 0.1,
        "order {order}: is the cure still needed?"
    );
}

fn hooks(comm: &SimpleCommunicator) {
    let calls: Rc<RefCell<Vec<(&str, f64)>>> = Rc::default();
    let mut ts = oscillator(comm, 0.0, 2);
    let log = |name| {
        let calls = Rc::clone(&calls);
        move |time| -> Result<(), CallbackError> {
            calls.borrow_mut().push((name, time));
            Ok(())
        }
    };
    let (pre_step, post_step) = (log("pre-step"), log("post-step"));
    let (pre_stage, post_stage, monitor) = (log("pre-stage"), log("post-stage"), log("monitor"));
    ts.set_pre_step(move |ts| pre_step(ts.time()?)).unwrap();
    ts.set_pre_stage(move |_, time| pre_stage(time)).unwrap();
    ts.set_post_stage(move |_, time, _| post_stage(time))
        .unwrap();
    ts.set_post_step(move |ts| post_step(ts.time()?)).unwrap();
    ts.set_monitor(move |_, _, time, _| monitor(time)).unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    let stage = |time| [("pre-stage", time), ("post-stage", time)];
    let mut expected = vec![("monitor", 0.0), ("pre-step", 0.0)];
    expected.extend([0.25, 0.5, 0.5].into_iter().flat_map(stage)); // two hidden half steps first
    expected.extend([("post-step", 0.5), ("monitor", 0.5), ("pre-step", 0.5)]);
    expected.extend(stage(1.0));
    expected.extend([("post-step", 1.0), ("monitor", 1.0)]);
    assert_eq!(*calls.borrow(), expected);
}
