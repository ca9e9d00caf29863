//! A run that was stopped and goes on has the rows and fields of one that was not, to the last bit; a checkpoint that
//! does not fit is refused.

mod program;

use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use program::{Ended, command, fields, history, run, scratch, send, summary};
use rustix::process::Signal;

const CASE: &str = "-sheet_nx 20 -sheet_ny 2 -stroke 2 -time_load 63 -unload_fraction 0.3 -time_unload 20 \
                    -report_strokes 1 -output_every 2";

fn words<'a>(folder: &'a Path, parts: &[&'a str]) -> Vec<&'a str> {
    let mut words: Vec<&str> = parts
        .iter()
        .flat_map(|part| part.split_whitespace())
        .collect();
    words.extend(["-output_dir", folder.to_str().unwrap()]);
    words
}

fn start(folder: &Path, ranks: usize, parts: &[&str]) -> Ended {
    run(ranks, 120, &words(folder, parts))
}

fn rows(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("history.csv")).unwrap()
}

/// Ends the run after `steps` steps; what it says about its end is not looked at.
fn first_part(folder: &Path, ranks: usize, parts: &[&str], steps: usize) {
    let steps = format!("-ts_max_steps {steps} -checkpoint_every 1");
    start(folder, ranks, &[parts, &[&steps]].concat());
}

fn same(name: &str, ranks: usize, parts: &[&str]) {
    let folder = scratch(&format!("restart-{name}"));
    let (unbroken, broken) = (folder.join("unbroken"), folder.join("broken"));
    let whole = start(&unbroken, ranks, parts);
    let steps = history(&unbroken)["t_ms"].len();
    first_part(&broken, ranks, parts, steps / 2);
    let ended = start(&broken, ranks, &[parts, &["-restart"]].concat());
    assert_eq!(ended.code, whole.code, "{name}: {}", ended.text());
    assert!(ended.says("resumed from"), "{name}: {}", ended.text());
    assert_eq!(rows(&broken), rows(&unbroken), "{name}");
    let (expected, found) = (fields(&unbroken), fields(&broken));
    assert!(
        expected.len() > 30 && expected.keys().eq(found.keys()),
        "{name}"
    );
    for (array, values) in &expected {
        assert!(found[array] == *values, "{name}: {array} differs");
    }
    for key in ["status", "counts", "angles_deg", "verdicts", "worst"] {
        assert_eq!(
            summary(&broken)[key],
            summary(&unbroken)[key],
            "{name}: {key}"
        );
    }
}

#[test]
fn a_resumed_run_is_the_unbroken_one_to_the_last_bit() {
    same("plain", 1, &[CASE]);
    same("friction", 1, &[CASE, "-friction_coefficient 0.1342"]);
    same(
        "static",
        1,
        &[CASE, "-friction_coefficient 0.1342 -dynamics none"],
    );
    let moving = "-contact_location closest -friction_coefficient 0.1342";
    same("moving-points", 1, &[CASE, moving]);
}

/// MUMPS on several ranks adds in the order in which messages come, so that two unbroken runs differ in the last bits;
/// PETSc's own factorisation on every rank does not.
#[test]
fn on_two_ranks_too() {
    same("two-ranks", 2, &[CASE, "-friction_coefficient 0.1342"]);
}

/// Every option file, on a coarse mesh and a short way.
#[test]
fn every_case_can_be_resumed() {
    let mut count = 0;
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/inputs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "opts") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let file = format!("-options_file {}", path.to_str().unwrap());
        // Equal steps would be as many as in the whole run.
        let many = ["-fixed_steps_load 900", "-fixed_steps_unload 400"];
        let fewer = if many.iter().any(|steps| text.contains(steps)) {
            "-fixed_steps_load 10 -fixed_steps_unload 4"
        } else {
            ""
        };
        let short =
            "-sheet_nx 20 -sheet_ny 2 -stroke 1 -time_load 32 -time_unload 32 -output_every 2";
        same(name, 1, &[&file, short, fewer]);
        count += 1;
    }
    assert!(count >= 7);
}

#[test]
fn another_number_of_ranks_goes_on_too() {
    let folder = scratch("restart-ranks");
    let unbroken = folder.join("unbroken");
    let parts = [CASE, "-friction_coefficient 0.1342"];
    start(&unbroken, 1, &parts);
    let expected = history(&unbroken);
    let (first, second, third) = (folder.join("1"), folder.join("2"), folder.join("3"));
    first_part(&first, 1, &parts, 6);
    let from = format!("-restart {}", first.join("checkpoint-000006").display());
    first_part(&second, 3, &[&parts[..], &[&from]].concat(), 10);
    let from = format!("-restart {}", second.join("checkpoint-000010").display());
    let ended = start(&third, 2, &[&parts[..], &[&from]].concat());
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let found = history(&third);
    assert_eq!(found["t_ms"], expected["t_ms"]);
    for (column, tolerance) in [
        ("force_N", 1e-6),
        ("angle_deg", 1e-6),
        ("external_work_mJ", 1e-6),
    ] {
        for (a, b) in found[column].iter().zip(&expected[column]) {
            assert!(
                (a - b).abs() <= tolerance * b.abs(),
                "{column}: {a} and {b}"
            );
        }
    }
    // Three ranks' files became those of two.
    let sizes = |folder: &Path| {
        let file = hdf5::File::open(folder.join("fields.vtkhdf")).unwrap();
        let root = file.group("VTKHDF").unwrap();
        let steps = root.dataset("Steps/Values").unwrap().size();
        let parts = root.dataset("NumberOfPoints").unwrap().size();
        (parts, steps)
    };
    assert_eq!(sizes(&third), (2, sizes(&unbroken).1));
}

/// The solve that was refused has left nothing behind: the step that follows it is the one that a run makes which chose
/// that length by itself.
#[test]
fn a_refused_step_leaves_no_trace() {
    let folder = scratch("restart-refused");
    let hard = "-sheet_nx 20 -sheet_ny 2 -stroke 4 -time_load 40 -unload_fraction 0 -report_strokes none \
                -extrapolate false -dt_initial 2 -dt_max 2 -friction_coefficient 0.1342";
    let refusing = [hard, "-newton_max_iterations 5"];
    let whole = folder.join("whole");
    start(&whole, 1, &refusing);
    let expected = history(&whole);
    let refused = &expected["refused_solves"];
    let step = (1..refused.len())
        .find(|&k| refused[k] == 1.0)
        .expect("no step is refused once");
    let again = folder.join("again");
    first_part(&again, 1, &refusing, step);
    start(
        &again,
        1,
        &[
            hard,
            "-newton_max_iterations 5 -dt_max 0.8 -dt_initial 0.8 -restart",
        ],
    );
    let found = history(&again);
    assert_eq!(found["refused_solves"][step], 0.0);
    for (column, values) in expected
        .iter()
        .filter(|(name, _)| *name != "refused_solves")
    {
        assert_eq!(found[column][step], values[step], "{column}");
    }
}

const LONGER: &str = "-sheet_nx 60 -sheet_ny 2 -stroke 12 -time_load 378 -unload_fraction 0 -report_strokes none \
                      -dt_max 3 -output_every 10";

/// Starts the program, waits until it has made some steps, and sends a signal.
fn signal_after_steps(folder: &Path, ranks: usize, signal: Signal) -> (Child, Option<i32>, String) {
    let log = folder.with_extension("log");
    let mut child = command(ranks, &words(folder, &[LONGER]))
        .stdout(std::fs::File::create(&log).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let began = Instant::now();
    while std::fs::read_to_string(folder.join("history.csv")).map_or(0, |text| text.lines().count())
        < 8
    {
        assert!(began.elapsed() < Duration::from_secs(60), "no steps");
        std::thread::sleep(Duration::from_millis(10));
    }
    send(child.id(), signal);
    let code = child.wait().unwrap().code();
    (child, code, std::fs::read_to_string(log).unwrap())
}

#[test]
fn a_signal_ends_a_run_that_goes_on_later() {
    let folder = scratch("restart-signal");
    let unbroken = folder.join("unbroken");
    assert_eq!(start(&unbroken, 1, &[LONGER]).code, Some(0));
    for (ranks, signal, name) in [
        (1, Signal::TERM, "SIGTERM"),
        (1, Signal::INT, "SIGINT"),
        (2, Signal::USR1, "SIGUSR1"),
    ] {
        let stopped = folder.join(format!("stopped-{name}"));
        let (_, code, text) = signal_after_steps(&stopped, ranks, signal);
        assert_eq!(code, Some(3), "{name}: {text}");
        assert!(
            text.contains("INTERRUPTED") && !text.contains("FINISHED"),
            "{text}"
        );
        assert!(text.contains(name), "{text}");
        let end = summary(&stopped);
        assert_eq!(end["status"], "interrupted");
        assert!(end["reason"].as_str().unwrap().contains(name));
        let made = history(&stopped)["t_ms"].len();
        assert!(
            stopped
                .join(format!("checkpoint-{made:06}/manifest.txt"))
                .exists()
        );
        if ranks == 1 {
            assert_eq!(start(&stopped, 1, &[LONGER, "-restart"]).code, Some(0));
            assert_eq!(rows(&stopped), rows(&unbroken));
            assert_eq!(summary(&stopped)["status"], "finished");
        }
    }
    let stopped = folder.join("limit");
    let began = Instant::now();
    let ended = start(&stopped, 1, &[LONGER, "-wall_limit 0:00:00.7"]);
    assert_eq!(
        ended.code,
        Some(3),
        "{} after {:?}",
        ended.text(),
        began.elapsed()
    );
    assert!(ended.says("the time that -wall_limit allows is nearly used up"));
    assert_eq!(start(&stopped, 1, &[LONGER, "-restart"]).code, Some(0));
    assert_eq!(rows(&stopped), rows(&unbroken));
}

fn refusal(folder: &Path, parts: &[&str]) -> String {
    let before = rows(folder);
    let ended = start(folder, 1, parts);
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    assert_eq!(ended.stderr.trim().lines().count(), 1, "{}", ended.stderr);
    assert_eq!(
        rows(folder),
        before,
        "a refused restart may not touch the results"
    );
    ended.stderr
}

fn flip(path: PathBuf, byte: usize) {
    let mut bytes = std::fs::read(&path).unwrap();
    bytes[byte] ^= 4;
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn a_checkpoint_that_does_not_fit_is_refused() {
    let folder = scratch("restart-refusals");
    start(&folder, 1, &[CASE, "-ts_max_steps 3"]);
    let text = refusal(&folder, &[CASE, "-restart"]);
    assert!(text.contains("there is no checkpoint in"), "{text}");
    let text = refusal(&folder, &[CASE, "-restart elsewhere"]);
    assert!(
        text.contains("the checkpoint elsewhere cannot be used"),
        "{text}"
    );
    let unbroken = folder.join("unbroken");
    start(&unbroken, 1, &[CASE]);
    first_part(&folder, 1, &[CASE], 6);
    let other = [CASE, "-stroke 2.5 -quadrature 3 -output_every 1 -restart"];
    let text = refusal(&folder, &other);
    for part in [
        "another problem",
        "-stroke was 2 and is 2.5",
        "-quadrature was 2 and is 3",
    ] {
        assert!(text.contains(part), "{text}");
    }
    assert!(!text.contains("output_every"), "{text}");
    flip(folder.join("checkpoint-000006/state.h5"), 3000);
    let newest = format!("-restart {}", folder.join("checkpoint-000006").display());
    let text = refusal(&folder, &[CASE, &newest]);
    assert!(text.contains("state.h5 is damaged"), "{text}");
    // The one before is whole.
    let ended = start(&folder, 1, &[CASE, "-restart"]);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    for part in [
        "checkpoint-000006 cannot be used",
        "the one before is taken",
        "step 5,",
    ] {
        assert!(ended.says(part), "{}", ended.stdout);
    }
    assert_eq!(rows(&folder), rows(&unbroken));
    assert!(!folder.join("checkpoint-000006").exists());
    flip(folder.join("checkpoint-000005/manifest.txt"), 5);
    let text = refusal(&folder, &[CASE, "-restart"]);
    assert!(text.contains("manifest.txt is damaged"), "{text}");
}
