//! Bakes provenance into the program: git revision and the PETSc it is built against.

use std::{env, path::Path, process::Command};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Only what is there: a file that is missing would mean a new build each time.
    for name in ["HEAD", "refs"] {
        let path = git(&["rev-parse", "--git-path", name]);
        if let Some(path) = path.filter(|path| Path::new(path).exists()) {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    println!("cargo:rustc-env=SSNP155_REVISION={}", revision());
    let petsc = |name: &str| env::var(format!("DEP_PETSC_RS_{name}"));
    let version = petsc("VERSION").unwrap_or_else(|_| "unknown".to_owned());
    println!("cargo:rustc-env=SSNP155_PETSC={version}");
    // A PETSc of one's own lies where the loader does not look by itself.
    if let Ok(folder) = petsc("LIBRARY") {
        println!("cargo:rustc-link-arg=-Wl,-rpath,{folder}");
    }
}

/// The commit, with a mark if tracked files differ from it; `unknown` outside a repository.
fn revision() -> String {
    match git(&["rev-parse", "--short=12", "HEAD"]) {
        Some(commit) => match git(&["status", "--porcelain", "--untracked-files=no"]) {
            Some(changes) if changes.is_empty() => commit,
            _ => format!("{commit}-modified"),
        },
        None => "unknown".to_owned(),
    }
}

fn git(args: &[&str]) -> Option<String> {
    let output = Command::new("git").args(args).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
