//! What an installed PETSc says about itself in its headers.

use std::{fs, path::PathBuf};

/// The oldest and the newest minor version of PETSc 3 whose functions the wrapper was checked with.
const OLDEST: u32 = 18;
const NEWEST: u32 = 26;

/// Version and configuration of a PETSc.
pub struct Facts {
    version: [u32; 3],
    /// Lines of `petscconf.h`.
    configuration: String,
}

impl Facts {
    /// Reads `petscversion.h` and `petscconf.h`.
    pub fn read(include: &[PathBuf]) -> Result<Self, String> {
        let text = |name: &str| {
            let found = include
                .iter()
                .map(|folder| folder.join(name))
                .find(|path| path.is_file());
            let path = found.ok_or_else(|| {
                format!("there is no {name} in {include:?}; PETSC_ARCH or the development package may be missing")
            })?;
            println!("cargo::rerun-if-changed={}", path.display());
            fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
        };
        let version_header = text("petscversion.h")?;
        let number = |name: &str| {
            definition(&version_header, &format!("PETSC_VERSION_{name}"))
                .and_then(|value| value.parse().ok())
                .ok_or_else(|| format!("petscversion.h does not define PETSC_VERSION_{name}"))
        };
        Ok(Facts {
            version: [number("MAJOR")?, number("MINOR")?, number("SUBMINOR")?],
            configuration: text("petscconf.h")?,
        })
    }

    fn has(&self, name: &str) -> bool {
        definition(&self.configuration, name).is_some()
    }

    /// One sentence about a PETSc that this crate cannot be used with.
    pub fn require_supported(&self) -> Result<(), String> {
        let [major, minor, patch] = self.version;
        let which = format!("this is PETSc {major}.{minor}.{patch}");
        if major != 3 || minor < OLDEST {
            return Err(format!("{which}, and 3.{OLDEST} or a later 3.x is needed"));
        }
        let wrong = if self.has("PETSC_USE_COMPLEX") {
            "with complex scalars; real ones are needed (on Debian libpetsc-real-dev, else configure without \
             --with-scalar-type)"
        } else if !self.has("PETSC_USE_REAL_DOUBLE") {
            "with scalars that are not of double precision; configure with --with-precision=double"
        } else if self.has("PETSC_USE_64BIT_INDICES") {
            "with 64-bit indices; configure with --with-64-bit-indices=0"
        } else if self.has("PETSC_HAVE_MPIUNI") {
            "without MPI; configure with MPI"
        } else {
            return Ok(());
        };
        Err(format!("{which} {wrong}"))
    }

    /// What cargo and the crates that depend on this one have to know.
    pub fn cargo_lines(&self, rpath: &Option<PathBuf>) -> Vec<String> {
        let [major, minor, patch] = self.version;
        let mut lines = vec![
            format!("cargo::metadata=version={major}.{minor}.{patch}"),
            format!(
                "cargo::metadata=mumps={}",
                u8::from(self.has("PETSC_HAVE_MUMPS"))
            ),
        ];
        if let Some(folder) = rpath {
            lines.push(format!("cargo::metadata=library={}", folder.display()));
        }
        for step in OLDEST + 1..=NEWEST {
            lines.push(format!("cargo::rustc-check-cfg=cfg(petsc_ge_3_{step})"));
            if minor >= step {
                lines.push(format!("cargo::rustc-cfg=petsc_ge_3_{step}"));
            }
        }
        if minor > NEWEST {
            lines.push(format!(
                "cargo::warning=PETSc {major}.{minor} is newer than 3.{NEWEST}, the last one this crate was tested with"
            ));
        }
        lines
    }
}

/// The value of `#define NAME value`, empty without one.
fn definition(header: &str, name: &str) -> Option<String> {
    header.lines().find_map(|line| {
        let mut words = line.trim_start().strip_prefix('#')?.split_whitespace();
        (words.next()? == "define" && words.next()? == name)
            .then(|| words.next().unwrap_or_default().to_owned())
    })
}
