//! Options nobody read: a slip of the pen is an error that names the option that was meant, PETSc's own are warned about.

use super::error::{CaseError, Warning};
use super::option::Described;
use super::table::TABLE;

/// How PETSc's option names begin. Families end with an underscore, the rest are names (or beginnings of names) that stand
/// alone; general words such as `use_` or `start_` are only listed with what follows in PETSc.
const PETSC_NAMES: &[&str] = &[
    "snes_",
    "ksp_",
    "pc_",
    "mat_",
    "ts_",
    "vec_",
    "dm_",
    "tao_",
    "is_",
    "sf_",
    "ao_",
    "log_",
    "sub_",
    "options_",
    "viewer_",
    "draw_",
    "fieldsplit_",
    "mg_",
    "npc_",
    "esteig_",
    "partitioning_",
    "petsc",
    "prefix_",
    "malloc",
    "mem_",
    "memory_",
    "mpi_",
    "mpiuni",
    "blas_",
    "device_",
    "cuda_",
    "hip_",
    "kokkos_",
    "saws_",
    "info",
    "help",
    "version",
    "citations",
    "history",
    "nox",
    "display",
    "debugger_",
    "objects_dump",
    "on_error_",
    "start_in_debugger",
    "stop_for_debugger",
    "fp_trap",
    "check_pointer_intensity",
    "checkstack",
    "no_signal_handler",
    "error_output_",
    "get_total_flops",
    "use_gpu_aware_mpi",
    "not_shared_tmp",
    "shared_tmp",
    "x_virtual",
    "skip_petscrc",
    "monitor_python",
];

/// From this similarity on (1 is equal), a name is taken for a misspelt one of ours even if it looks like PETSc's.
const NEAR: f64 = 0.75;

/// Sorts options that nobody read (name without the dash, value) into misspelt ones and PETSc's own.
///
/// An option near one of ours, or of no PETSc family, is an error that names the nearest option of ours with its unit,
/// range and default; the rest are warnings.
pub fn check_unused(unused: &[(String, Option<String>)]) -> (Vec<CaseError>, Vec<Warning>) {
    let (mut errors, mut warnings) = (Vec::new(), Vec::new());
    for (option, value) in unused {
        let given = option.trim_start_matches('-');
        let name = normalised(given);
        let nearest = nearest(&name);
        let known = TABLE.iter().any(|ours| ours.name() == name);
        let petsc = PETSC_NAMES.iter().any(|start| name.starts_with(start));
        let misspelt = nearest.is_some_and(|(_, similarity)| similarity >= NEAR);
        if known && !given.contains('=') || petsc && !misspelt {
            warnings.push(Warning {
                option: given.to_owned(),
                value: value.clone(),
            });
        } else {
            errors.push(CaseError::UnknownOption {
                given: given.to_owned(),
                nearest: nearest.map(|(ours, _)| in_words(ours)).unwrap_or_default(),
                hint: if given.contains('=') {
                    "; name and value are separated by a space"
                } else {
                    ""
                },
            });
        }
    }
    (errors, warnings)
}

/// Lower case, underscores, nothing behind an equals sign.
fn normalised(given: &str) -> String {
    given
        .split('=')
        .next()
        .unwrap_or_default()
        .to_lowercase()
        .replace('-', "_")
}

/// The option of ours that is most like the name, and how like it is. Options that begin with the same word come first:
/// who writes `contact_stiffness` means something about contact.
fn nearest(name: &str) -> Option<(&'static dyn Described, f64)> {
    let same_word = TABLE
        .iter()
        .any(|ours| first_word(ours.name()) == first_word(name));
    TABLE
        .iter()
        .filter(|ours| !same_word || first_word(ours.name()) == first_word(name))
        .map(|ours| {
            (
                *ours,
                strsim::normalized_damerau_levenshtein(ours.name(), name),
            )
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

fn first_word(name: &str) -> &str {
    name.split('_').next().unwrap_or_default()
}

fn in_words(option: &dyn Described) -> String {
    format!(
        "-{} ({}; default {})",
        option.name(),
        option.allowed_with_unit(),
        option.default_with_unit()
    )
}
