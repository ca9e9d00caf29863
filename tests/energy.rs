//! The punch's work is what is stored, dissipated, kept by the contact and moving: the difference is that of the
//! trapezoidal rule with which the work is summed, and falls with the step. Works summed by the same rule leave nothing.

mod program;

use program::{history, run, scratch};

/// Largest relative error beyond a stroke of 1 mm, and the one at the end (5 mm), with steps up to `dt_max` ms.
fn energy_errors(dt_max: f64) -> (f64, f64) {
    let folder = scratch(&format!("energy-{dt_max}"));
    let (dt_initial, dt_max) = ((dt_max / 8.0).to_string(), dt_max.to_string());
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(["-dt_initial", &dt_initial, "-dt_max", &dt_max]);
    words.extend(
        "-sheet_nx 40 -sheet_ny 2 -stroke 5 -time_load 158 -unload_fraction 0 -output_every 0"
            .split(' '),
    );
    words.extend(["-report_strokes", "none"]);
    let ended = run(1, 60, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let history = history(&folder);
    let errors = &history["energy_error"];
    let worst = history["stroke_mm"]
        .iter()
        .zip(errors)
        .filter(|(stroke, _)| **stroke > 1.0)
        .map(|(_, error)| error.abs())
        .fold(0.0, f64::max);
    (worst, errors.last().unwrap().abs())
}

#[test]
fn the_energy_balance_closes_as_the_step_falls() {
    let steps = [8.0, 4.0, 2.0, 1.0];
    let errors: Vec<(f64, f64)> = steps.iter().map(|&dt| energy_errors(dt)).collect();
    println!("steps up to {steps:?} ms: worst and last error {errors:?}");
    assert!(errors[0].0 < 3e-3, "{errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1].0 < pair[0].0 && pair[1].1 < pair[0].1, "{errors:?}");
    }
    // Second order would be 64; contact that comes and goes within a step makes it less regular.
    assert!(errors[3].0 < errors[0].0 / 10.0, "{errors:?}");
    assert!(errors[3].1 < errors[0].1 / 10.0, "{errors:?}");
}

/// The work of the punch has its takers in every step, however long the steps are.
fn works_are_in_balance(name: &str, ranks: usize, more: &str) {
    let folder = scratch(&format!("energy-{name}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(
        "-sheet_nx 60 -sheet_ny 2 -stroke 8 -time_load 252 -time_unload 28 -dt_max 12 -output_every 0"
            .split(' '),
    );
    words.extend(more.split_whitespace());
    let ended = run(ranks, 120, &words);
    assert!(ended.says("FINISHED"), "{}", ended.text());
    let history = history(&folder);
    let column = |name: &str| &history[name];
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    println!(
        "{name}: work {:.1e}, energy at the end {:.1e}",
        largest(column("work_error")),
        column("energy_error").last().unwrap()
    );
    // What the tolerance of the residual leaves.
    assert!(largest(column("work_error")) < 1e-6);
    for row in 0..column("t_ms").len() {
        let at = |name: &str| column(name)[row];
        let contact = at("friction_work_mJ") + at("compliance_energy_mJ");
        assert!((contact - at("contact_energy_mJ")).abs() <= 1e-12 * contact);
        let taken = at("internal_work_mJ") + at("contact_work_mJ") + at("inertia_work_mJ");
        assert!((taken - at("external_work_mJ")).abs() <= 1e-6 * taken.abs().max(1.0));
        let kept = at("inertia_work_mJ") - at("kinetic_energy_mJ");
        assert!((kept - at("integrator_dissipation_mJ")).abs() <= 1e-12);
    }
    if more.contains("dynamics none") {
        assert_eq!(largest(column("inertia_work_mJ")), 0.0);
    } else {
        // The first steps set the sheet in motion: without their inertia the balance would be open.
        assert!(largest(column("inertia_work_mJ")) > 1e-3);
    }
}

#[test]
fn works_are_in_balance_without_friction() {
    works_are_in_balance("plain", 1, "");
}

#[test]
fn works_are_in_balance_with_friction_on_two_ranks() {
    works_are_in_balance("friction", 2, "-friction_coefficient 0.1342");
}

#[test]
fn works_are_in_balance_in_statics() {
    works_are_in_balance("static", 1, "-dynamics none");
}
