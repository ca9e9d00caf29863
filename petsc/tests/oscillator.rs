//! TSALPHA2 on u'' + u = 0: second order, starts, and a state that goes on to the last bit.

mod common;

use std::{cell::RefCell, rc::Rc};

use common::vector;
use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{Alpha2State, CallbackError, Failure, Matrix, Ts, TsReason, Vector};

fn main() {
    common::run(&[
        (
            "the_generalized_alpha_method_is_of_second_order",
            second_order,
        ),
        ("petscs_own_start_is_right_since_3_22", own_start),
        (
            "a_restarted_step_keeps_second_order",
            restart_keeps_second_order,
        ),
        ("a_jump_of_the_solution_is_a_start", jump),
        ("a_start_that_failed_is_cured_again", failed_start),
        (
            "a_state_put_into_the_method_goes_on_to_the_last_bit",
            state_goes_on,
        ),
        (
            "the_acceleration_of_a_step_is_that_of_its_equations",
            stage_acceleration,
        ),
        ("a_refused_first_step_ends", first_step_forgets),
        (
            "parameters_of_the_method_given_as_options_are_seen",
            alpha_options,
        ),
        ("interpolation_at_the_end_is_refused", interpolation),
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

/// The reason for a start of our own, and until when it is needed.
fn own_start(comm: &SimpleCommunicator) {
    assert_eq!(Ts::OWN_START_IS_OF_FIRST_ORDER, common::minor() < 22);
    let expected = if Ts::OWN_START_IS_OF_FIRST_ORDER {
        1.0
    } else {
        2.0
    };
    for radius in [0.9, 0.5, 0.0] {
        let order = order(|steps| {
            let mut ts = oscillator(comm, radius, steps);
            ts.alpha2_set_own_start(true).unwrap();
            error(&mut ts)
        });
        assert!(
            (order - expected).abs() < 0.2,
            "radius {radius}: order {order}"
        );
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

fn jump(comm: &SimpleCommunicator) {
    // Half-way, the state is set back to the start: what follows is the first half once more.
    let order = order(|steps| {
        let mut ts = oscillator(comm, 0.5, steps);
        ts.set_post_step(move |ts| {
            if ts.step_number()? == steps / 2 {
                let (mut u, v) = (ts.solution()?.duplicate()?, ts.solution()?.duplicate()?);
                u.set_all(1.0)?;
                ts.set_solution2(&u, &v)?;
            }
            Ok(())
        })
        .unwrap();
        assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
        let (u, v) = ts.solution2().unwrap();
        let (u, v) = (u.read().unwrap()[0], v.read().unwrap()[0]);
        (u - 0.5f64.cos()).hypot(v + 0.5f64.sin())
    });
    assert!((order - 2.0).abs() < 0.1, "order {order}");
}

fn failed_start(comm: &SimpleCommunicator) {
    let mut ts = oscillator(comm, 0.5, 4);
    let own_params = ts.alpha2_get_params().unwrap();
    ts.set_max_snes_failures(-1).unwrap();
    ts.set_max_step_rejections(0).unwrap();
    let starts: Rc<RefCell<Vec<bool>>> = Rc::default();
    let seen = Rc::clone(&starts);
    ts.set_post_stage(move |ts, _, _| {
        seen.borrow_mut()
            .push(ts.alpha2_get_params()? == petsc::AlphaParameters::START);
        Ok(())
    })
    .unwrap();
    ts.set_post_step(|ts| {
        if ts.step_number()? == 2 {
            Ok(ts.restart_step()?)
        } else {
            Ok(())
        }
    })
    .unwrap();
    ts.set_stage_check(|ts, time, _| {
        let fails = time > 0.55 && ts.time_step()? > 0.11;
        if fails {
            Err(petsc::Failure::Domain)
        } else {
            Ok(())
        }
    })
    .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::DivergedStepRejected);
    assert_eq!(ts.step_number().unwrap(), 2);
    assert_eq!(ts.alpha2_get_params().unwrap(), own_params);
    // Start, step, and the first half step of the second start, which fails.
    assert_eq!(starts.take(), [true, true, true, false, true]);
    ts.set_time_step(0.1).unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    assert_eq!(starts.take()[..4], [true, true, true, false]);
}

/// Steps of changing length, so that a wrong acceleration cannot hide; one of them is refused once.
fn vary_and_follow(ts: &mut Ts, state: &Rc<RefCell<Alpha2State>>) {
    let follower = Rc::clone(state);
    ts.set_pre_stage(move |ts, _| Ok(follower.borrow_mut().attempt(ts)?))
        .unwrap();
    let follower = Rc::clone(state);
    ts.set_post_step(move |ts| {
        follower.borrow_mut().accepted(ts)?;
        let step = f64::from(ts.step_number()?);
        Ok(ts.set_time_step(0.05 + 0.01 * (3.0 * step).sin())?)
    })
    .unwrap();
    ts.set_stage_check(|ts, time, _| {
        if (0.5..0.58).contains(&time) && ts.time_step()? > 0.04 {
            Err(petsc::Failure::Domain)
        } else {
            Ok(())
        }
    })
    .unwrap();
    ts.set_max_snes_failures(-1).unwrap();
    ts.set_exact_final_time(petsc::ExactFinalTime::StepOver)
        .unwrap();
}

fn state_goes_on(comm: &SimpleCommunicator) {
    for radius in [0.0, 0.3, 0.8] {
        let run = |ts: &mut Ts, state: &Rc<RefCell<Alpha2State>>, steps| {
            vary_and_follow(ts, state);
            ts.set_max_steps(steps).unwrap();
            assert_eq!(ts.solve().unwrap(), TsReason::ConvergedSteps);
            assert!(state.borrow().is_exact());
            let (u, v) = ts.solution2().unwrap();
            (u.read().unwrap()[0], v.read().unwrap()[0])
        };
        let start = |ts: &Ts| {
            let none = ts.solution().unwrap().duplicate().unwrap();
            Rc::new(RefCell::new(Alpha2State::new(ts, &none).unwrap()))
        };
        let mut unbroken = oscillator(comm, radius, 20);
        let state = start(&unbroken);
        let expected = run(&mut unbroken, &state, 15);
        for stop in [1, 4, 9, 14] {
            let mut first = oscillator(comm, radius, 20);
            let state = start(&first);
            run(&mut first, &state, stop);
            let mut second = oscillator(comm, radius, 20);
            let (u, _) = first.solution2().unwrap();
            let (time, next) = (first.time().unwrap(), first.time_step().unwrap());
            let (v, a) = (
                state.borrow().velocity().to_owned().unwrap(),
                state.borrow().acceleration().to_owned().unwrap(),
            );
            second.alpha2_set_state(u, &v, &a, time, stop).unwrap();
            second.set_time_step(next).unwrap();
            let state = Rc::new(RefCell::new(Alpha2State::new(&second, &a).unwrap()));
            assert_eq!(
                run(&mut second, &state, 15),
                expected,
                "radius {radius}, stop {stop}"
            );
        }
    }
}

fn stage_acceleration(comm: &SimpleCommunicator) {
    for radius in [0.0, 0.3, 0.8] {
        let mut ts = oscillator(comm, radius, 20);
        let last: Rc<RefCell<f64>> = Rc::default();
        let seen = Rc::clone(&last);
        let (u, own) = {
            let u = ts.solution().unwrap();
            (u.to_owned().unwrap(), u.ownership_range().unwrap().start)
        };
        let matrix = Matrix::from_coo(comm, 1, &[own], &[own]).unwrap();
        ts.set_second_order(
            &u,
            matrix,
            move |_, u, _, a, f| {
                seen.replace(a.read()?[0]);
                Ok(f.waxpy(1.0, u, a)?)
            },
            |_, _, _, _, _, shift_a, matrix| Ok(matrix.set_values_coo(&[1.0 + shift_a])?),
        )
        .unwrap();
        let none = u.duplicate().unwrap();
        let state = Rc::new(RefCell::new(Alpha2State::new(&ts, &none).unwrap()));
        let compared: Rc<RefCell<usize>> = Rc::default();
        let (follower, count) = (Rc::clone(&state), Rc::clone(&compared));
        ts.set_pre_stage(move |ts, _| Ok(follower.borrow_mut().attempt(ts)?))
            .unwrap();
        ts.set_post_step(move |ts| {
            let mut state = state.borrow_mut();
            state.accepted(ts)?;
            let (found, expected) = (state.stage_acceleration().read()?[0], *last.borrow());
            if ts.step_number()? == 1 {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            } else {
                assert_eq!(found.to_bits(), expected.to_bits(), "radius {radius}");
            }
            *count.borrow_mut() += 1;
            let step = f64::from(ts.step_number()?);
            Ok(ts.set_time_step(0.05 + 0.01 * (3.0 * step).sin())?)
        })
        .unwrap();
        ts.set_exact_final_time(petsc::ExactFinalTime::StepOver)
            .unwrap();
        ts.set_max_steps(15).unwrap();
        ts.solve().unwrap();
        assert_eq!(*compared.borrow(), 15);
    }
}

fn interpolation(comm: &SimpleCommunicator) {
    petsc::options::set("ts_exact_final_time", "interpolate").unwrap();
    let mut ts = Ts::new(comm).unwrap();
    ts.set_from_options().unwrap();
    petsc::options::clear("ts_exact_final_time").unwrap();
    assert!(ts.solve().unwrap_err().to_string().contains("stepover"));
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

/// A failure of TSALPHA2 before PETSc 3.21, see the notes on time integration.
fn first_step_forgets(comm: &SimpleCommunicator) {
    let steps: Rc<RefCell<Vec<f64>>> = Rc::default();
    let seen = Rc::clone(&steps);
    let u = vector(comm, 1, |_| 1.0);
    let own = comm.rank();
    let mut ts = Ts::new(comm).unwrap();
    ts.set_second_order(
        &u,
        Matrix::from_coo(comm, 1, &[own], &[own]).unwrap(),
        |t, _, _, a, f| {
            if t > 0.03 {
                Err(Failure::Domain)
            } else {
                Ok(f.copy_from(a)?)
            }
        },
        |_, _, _, _, _, shift_a, matrix| Ok(matrix.set_values_coo(&[shift_a])?),
    )
    .unwrap();
    ts.set_solution2(&u, &u).unwrap();
    ts.set_time_step(0.1).unwrap();
    ts.set_max_time(0.02).unwrap();
    ts.set_max_snes_failures(-1).unwrap();
    ts.set_max_step_rejections(3).unwrap();
    ts.set_exact_final_time(petsc::ExactFinalTime::StepOver)
        .unwrap();
    ts.set_from_options().unwrap();
    ts.set_post_stage(move |ts, _, _| {
        seen.borrow_mut().push(ts.time_step()?);
        Ok(())
    })
    .unwrap();
    let reason = ts.solve().unwrap();
    if Ts::START_FORGETS_CUT_BACK {
        assert_eq!(reason, TsReason::DivergedStepRejected);
        assert_eq!(*steps.borrow(), [0.05; 4]); // the same half step again and again
        assert_eq!((ts.step_number().unwrap(), ts.time().unwrap()), (0, 0.0));
        ts.set_time_step(0.01).unwrap(); // the remedy
        assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    } else {
        assert_eq!(reason, TsReason::ConvergedTime);
        assert_eq!(steps.borrow()[0], 0.05);
        // Two halves of the cut-back step, and the step itself.
        let last = steps.borrow()[1..].to_vec();
        assert!(last.len() >= 3 && last[0] < 0.03, "{last:?}");
        assert_eq!(last[0], last[1]);
        assert!(ts.step_rejections().unwrap() >= 1);
    }
}

/// PETSc takes them without a word: a program whose equations need certain ones must be able to look.
fn alpha_options(comm: &SimpleCommunicator) {
    let names = [
        ("ts_alpha_radius", "0.5"),
        ("ts_alpha_alpha_m", "0.7"),
        ("ts_alpha_beta", "0.3"),
    ];
    for (name, value) in names {
        assert!(!petsc::options::is_given(name).unwrap());
        petsc::options::set(name, value).unwrap();
        let mut ts = Ts::new(comm).unwrap();
        let u = vector(comm, 1, |_| 1.0);
        let matrix = Matrix::from_coo(comm, 1, &[comm.rank()], &[comm.rank()]).unwrap();
        ts.set_second_order(
            &u,
            matrix,
            |_, _, _, _, _| Ok(()),
            |_, _, _, _, _, _, _| Ok(()),
        )
        .unwrap();
        let before = ts.alpha2_get_params().unwrap();
        ts.set_from_options().unwrap();
        assert_ne!(ts.alpha2_get_params().unwrap(), before, "{name}");
        assert!(petsc::options::is_given(name).unwrap()); // also after PETSc has read it
        petsc::options::clear(name).unwrap();
    }
}
