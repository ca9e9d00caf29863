//! Shared by the tests that run the program: start it on some ranks with a time limit, and read what it wrote.

#![allow(dead_code)]

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How a run of the program ended.
pub struct Ended {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Ended {
    /// Everything shown.
    pub fn text(&self) -> String {
        format!("{}\n{}", self.stdout, self.stderr)
    }
}

/// A new empty folder for the files of a test.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs the program with these words, by mpirun if there is more than one rank. A run that takes longer than `seconds`
/// is ended, with code 110 by mpirun or 124 otherwise.
pub fn run(ranks: usize, seconds: u32, words: &[&str]) -> Ended {
    run_in(Path::new("."), None, ranks, seconds, words)
}

/// The same in a folder, and with a variable in the environment.
pub fn run_in(
    folder: &Path,
    environment: Option<(&str, &str)>,
    ranks: usize,
    seconds: u32,
    words: &[impl AsRef<OsStr>],
) -> Ended {
    let mut command = Command::new("timeout");
    command.args(["-k", "5"]);
    if ranks == 1 {
        command.arg(seconds.to_string());
    } else {
        // mpirun's own limit ends the ranks; the outer one is for an mpirun that hangs itself.
        command.args([&(seconds + 10).to_string(), "mpirun", "-q", "--timeout"]);
        command.args([
            &seconds.to_string(),
            "--oversubscribe",
            "-n",
            &ranks.to_string(),
        ]);
    }
    command.arg(env!("CARGO_BIN_EXE_ssnp155")).args(words);
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_hwloc_base_binding_policy", "none")
        .env("OMPI_MCA_btl_vader_single_copy_mechanism", "none")
        // More ranks than cores must not wait in a busy loop for those that have none.
        .env("OMPI_MCA_mpi_yield_when_idle", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .env("OMP_NUM_THREADS", "1")
        .envs(environment)
        .current_dir(folder);
    let output = command.output().expect("timeout and mpirun are needed");
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// The columns of a run's `history.csv` by name.
pub fn history(folder: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_path(folder.join("history.csv"))
        .unwrap();
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let mut columns: BTreeMap<String, Vec<f64>> = names
        .iter()
        .map(|name| (name.clone(), Vec::new()))
        .collect();
    for row in reader.records() {
        for (name, value) in names.iter().zip(row.unwrap().iter()) {
            columns.get_mut(name).unwrap().push(value.parse().unwrap());
        }
    }
    columns
}

/// A run's `summary.json`.
pub fn summary(folder: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}
