//! The program as a library: the example in examples/ is as short as it is called, and what it prints is the history.

mod program;

use std::path::Path;
use std::process::Command;

use program::{FEW_CORES, history, scratch};

const SOURCE: &str = include_str!("../examples/force_curve.rs");

/// Examples lie beside the program; cargo builds them with the tests.
fn example() -> std::path::PathBuf {
    let program = Path::new(env!("CARGO_BIN_EXE_ssnp155"));
    program.parent().unwrap().join("examples/force_curve")
}

#[test]
fn the_example_prints_the_forces_of_its_history() {
    assert!(SOURCE.lines().count() <= 30);
    let folder = scratch("example");
    let ended = Command::new("timeout")
        .args(["-k", "5", "60"])
        .arg(example())
        .envs(FEW_CORES)
        .current_dir(&folder)
        .output()
        .unwrap();
    let shown = String::from_utf8_lossy(&ended.stdout);
    assert!(
        ended.status.success(),
        "{shown}\n{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    let history = history(&folder.join("results-example"));
    let rows = history["stroke_mm"].iter().zip(&history["force_N"]);
    let expected: Vec<String> = rows
        .map(|(stroke, force)| format!("{stroke:.4} mm  {force:.3} N"))
        .collect();
    assert!(expected.len() >= 4, "{expected:?}");
    assert_eq!(shown.lines().collect::<Vec<_>>(), expected);
}
