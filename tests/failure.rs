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
            "#  seen     ",
            "#  tried    ",
            "#  try      -newton_max_iterations 20 (now 2)",
            "         refused: step to ",
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
        let diagnosis = &summary["diagnosis"];
        for part in ["observed", "tried", "remedies"] {
            assert!(!diagnosis[part].as_array().unwrap().is_empty(), "{part}");
        }
        let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
        assert!(page.contains(diagnosis["cause"].as_str().unwrap()));
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
        ended.says("after step 0, t = 0.0000 ms"),
        "{}",
        ended.stdout
    );
    assert!(ended.says(" more ..."), "{}", ended.stdout);
    assert!(
        ended.stdout.matches("#  tried").count() <= 4,
        "{}",
        ended.stdout
    );
    // The header comes with the first row.
    assert!(history(&folder).is_empty());
    assert_eq!(summary(&folder)["counts"]["steps"], 0);
}

/// With very stiff friction, points stick and slip in turn: the banner says which, and what to do, on any number of
/// ranks. (60 x 2 elements, 11.7 mm deep.)
#[test]
fn points_that_stick_and_slip_are_named_with_their_place() {
    for ranks in [1, 2] {
        let folder = scratch(&format!("failure-slip-{ranks}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend("-sheet_nx 60 -sheet_ny 2 -output_every 0 -dt_min 0.1".split(' '));
        words.extend("-friction_coefficient 0.1342 -friction_compliance 1e-9".split(' '));
        let ended = run(ranks, 60, &words);
        assert_eq!(ended.code, Some(1), "{}", ended.text());
        let diagnosis = &summary(&folder)["diagnosis"];
        let seen = diagnosis["observed"].to_string();
        assert!(
            seen.contains("contact points stick and slip") && seen.contains("under the punch at"),
            "{seen}"
        );
        let first = diagnosis["remedies"][0].as_str().unwrap();
        assert!(
            first.starts_with("-friction_compliance 5e-4 (now 1e-9)"),
            "{first}"
        );
    }
}

/// An inverted element is named, also if it belongs to another rank than the first.
#[test]
fn an_inverted_element_is_named() {
    for ranks in [1, 2] {
        let folder = scratch(&format!("failure-element-{ranks}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend("-sheet_nx 40 -sheet_ny 2 -output_every 0".split(' '));
        words.extend("-dt_initial 900 -dt_max 900 -dt_min 500".split(' '));
        let ended = run(ranks, 60, &words);
        assert_eq!(ended.code, Some(1), "{}", ended.text());
        let diagnosis = &summary(&folder)["diagnosis"];
        let cause = diagnosis["cause"].to_string();
        assert!(cause.contains("An element became inverted"), "{cause}");
        let seen = diagnosis["observed"][0].to_string();
        assert!(
            seen.contains("determinant") && seen.contains("along the sheet"),
            "{seen}"
        );
    }
}

/// Where contact points are too far apart the punch goes through the sheet: no verdict says why, so the banner does.
#[test]
fn a_punch_that_passes_between_the_points_is_reported() {
    for (elements, points) in [("1", "6"), ("2", "6"), ("3", "1")] {
        let folder = scratch(&format!("failure-passes-{elements}-{points}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend([
            "-sheet_nx",
            elements,
            "-sheet_ny",
            "1",
            "-output_every",
            "0",
        ]);
        words.extend(["-contact_points_per_edge", points]);
        let ended = run(1, 60, &words);
        assert_eq!(ended.code, Some(1), "{}", ended.text());
        let notes = summary(&folder)["notes"].clone();
        let note = notes[0].as_str().unwrap();
        assert!(
            note.contains("between its contact points") && note.contains("use -sheet_nx"),
            "{note}"
        );
        // Such a run may reach the end or not; the note stands in either banner.
        assert!(ended.says("  note     A tool"), "{}", ended.stdout);
    }
}
