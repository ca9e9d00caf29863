//! `scripts/study.py factorial` on a tiny mesh: its table, a study that is killed and goes on, and what it refuses.

mod program;

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use program::{FEW_CORES, scratch};

/// A fifth of a millimetre on 20 x 2 elements: half a second.
const TINY: &str = "-options_file inputs/band.opts -sheet_nx 20 -sheet_ny 2 -stroke 0.2 -time_load 6.4 -time_unload 1";
const PLAN: &str = "friction_coefficient=0,0.1342 sheet_thickness=0.95,1.05";
const PROGRAM: &str = env!("CARGO_BIN_EXE_ssnp155");

fn study_with(program: &Path, words: &str) -> Output {
    Command::new("python3")
        .args(["-B", "scripts/study.py"])
        .args(words.split_whitespace())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("SSNP155", program)
        .envs(FEW_CORES)
        .output()
        .expect("python3 is needed")
}

fn study(words: &str) -> Output {
    study_with(Path::new(PROGRAM), words)
}

fn said(ended: &Output) -> String {
    String::from_utf8_lossy(&ended.stderr).into_owned()
}

/// Rows of a table by the names of its columns.
fn rows(folder: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(folder.join("runs.csv")).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn table(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("runs.csv")).unwrap()
}

/// A program that counts its runs in `count`, and sends its parent the signal in `signal`, once, when it is run no. 3.
fn counting(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("counting");
    let script = format!(
        "#!/bin/bash\ncd '{}'\ncase \"$*\" in *-dry_run*) ;; *)\n  echo run >>count\n  if [ -e signal ] && \
         [ $(wc -l <count) = 3 ]; then kill -$(cat signal) $PPID; rm signal; fi;;\nesac\ncd '{}'\nexec '{PROGRAM}' \"$@\"\n",
        folder.display(),
        env!("CARGO_MANIFEST_DIR"),
    );
    std::fs::write(&path, script).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[test]
fn a_factorial_has_every_combination_as_the_program_itself_finds_it() {
    let folder = scratch("study-factorial");
    let ended = study(&format!(
        "factorial {PLAN} --jobs 2 --folder {} -- {TINY}",
        folder.display()
    ));
    assert!(ended.status.success(), "{}", said(&ended));
    let shown = String::from_utf8_lossy(&ended.stdout);
    assert_eq!(
        shown.lines().filter(|line| line.starts_with("| ")).count(),
        5
    );
    let progress = said(&ended);
    assert!(
        progress.contains("4 of 4 runs, 0 failed") && !progress.contains(['\r', '\x1b']),
        "{progress:?}"
    );
    let found = rows(&folder);
    let combinations: Vec<[&str; 2]> = found
        .iter()
        .map(|row| ["friction_coefficient", "sheet_thickness"].map(|name| row[name].as_str()))
        .collect();
    assert_eq!(
        combinations,
        [
            ["0", "0.95"],
            ["0", "1.05"],
            ["0.1342", "0.95"],
            ["0.1342", "1.05"]
        ]
    );
    let own = scratch("study-own");
    let ended = Command::new(PROGRAM)
        .args(TINY.split_whitespace())
        .args("-unload_fraction 1 -friction_coefficient 0.1342 -sheet_thickness 0.95 -output_every 0 -output_dir".split(' '))
        .arg(&own)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .envs(FEW_CORES)
        .output()
        .unwrap();
    assert!(ended.status.code() < Some(2), "{}", said(&ended));
    let summary = std::fs::read_to_string(own.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    for (column, angle) in [
        ("loaded_deg", "full stroke"),
        ("withdrawn_deg", "end of the motion"),
    ] {
        let found: f64 = found[2][column].parse().unwrap();
        let own = summary["angles_deg"][angle].as_f64().unwrap();
        assert!((found - own).abs() < 1e-9, "{column}: {found} {own}");
    }
    assert!(
        !folder.join("run-0001").exists(),
        "folders of finished runs are removed"
    );
}

#[test]
fn a_study_that_was_killed_or_ended_goes_on_to_the_same_table() {
    let unbroken = scratch("study-unbroken");
    let program = counting(&unbroken);
    let whole = study_with(
        &program,
        &format!("factorial {PLAN} --folder {} -- {TINY}", unbroken.display()),
    );
    assert!(whole.status.success(), "{}", said(&whole));
    for (signal, code) in [("KILL", None), ("TERM", Some(3))] {
        let folder = scratch(&format!("study-{signal}"));
        let program = counting(&folder);
        std::fs::write(folder.join("signal"), signal).unwrap();
        let words = format!("factorial {PLAN} --folder {} -- {TINY}", folder.display());
        let broken = study_with(&program, &words);
        assert_eq!(broken.status.code(), code, "{}", said(&broken));
        assert_eq!(
            rows(&folder).len(),
            2,
            "the third run is not in the table yet"
        );
        assert_eq!(
            said(&broken).contains("interrupted with 2 of 4 runs"),
            signal == "TERM"
        );
        let resumed = study_with(&program, &words);
        assert!(resumed.status.success(), "{}", said(&resumed));
        assert_eq!(table(&folder), table(&unbroken));
        // Two, the interrupted one, and the two that were missing.
        let count = std::fs::read_to_string(folder.join("count")).unwrap();
        assert_eq!(count.lines().count(), 5);
    }
}

#[test]
fn a_failed_run_is_a_row_with_its_reason_and_made_again_on_request_only() {
    let folder = scratch("study-failed");
    let program = counting(&folder);
    // One run cannot converge, another has a value out of range.
    let words = format!(
        "factorial newton_max_iterations=20,1,1001 --folder {} -- {TINY} -dt_min 0.5",
        folder.display()
    );
    for (again, count) in [("", 3), ("", 3), (" --again", 5)] {
        let ended = study_with(
            &program,
            &words.replacen(" --folder", &format!("{again} --folder"), 1),
        );
        assert_eq!(ended.status.code(), Some(1), "{}", said(&ended));
        let found = rows(&folder);
        assert_eq!(
            found.iter().map(|row| &row["status"]).collect::<Vec<_>>(),
            ["finished", "failed", "failed"]
        );
        assert!(
            found[1]["reason"].starts_with("not converged: ")
                && found[2]["reason"].contains("1001: the value is out of range"),
            "{found:?}"
        );
        assert!(
            folder.join("run-0002/run.log").exists(),
            "a failed run is kept"
        );
        assert!(
            said(&ended).contains("study: run 2 failed: not converged"),
            "{}",
            said(&ended)
        );
        let made = std::fs::read_to_string(folder.join("count")).unwrap();
        assert_eq!(made.lines().count(), count);
    }
}

#[test]
fn the_table_of_another_study_is_refused_and_left_alone() {
    let folder = scratch("study-foreign");
    let at = format!("--folder {}", folder.display());
    let first = study(&format!(
        "factorial friction_coefficient=0,0.1 {at} -- {TINY}"
    ));
    assert!(first.status.success(), "{}", said(&first));
    let before = table(&folder);
    for (words, differs) in [
        (
            format!("factorial friction_coefficient=0,0.2 {at} -- {TINY}"),
            "parameters",
        ),
        (
            format!("factorial friction_coefficient=0,0.1 {at} -- {TINY} -quadrature 3"),
            "options",
        ),
    ] {
        let ended = study(&words);
        assert_eq!(ended.status.code(), Some(1));
        let sentence = format!("is the table of another study, which differs in: {differs};");
        assert!(said(&ended).contains(&sentence), "{}", said(&ended));
    }
    // As while another study is at work: flock(1) holds the lock.
    let second = Command::new("flock")
        .arg(folder.join(".lock"))
        .args(["python3", "-B", "scripts/study.py", "factorial"])
        .args(["friction_coefficient=0,0.1", "--folder"])
        .arg(&folder)
        .arg("--")
        .args(TINY.split_whitespace())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("SSNP155", PROGRAM)
        .output()
        .unwrap();
    assert!(
        said(&second).contains("another study is at work in"),
        "{}",
        said(&second)
    );
    assert_eq!(table(&folder), before);
    let other = study_with(
        &counting(&folder),
        &format!("factorial friction_coefficient=0,0.1 {at} -- {TINY}"),
    );
    assert!(
        said(&other).contains("which differs in: program;"),
        "{}",
        said(&other)
    );
    std::fs::write(
        folder.join("runs.csv"),
        before.replacen("1,0,", "1,0.3,", 1),
    )
    .unwrap();
    let changed = study(&format!(
        "factorial friction_coefficient=0,0.1 {at} -- {TINY}"
    ));
    assert!(
        said(&changed).contains("row 1 of") && said(&changed).contains("has other values"),
        "{}",
        said(&changed)
    );
}

#[test]
fn words_that_make_no_study_are_answered_with_one_sentence() {
    let folder = scratch("study-words");
    for (words, answer) in [
        (
            "factorial friction_coefficient",
            "'friction_coefficient' is no parameter; write NAME=...",
        ),
        (
            "factorial stroke=1,2,1",
            "stroke=1,2,1: a value is empty or there twice",
        ),
        (
            "factorial stroke=1,2 stroke=3",
            "parameter stroke is there twice",
        ),
        (
            "factorial stroke=1,2 -- -stroke 3",
            "-stroke is a parameter of the study",
        ),
        (
            "factorial stroke=1,2 -- -restart newest",
            "-restart cannot be among the options of a study",
        ),
        (
            "factorial output_dir=a,b",
            "output_dir cannot be a parameter",
        ),
        ("factorial stroke=1,2 --jobs 0", "--jobs 0: take 1 or more"),
        ("factorial stroke=1,2 --seed 3", "unrecognized arguments"),
        (
            "factorial strike=1,2 --folder FOLDER",
            "does not take the options of the first run: ssnp155: option -strike is unknown",
        ),
        (
            "factorial stroke=1,2 -- -options_file no.opts",
            "no.opts cannot be read",
        ),
        ("sample 10 stroke", "'stroke' is no parameter"),
        ("sample 10 stroke=1,2", "'stroke=1,2' has no distribution"),
        (
            "sample 10 stroke=2:1",
            "the lower bound 2 is not below the upper one 1",
        ),
        (
            "sample 10 stroke=normal:1:0",
            "the deviation 0 has to be above 0",
        ),
        ("sample 1 stroke=1:2", "a sample of 1 runs says nothing"),
        ("sample 4 stroke=1:2 --seed -1", "--seed -1: take 0 or more"),
    ] {
        let words = words.replace("FOLDER", &folder.join("new").display().to_string());
        let ended = study(&words);
        assert_eq!(ended.status.code(), Some(1), "{words}: {}", said(&ended));
        let text = said(&ended);
        assert!(
            text.contains(answer) && text.trim().lines().count() == 1,
            "{words}: {text}"
        );
    }
}

#[test]
fn a_sample_says_which_package_it_needs() {
    let folder = scratch("study-packages");
    for name in ["numpy", "scipy"] {
        std::fs::write(
            folder.join(format!("{name}.py")),
            format!("raise ModuleNotFoundError('none', name='{name}')\n"),
        )
        .unwrap();
    }
    for (words, what) in [
        ("sample 4 stroke=1:2", "a sample"),
        ("analyse nowhere", "an analysis"),
    ] {
        let ended = Command::new("python3")
            .args(["-B", "scripts/study.py"])
            .args(words.split_whitespace())
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .env("PYTHONPATH", &folder)
            .output()
            .unwrap();
        let text = said(&ended);
        assert!(
            text.starts_with(&format!("study: {what} needs the package 'numpy'")),
            "{text}"
        );
        assert!(
            text.contains("scripts/requirements.txt") && text.trim().lines().count() == 1,
            "{text}"
        );
    }
}
