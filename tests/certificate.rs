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
    assert!(ended.stdout.contains("FINISHED"), "{}", ended.text());
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
