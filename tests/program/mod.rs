//! Shared by the tests that run the program: start it on some ranks with a time limit, and read what it wrote.

#![allow(dead_code)]

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use rustix::process::{Pid, Signal, kill_process};

#[path = "../mpi_environment/mod.rs"]
mod mpi_environment;
pub use mpi_environment::FEW_CORES;

/// How a run of the program ended.
pub struct Ended {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Ended {
    /// Whether these words were shown, wherever lines are broken.
    pub fn says(&self, words: impl AsRef<str>) -> bool {
        let joined = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        joined(&self.stdout).contains(&joined(words.as_ref()))
    }

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

/// Sends a signal to a process.
pub fn send(process: u32, signal: Signal) {
    let process = Pid::from_raw(process as i32).expect("a process has a number");
    kill_process(process, signal).unwrap();
}

/// The program on some ranks with these words, not started; without a limit of time.
pub fn command(ranks: usize, words: &[&str]) -> Command {
    let program = env!("CARGO_BIN_EXE_ssnp155");
    let mut command = if ranks == 1 {
        Command::new(program)
    } else {
        let mut command = Command::new("mpirun");
        command.args(["-n", &ranks.to_string(), program]);
        command
    };
    command.args(words);
    command.envs(FEW_CORES);
    command
}

/// Runs the program with these words, by mpirun if there is more than one rank. A run that takes longer than `seconds`
/// is ended, with code 124.
pub fn run(ranks: usize, seconds: u32, words: &[&str]) -> Ended {
    run_in(Path::new("."), None, ranks, seconds, words)
}

/// The same with words in several parts, and their results in `folder`; within five minutes.
pub fn run_into(folder: &Path, ranks: usize, parts: &[&str]) -> Ended {
    let words = parts.iter().flat_map(|part| part.split_whitespace());
    let mut words: Vec<&str> = words.collect();
    words.extend(["-output_dir", folder.to_str().unwrap()]);
    run(ranks, 300, &words)
}

/// As [`run`] in a folder, and with a variable in the environment.
pub fn run_in(
    folder: &Path,
    environment: Option<(&str, &str)>,
    ranks: usize,
    seconds: u32,
    words: &[impl AsRef<OsStr>],
) -> Ended {
    let mut command = Command::new("timeout");
    command.args(["-k", "5", &seconds.to_string()]);
    if ranks > 1 {
        command.args(["mpirun", "-n", &ranks.to_string()]);
    }
    command.arg(env!("CARGO_BIN_EXE_ssnp155")).args(words);
    command
        .envs(FEW_CORES)
        .envs(environment)
        .current_dir(folder);
    let output = command.output().expect("timeout and mpirun are needed");
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: without_starter(&String::from_utf8_lossy(&output.stderr)),
    }
}

/// Standard error without what Open MPI 5 says about a rank that ended with another code than 0: a paragraph between
/// two lines of dashes that begins with the name of its starter, and on a busy machine a line about a rank that is gone
/// already.
fn without_starter(text: &str) -> String {
    let rule = "-".repeat(74);
    let mut kept = String::new();
    let mut parts = text.split(&*rule).peekable();
    while let Some(part) = parts.next() {
        kept += part;
        if parts
            .peek()
            .is_some_and(|next| next.trim_start().starts_with("prterun detected"))
        {
            parts.next();
        } else if parts.peek().is_some() {
            kept += &rule;
        }
    }
    let says_something = |line: &&str| !line.contains("] PMIX ERROR: PMIX_ERR_UNREACH");
    kept.split_inclusive('\n').filter(says_something).collect()
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

/// Everything in a run's field files that may not differ: all arrays by name, without the times of writing.
pub fn fields(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for name in ["fields.vtkhdf", "contact.vtkhdf", "tools.vtkhdf"] {
        let file = hdf5::File::open(folder.join(name)).unwrap();
        collect(&file.group("VTKHDF").unwrap(), name, &mut found);
    }
    found
}

fn collect(group: &hdf5::Group, name: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for dataset in group.datasets().unwrap() {
        let bytes = match dataset.dtype().unwrap().size() {
            8 => dataset.read_raw::<f64>().map_or_else(
                |_| numbers(&dataset.read_raw::<i64>().unwrap(), i64::to_ne_bytes),
                |values| numbers(&values, f64::to_ne_bytes),
            ),
            4 => numbers(&dataset.read_raw::<i32>().unwrap(), i32::to_ne_bytes),
            _ => dataset.read_raw::<u8>().unwrap(),
        };
        found.insert(format!("{name}:{}", dataset.name()), bytes);
    }
    for group in group.groups().unwrap() {
        collect(&group, name, found);
    }
}

fn numbers<T: Copy, const N: usize>(values: &[T], bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|&value| bytes(value)).collect()
}
