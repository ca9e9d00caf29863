//! Every accepted step keeps what makes it a solution: contact without penetration and without tension, and forces in balance.

mod program;

use program::{history, run, scratch};

fn check(name: &str, ranks: usize, more: &str) {
    let folder = scratch(&format!("certificate-{name}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(
        "-sheet_nx 60 -sheet_ny 2 -stroke 8 -time_load 252 -time_unload 28 -output_every 0"
            .split(' '),
    );
    words.extend(more.split_whitespace());
    let ended = run(ranks, 120, &words);
    assert!(ended.says("FINISHED"), "{}", ended.text());
    let history = history(&folder);
    let rows = history["t_ms"].len();
    assert!(rows > 30, "{rows} steps");
    let all = |column: &str, holds: fn(f64) -> bool| {
        for (t, value) in history["t_ms"].iter().zip(&history[column]) {
            assert!(holds(*value), "{column} is {value} at t = {t} ms");
        }
    };
    all("max_penetration_mm", |depth| depth <= 0.005);
    all("min_contact_force_N", |force| force >= -1e-6);
    all("balance_error", |error| error.abs() <= 1e-6);
    all("residual_norm_mm", |norm| norm <= 1e-9);
    if more.contains("-friction_coefficient") {
        all("cone_violation", |excess| excess <= 1e-6);
    }
}

#[test]
fn every_step_of_a_run_is_certified() {
    check("one", 1, "");
}

#[test]
fn every_step_of_a_static_run_on_two_ranks_is_certified() {
    check("static", 2, "-dynamics none");
}

#[test]
fn every_step_of_a_run_with_friction_is_certified() {
    check("friction", 1, "-friction_coefficient 0.1342");
}

/// Runs a small case with these options, which change what is solved, and returns its exit code and whether it is called good.
fn loosened(name: &str, more: &str) -> (Option<i32>, bool) {
    let folder = scratch(&format!("certificate-{name}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(
        "-sheet_nx 20 -sheet_ny 2 -stroke 0.2 -time_load 6.4 -unload_fraction 0 -output_every 0 -dt_min 0.05"
            .split(' '),
    );
    words.extend(more.split_whitespace());
    let ended = run(1, 120, &words);
    (ended.code, ended.says("every verdict holds"))
}

#[test]
fn options_that_loosen_what_is_solved_never_end_with_every_verdict_holding() {
    for (name, more) in [
        ("atol", "-snes_atol 1e-3"),
        ("atol-less", "-snes_atol 1e-6"),
        ("rtol", "-snes_rtol 1e-2"),
        ("own", "-newton_tolerance 1e-6"),
        (
            "skip",
            "-snes_convergence_test skip -newton_max_iterations 2",
        ),
        ("iterations", "-snes_max_it 1"),
        ("search", "-snes_linesearch_type bt"),
        ("own-loosest", "-newton_tolerance 1e-3"),
        ("both", "-snes_rtol 1e-2 -snes_lag_jacobian 3"),
        (
            "damped",
            "-snes_linesearch_type basic -snes_linesearch_damping 0.5",
        ),
        ("bounds", "-snes_vi_zero_tolerance 1e-2"),
        ("gmres", "-pc_type ilu -ksp_type gmres -ksp_rtol 1e-1"),
        ("bcgs", "-pc_type ilu -ksp_type bcgs -ksp_rtol 1e-1"),
        (
            "few",
            "-pc_type ilu -ksp_type bcgs -ksp_max_it 3 -ksp_converged_maxits",
        ),
        (
            "condensed",
            "-condensed_pc_type none -condensed_ksp_type gmres -condensed_ksp_rtol 1e-1",
        ),
    ] {
        let (code, good) = loosened(name, more);
        assert_eq!((code, good), (Some(1), false), "{more}");
    }
    // What would change the equations is refused before the run.
    for (name, more) in [
        ("beyond", "-newton_tolerance 1e-2"),
        ("radius", "-ts_alpha_radius 0.9"),
        ("no-equations", "-ts_alpha_beta 0.5"),
    ] {
        assert_eq!(loosened(name, more), (Some(2), false), "{more}");
    }
    // What changes the way and not the solution keeps its good end.
    for (name, more) in [
        ("none", ""),
        ("lag", "-snes_lag_jacobian 2 -newton_max_iterations 60"),
        // Without a test of convergence all twenty iterations are done, which leave less than the tolerance.
        ("untested", "-snes_convergence_test skip"),
        ("l2", "-snes_linesearch_type l2"),
        ("cp", "-snes_linesearch_type cp"),
        ("lu", "-pc_type lu"),
        // Two iterations a solve: fourteen short steps, each solved.
        ("two", "-snes_max_it 2"),
        (
            "exact",
            "-pc_type bjacobi -sub_pc_type lu -ksp_type gmres -ksp_rtol 1e-1",
        ),
    ] {
        assert_eq!(loosened(name, more), (Some(0), true), "{more}");
    }
}
