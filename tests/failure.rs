//! A run that cannot be solved says so: a banner with place and reason, a code that is not 0, and files that hold what
//! was reached.

mod program;

use hdf5::File;
use program::{history, run, scratch, summary};

const CASE: &str =
    "-sheet_nx 40 -sheet_ny 2 -stroke 5 -time_load 158 -unload_fraction 0 -dt_min 0.1";

/// Two Newton iterations are enough for the first step and not for the second; shorter ones are not allowed.
#[test]
fn a_run_that_cannot_go_on_says_where_and_why() {
    for ranks in [1, 2] {
        let folder = scratch(&format!("failure-{ranks}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend(CASE.split(' '));
        words.extend(["-newton_max_iterations", "2"]);
        let ended = run(ranks, 60, &words);
        assert_eq!(ended.code, Some(1), "{}", ended.text());
        assert_eq!(ended.stderr.trim(), "", "{ranks} ranks");
        let text = &ended.stdout;
        assert_eq!(text.matches("FAILED: the run did not finish").count(), 1);
        assert!(!text.contains("FINISHED"), "{text}");
        for part in [
            "#  where    after step ",
            "#  why      ",
            "-dt_min 0.1 ms",
            "#  try  ",
        ] {
            assert!(text.contains(part), "{part} is missing in {text}");
        }

        let history = history(&folder);
        let times = &history["t_ms"];
        assert!(
            !times.is_empty() && times.len() < 20,
            "{} steps",
            times.len()
        );
        let summary = summary(&folder);
        assert_eq!(summary["status"], "not converged");
        assert_eq!(summary["counts"]["steps"], times.len());
        assert!(summary["reason"].as_str().unwrap().contains("refused"));
        for name in ["fields.vtkhdf", "tools.vtkhdf", "contact.vtkhdf"] {
            let file = File::open(folder.join(name)).unwrap();
            let steps = file.group("VTKHDF/Steps").unwrap();
            let values = steps.dataset("Values").unwrap().read_raw::<f64>().unwrap();
            // The fields begin with the state before the first step.
            assert_eq!(values[1..], times[..], "{name}");
        }
    }
}

/// PETSc repeats a refused first step at the same length; the program shortens it.
#[test]
fn a_first_step_that_is_refused_is_shortened_until_it_works() {
    let folder = scratch("failure-first");
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(CASE.split(' '));
    words.extend(
        "-dt_initial 9 -newton_max_iterations 3 -stroke 20 -time_load 100 -dt_max 30".split(' '),
    );
    words.extend(["-dt_min", "1e-6", "-ts_max_steps", "1"]);
    run(1, 60, &words);
    let history = history(&folder);
    assert!(
        history["refused_solves"][0] > 0.0,
        "the first step is not refused"
    );
    assert!(history["dt_ms"][0] < 9.0);
}

/// Where not even the first step can be solved, there are no rows, and few lines about many attempts.
#[test]
fn a_run_without_any_step_ends_too() {
    let folder = scratch("failure-none");
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(CASE.split(' '));
    words.extend(
        "-newton_max_iterations 1 -stroke 0.9 -dt_initial 158 -dt_max 158 -dt_min 0.05".split(' '),
    );
    let ended = run(1, 60, &words);
    assert_eq!(ended.code, Some(1), "{}", ended.text());
    assert!(
        ended.stdout.contains("after step 0, t = 0.0000 ms"),
        "{}",
        ended.stdout
    );
    assert!(ended.stdout.contains(" more ..."), "{}", ended.stdout);
    assert!(
        ended.stdout.matches("tried").count() <= 4,
        "{}",
        ended.stdout
    );
    // The header comes with the first row.
    assert!(history(&folder).is_empty());
    assert_eq!(summary(&folder)["counts"]["steps"], 0);
}
