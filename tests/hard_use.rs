//! Pipes that close, signals, folders in use, and PETSc's options: the short cases of `scripts/hard_use.py`, each with the
//! exit code, the last sentence and the files it has to end with.

use std::process::Command;

#[path = "mpi_environment/mod.rs"]
mod mpi_environment;

#[test]
fn every_short_case_ends_as_it_has_to() {
    let folder = env!("CARGO_TARGET_TMPDIR");
    std::fs::create_dir_all(folder).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/hard_use.py");
    let ended = Command::new("python3")
        .args(["-B", script, "fast"])
        .env("SSNP155", env!("CARGO_BIN_EXE_ssnp155"))
        .env("HARD_USE_DIR", folder)
        .envs(mpi_environment::FEW_CORES)
        .output()
        .expect("python3 is needed");
    let text = String::from_utf8_lossy(&ended.stdout);
    assert!(
        ended.status.success(),
        "{text}\n{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    let good = text.lines().filter(|line| line.starts_with("good")).count();
    assert!(good >= 15, "{text}");
}
