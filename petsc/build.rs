//! Passes on what petsc-sys knows about the installed PETSc: to this crate as `cfg(petsc_ge_3_…)`, and to crates that
//! depend on it as `DEP_PETSC_RS_VERSION`, `DEP_PETSC_RS_MUMPS` and `DEP_PETSC_RS_LIBRARY`.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let known = |name: &str| env::var(format!("DEP_PETSC_{name}"));
    for name in ["VERSION", "MUMPS", "LIBRARY"] {
        if let Ok(value) = known(name) {
            println!("cargo::metadata={}={value}", name.to_lowercase());
        }
    }
    // Where a PETSC_DIR of one's own leads to, the loader does not look by itself.
    if let Ok(folder) = known("LIBRARY") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
    let minor = known("VERSION")
        .ok()
        .and_then(|version| version.split('.').nth(1)?.parse().ok())
        .unwrap_or(0);
    for step in [21, 22, 23, 25] {
        println!("cargo::rustc-check-cfg=cfg(petsc_ge_3_{step})");
        if minor >= step {
            println!("cargo::rustc-cfg=petsc_ge_3_{step}");
        }
    }
    let version = known("VERSION").unwrap_or_default();
    println!("cargo::rustc-env=PETSC_RS_VERSION={version}");
}
