//! What the build says about a PETSc that the wrapper cannot be used with.

#[path = "../build/facts.rs"]
mod facts;

use std::{fs, path::PathBuf};

use facts::Facts;

const USABLE: &str = "#define PETSC_USE_REAL_DOUBLE 1\n#define PETSC_HAVE_MUMPS 1\n";

/// Headers of a PETSc 3.`minor`.4, read back.
fn facts(name: &str, minor: u32, configuration: &str) -> Result<Facts, String> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    let version = format!(
        "#define PETSC_VERSION_MAJOR      3\n#define PETSC_VERSION_MINOR {minor}\n  #define PETSC_VERSION_SUBMINOR 4\n"
    );
    fs::write(folder.join("petscversion.h"), version).unwrap();
    fs::write(folder.join("petscconf.h"), configuration).unwrap();
    Facts::read(&[folder])
}

#[test]
fn an_unusable_petsc_is_refused_in_one_sentence() {
    let complex = format!("{USABLE}#define PETSC_USE_COMPLEX 1\n");
    let wide = format!("{USABLE}#define PETSC_USE_64BIT_INDICES 1\n");
    let alone = format!("{USABLE}#define PETSC_HAVE_MPIUNI 1\n");
    let cases = [
        ("old", 17, USABLE, "this is PETSc 3.17.4, and 3.18 or"),
        (
            "complex",
            22,
            &complex,
            "this is PETSc 3.22.4 with complex scalars;",
        ),
        (
            "wide",
            22,
            &wide,
            "this is PETSc 3.22.4 with 64-bit indices;",
        ),
        ("alone", 22, &alone, "this is PETSc 3.22.4 without MPI;"),
        (
            "single",
            22,
            "#define PETSC_USE_REAL_SINGLE 1\n",
            "this is PETSc 3.22.4 with scalars",
        ),
    ];
    for (name, minor, configuration, beginning) in cases {
        let said = facts(name, minor, configuration)
            .unwrap()
            .require_supported()
            .unwrap_err();
        assert!(said.starts_with(beginning), "{said}");
        assert!(!said.contains('\n') && !said.contains("  "), "{said}");
    }
    let nowhere = [PathBuf::from("/nonexistent")];
    assert!(
        Facts::read(&nowhere)
            .err()
            .unwrap()
            .contains("petscversion.h")
    );
}

#[test]
fn a_usable_petsc_is_described() {
    for minor in [18, 22, 26] {
        let facts = facts(&format!("usable-{minor}"), minor, USABLE).unwrap();
        facts.require_supported().unwrap();
        let lines = facts.cargo_lines(&Some("/opt/petsc/lib".into()));
        let has = |line: &str| lines.iter().any(|known| known == line);
        assert!(has(&format!("cargo::metadata=version=3.{minor}.4")));
        assert!(has("cargo::metadata=mumps=1") && has("cargo::metadata=library=/opt/petsc/lib"));
        assert_eq!(has("cargo::rustc-cfg=petsc_ge_3_22"), minor >= 22);
        assert!(has("cargo::rustc-check-cfg=cfg(petsc_ge_3_26)"));
        assert!(!lines.iter().any(|line| line.contains("warning")));
    }
    let facts = facts("newer", 27, "#define PETSC_USE_REAL_DOUBLE 1\n").unwrap();
    facts.require_supported().unwrap();
    let lines = facts.cargo_lines(&None);
    assert!(
        lines
            .iter()
            .any(|line| line.starts_with("cargo::warning=PETSc 3.27 is newer"))
    );
    assert!(lines.contains(&"cargo::metadata=mumps=0".to_owned()));
}
