//! Where PETSc is: `PETSC_DIR` with `PETSC_ARCH` before pkg-config, and Debian's own folder last.

use std::{
    env,
    path::{Path, PathBuf},
};

/// Folders with headers and the library.
pub struct Place {
    /// Folders of the headers.
    pub include: Vec<PathBuf>,
    /// What the linker has to know, as lines for cargo.
    pub link: Vec<String>,
    /// The folder of the library if the loader does not find it by itself.
    pub rpath: Option<PathBuf>,
}

/// The PETSc to build with.
pub fn petsc() -> Result<Place, String> {
    println!("cargo::rerun-if-env-changed=PETSC_DIR");
    println!("cargo::rerun-if-env-changed=PETSC_ARCH");
    let chosen = |name| env::var_os(name).filter(|value| !value.is_empty());
    if let Some(folder) = chosen("PETSC_DIR") {
        let (folder, arch) = (PathBuf::from(folder), chosen("PETSC_ARCH"));
        let build = arch
            .as_ref()
            .map_or_else(|| folder.clone(), |arch| folder.join(arch));
        return in_folder(&folder, &build).ok_or_else(|| {
            format!(
                "PETSC_DIR is {}, {}, and there is no libpetsc in {}",
                folder.display(),
                arch.map_or("PETSC_ARCH is not set".into(), |arch| format!(
                    "PETSC_ARCH is {}",
                    Path::new(&arch).display()
                )),
                build.join("lib").display()
            )
        });
    }
    // An installation calls itself by either name.
    let known = ["petsc", "PETSc"].iter().find_map(|name| {
        let mut quiet = pkg_config::Config::new();
        quiet
            .cargo_metadata(false)
            .env_metadata(true)
            .probe(name)
            .ok()
    });
    if let Some(library) = known {
        let folders = &library.link_paths;
        let mut link: Vec<String> = (folders.iter())
            .map(|folder| format!("cargo::rustc-link-search=native={}", folder.display()))
            .collect();
        link.extend(
            library
                .libs
                .iter()
                .map(|name| format!("cargo::rustc-link-lib={name}")),
        );
        return Ok(Place {
            link,
            rpath: folders
                .iter()
                .find_map(|folder| foreign(&library_in(folder)?.1)),
            include: library.include_paths,
        });
    }
    let debian = Path::new("/usr/lib/petsc");
    in_folder(debian, debian).ok_or_else(|| {
        "no PETSc was found: install it (on Debian: libpetsc-real-dev), let PKG_CONFIG_PATH lead to its petsc.pc, \
         or set PETSC_DIR and, for a build that was not installed, PETSC_ARCH"
            .into()
    })
}

/// A PETSc whose sources or installation are in `folder`, and whose library is below `build`.
fn in_folder(folder: &Path, build: &Path) -> Option<Place> {
    let libraries = build.join("lib");
    let (name, file) = library_in(&libraries)?;
    Some(Place {
        include: vec![build.join("include"), folder.join("include")],
        link: vec![
            format!("cargo::rustc-link-search=native={}", libraries.display()),
            format!("cargo::rustc-link-lib={name}"),
        ],
        rpath: foreign(&file),
    })
}

/// Name and file of the library in a folder.
fn library_in(folder: &Path) -> Option<(&'static str, PathBuf)> {
    ["petsc", "petsc_real"].into_iter().find_map(|name| {
        let file = ["so", "dylib"].map(|kind| folder.join(format!("lib{name}.{kind}")));
        file.into_iter()
            .find(|file| file.is_file())
            .map(|file| (name, file))
    })
}

/// The folder of a library, unless the loader looks there by itself. Debian's development package has links to it.
fn foreign(file: &Path) -> Option<PathBuf> {
    let file = file.canonicalize().ok()?;
    let folder = file.parent()?;
    let usual = ["/lib", "/usr/lib", "/lib64", "/usr/lib64"].map(Path::new);
    let in_usual = usual.contains(&folder) || folder.parent().is_some_and(|up| usual.contains(&up));
    (!in_usual).then(|| folder.into())
}
