//! The tangent of the whole system against PETSc's finite differences, in every Newton iteration of a small run into
//! plasticity and sliding contact, on one and two ranks.
//!
//! The differences are forward ones and have an error of their own: from the curvature of the residual, in proportion to
//! their step (at plastic states 1.2e-5 for a step of 1e-7, 1.8e-6 for PETSc's 1.5e-8, 2.3e-7 for 2e-9), and below that
//! from rounding (1.4e-7 for 3e-10). So a step of 1e-9 is used. That the tangent of an element is exact is shown by
//! central differences in `tests/mechanics.rs`; here it is shown that assembly, numbering and time stepping keep it.
//!
//! Only the time steps count: the springback after them starts where every plastic point is on its yield surface, and
//! there the residual has a kink, so that no tangent is the limit of its differences. For the same reason there is no run
//! with friction: at an open point, whose multiplier is 0, a difference to the side of pressure sees a point that slides.

mod program;

use program::{run, scratch};

/// Above the error of the differences, far below that of a wrong or missing term.
const TOLERANCE: f64 = 1e-6;

fn errors(name: &str, ranks: usize, more: &[&str]) -> Vec<f64> {
    let folder = scratch(&format!("jacobian-{name}"));
    let mut words = vec![
        "-output_dir",
        folder.to_str().unwrap(),
        "-snes_test_jacobian",
        "-snes_test_err",
        "1e-9",
    ];
    words.extend(
        "-sheet_nx 20 -sheet_ny 1 -stroke 4 -time_load 126 -unload_fraction 0 -report_strokes none -output_every 0"
            .split(' '),
    );
    words.extend(more);
    let ended = run(ranks, 120, &words);
    assert!(ended.says("FINISHED"), "{}", ended.text());
    let (steps, _) = ended.stdout.split_once("100.0%").unwrap();
    steps
        .lines()
        .filter_map(|line| line.trim().strip_prefix("||J - Jfd||_F/||J||_F = "))
        .map(|rest| rest.split(',').next().unwrap().parse().unwrap())
        .collect()
}

#[track_caller]
fn check(least: usize, errors: &[f64]) {
    assert!(
        errors.len() >= least,
        "only {} tangents compared",
        errors.len()
    );
    let worst = errors.iter().copied().fold(0.0, f64::max);
    println!("worst difference of {} tangents: {worst:.2e}", errors.len());
    assert!(
        errors.iter().all(|&error| error < TOLERANCE),
        "worst {worst:.2e}"
    );
}

#[test]
fn the_tangent_is_that_of_the_residual() {
    check(50, &errors("one", 1, &[]));
}

#[test]
fn the_tangent_is_that_of_the_residual_on_two_ranks() {
    check(
        15,
        &errors("two", 2, &["-stroke", "0.5", "-time_load", "16"]),
    );
}

#[test]
fn whether_a_residual_begins_the_tangent_changes_no_bit() {
    // A Jacobian that may have to serve again is not begun by a residual; asked to serve once, it is as any other.
    let history = |name: &str, more: &[&str]| {
        let folder = scratch(&format!("jacobian-{name}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend(
            "-sheet_nx 40 -sheet_ny 2 -stroke 6 -time_load 189 -unload_fraction 0 -report_strokes none -output_every 0 \
             -friction_coefficient 0.1342"
                .split(' '),
        );
        words.extend(more);
        assert!(run(1, 120, &words).says("FINISHED"), "{name}");
        std::fs::read_to_string(folder.join("history.csv")).unwrap()
    };
    let alone = history("alone", &["-snes_lag_jacobian", "1"]);
    assert_eq!(history("begun", &[]), alone);
    assert_ne!(history("lagging", &["-snes_lag_jacobian", "2"]), alone);
}
