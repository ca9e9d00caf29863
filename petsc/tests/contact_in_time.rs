//! Bounds inside a time integration, as contact with a moving tool uses them.

mod common;

use std::{cell::RefCell, rc::Rc};

use common::{fill, vector};
use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{Failure, Matrix, Ts, TsReason, Vector, VectorRef, options};

fn main() {
    common::run(&[
        ("a_moving_bound_pushes_a_spring", moving_bound),
        ("a_falling_mass_stays_above_the_floor", falling_mass),
        (
            "a_failed_push_is_repeated_with_a_shorter_step",
            shorter_step,
        ),
        ("the_callers_start_of_each_stage_is_used", start_of_stage),
    ]);
}

const STIFFNESS: f64 = 8.0;

/// Per rank, a spring pushed by a wall, u >= t, and a second unknown without bounds that follows the
/// first. The residual exists only as long as `allowed(step, u)`.
fn spring(comm: &SimpleCommunicator, prefix: &str, allowed: fn(f64, f64) -> bool) -> Ts {
    let u = Vector::new(comm, 2).unwrap();
    let own = 2 * comm.rank();
    let mut ts = Ts::new(comm).unwrap();
    ts.set_options_prefix(prefix).unwrap();
    let (rows, cols) = ([own, own + 1, own + 1], [own, own, own + 1]);
    let step: Rc<RefCell<f64>> = Rc::default();
    let known = Rc::clone(&step);
    ts.set_implicit(
        &u,
        Matrix::from_coo(comm, 2, &rows, &cols).unwrap(),
        move |_, u, _, f| {
            let u = u.read()?;
            if !allowed(*known.borrow(), u[0]) {
                return Err(Failure::Domain);
            }
            f.write()?
                .copy_from_slice(&[STIFFNESS * u[0], STIFFNESS * (u[1] - u[0])]);
            Ok(())
        },
        |_, _, _, _, matrix| Ok(matrix.set_values_coo(&[STIFFNESS, -STIFFNESS, STIFFNESS])?),
    )
    .unwrap();
    ts.set_solution(&u).unwrap();
    let bounds = RefCell::new((u.duplicate().unwrap(), u.duplicate().unwrap()));
    ts.set_pre_stage(move |ts, time| {
        *step.borrow_mut() = ts.time_step()?;
        let (lower, upper) = &mut *bounds.borrow_mut();
        lower.write()?.copy_from_slice(&[time, -petsc::INFINITY]);
        upper.set_all(petsc::INFINITY)?;
        Ok(ts.snes_mut()?.set_variable_bounds(lower, upper)?)
    })
    .unwrap();
    ts.snes_mut().unwrap().set_type("vinewtonrsls").unwrap();
    ts.snes_mut()
        .unwrap()
        .set_shell_line_search(|_| Ok(1.0))
        .unwrap();
    ts.set_time_step(0.25).unwrap();
    ts.set_max_time(1.0).unwrap();
    ts.set_max_snes_failures(-1).unwrap();
    ts.set_from_options().unwrap();
    ts
}

fn moving_bound(comm: &SimpleCommunicator) {
    let mut ts = spring(comm, "push_", |_, _| true);
    let forces: Rc<RefCell<Vec<f64>>> = Rc::default();
    let seen = Rc::clone(&forces);
    ts.set_post_step(move |ts| {
        let snes = ts.snes()?;
        assert!(snes.converged_reason()?.is_converged());
        assert_eq!(snes.active_set()?.len(), 1);
        seen.borrow_mut().push(snes.function()?.norm_max()?);
        Ok(())
    })
    .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    assert_eq!(
        *forces.borrow(),
        [0.25, 0.5, 0.75, 1.0].map(|u| STIFFNESS * u)
    );
    assert_eq!(ts.solution().unwrap().norm_max().unwrap(), 1.0);
}

fn shorter_step(comm: &SimpleCommunicator) {
    let mut ts = spring(comm, "shorter_", |step, u| u < 0.6 || step < 0.1);
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    // The default factor is 1/4: one failure at 0.75, then eight steps of 1/16.
    assert_eq!(
        (ts.snes_failures().unwrap(), ts.step_number().unwrap()),
        (1, 2 + 8)
    );
    assert_eq!(ts.solution().unwrap().norm_max().unwrap(), 1.0);
}

fn start_of_stage(comm: &SimpleCommunicator) {
    let mut ts = spring(comm, "guess_", |_, _| true);
    ts.snes_mut()
        .unwrap()
        .set_initial_guess(|u: &mut VectorRef| Ok(u.set_all(9.0)?))
        .unwrap();
    let starts: Rc<RefCell<Vec<f64>>> = Rc::default();
    let seen = Rc::clone(&starts);
    ts.snes_mut()
        .unwrap()
        .set_monitor(move |snes, iteration, _| {
            if iteration == 0 {
                seen.borrow_mut().push(snes.solution()?.norm_max()?);
            }
            Ok(())
        })
        .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    assert_eq!(*starts.borrow(), [9.0; 4]);
    assert!((ts.solution().unwrap().norm_max().unwrap() - 1.0).abs() < 1e-12);
}

fn falling_mass(comm: &SimpleCommunicator) {
    const GRAVITY: f64 = 10.0;
    options::set("fall_snes_type", "vinewtonrsls").unwrap();
    let own = comm.rank();
    let height = vector(comm, 1, |_| 1.0);
    let mut ts = Ts::new(comm).unwrap();
    ts.set_options_prefix("fall_").unwrap();
    ts.set_second_order(
        &height,
        Matrix::from_coo(comm, 1, &[own], &[own]).unwrap(),
        |_, _, _, a, f| {
            f.set_all(GRAVITY)?;
            Ok(f.axpy(1.0, a)?)
        },
        |_, _, _, _, _, shift_a, matrix| Ok(matrix.set_values_coo(&[shift_a])?),
    )
    .unwrap();
    ts.set_solution2(&height, &height.duplicate().unwrap())
        .unwrap();
    let (lower, mut upper) = (height.duplicate().unwrap(), height.duplicate().unwrap());
    fill(&mut upper, |_| petsc::INFINITY);
    ts.set_time_step(0.01).unwrap();
    ts.set_max_time(3.0).unwrap();
    // A bounded solver looks at the residual only, and round-off is all there is of it in the air.
    let snes = ts.snes_mut().unwrap();
    let tolerances = snes.tolerances().unwrap();
    snes.set_tolerances(petsc::Tolerances {
        absolute: 1e-9,
        ..tolerances
    })
    .unwrap();
    assert_eq!(snes.tolerances().unwrap().absolute, 1e-9);
    // The option sets the type; what was set by closure survives.
    ts.snes_mut()
        .unwrap()
        .set_shell_line_search(|_| Ok(1.0))
        .unwrap();
    ts.set_from_options().unwrap();
    ts.snes_mut()
        .unwrap()
        .set_variable_bounds(&lower, &upper)
        .unwrap();
    ts.alpha2_set_radius(0.0).unwrap();
    let fall: Rc<RefCell<Vec<(f64, f64)>>> = Rc::default();
    let seen = Rc::clone(&fall);
    ts.set_post_step(move |ts| {
        assert!(ts.snes()?.is_bounded()?);
        let force = ts.snes()?.function()?.norm_max()?;
        seen.borrow_mut().push((ts.solution()?.norm_max()?, force));
        Ok(())
    })
    .unwrap();
    assert_eq!(ts.solve().unwrap(), TsReason::ConvergedTime);
    let fall = fall.borrow();
    for (step, &(u, force)) in (1..).zip(fall.iter()).take(40) {
        let time = 0.01 * f64::from(step);
        assert!(
            (u - (1.0 - GRAVITY * time * time / 2.0)).abs() < 0.01,
            "{u} at {time}"
        );
        assert!(force < 1e-6);
    }
    // Even without spectral radius the method throws the mass back: contact takes two steps, of
    // which the second turns the velocity round. The mass stays above the floor and loses energy.
    assert!(
        fall.iter()
            .all(|&(u, force)| u >= 0.0 && (u == 0.0 || force < 1e-6))
    );
    let touches = fall
        .iter()
        .filter(|&&(u, force)| u == 0.0 && force > GRAVITY)
        .count();
    assert!(touches >= 2, "{touches} steps in contact");
    let highest = |steps: &[(f64, f64)]| steps.iter().map(|&(u, _)| u).fold(0.0, f64::max);
    assert!(highest(&fall[50..150]) < 0.6 && highest(&fall[150..]) < 0.5);
}
