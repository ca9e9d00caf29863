//! Options nobody read: a typing mistake is an error that names the option that was meant, PETSc's own are warned about.

use super::error::{CaseError, Warning};
use super::option::Described;
use super::table::TABLE;
use crate::text::shortened;

/// The name of an option of the condensed system's solver: its prefix before that of PETSc's.
macro_rules! condensed_option {
    ($option:literal) => {
        concat!("condensed_", $option)
    };
}
pub(crate) use condensed_option;

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
    "all_ksp_",
    condensed_option!(""),
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
const NEAR: f64 = 0.8;

/// Sorts options that nobody read (name without the dash, value) into misspelt ones and PETSc's own.
///
/// An option near one of ours, or of no PETSc family, is an error that names the nearest option of ours with its unit,
/// range and default; the rest are warnings.
pub fn check_unused(unused: &[(String, Option<String>)]) -> (Vec<CaseError>, Vec<Warning>) {
    let (mut errors, mut warnings) = (Vec::new(), Vec::new());
    for (option, value) in unused {
        let given = option.trim_start_matches('-');
        let name = normalised(given);
        let known = is_own(given);
        if known && option.starts_with('-') {
            errors.push(CaseError::TwoDashes {
                option: given.to_owned(),
            });
            continue;
        }
        let petsc = PETSC_NAMES.iter().any(|start| name.starts_with(start));
        let nearest = nearest(&name);
        if known || petsc && nearest.similarity < NEAR {
            warnings.push(Warning {
                option: given.to_owned(),
                value: value.clone(),
            });
        } else {
            errors.push(CaseError::UnknownOption {
                given: shortened(given),
                nearest: nearest.in_words,
                hint: if given.contains('=') {
                    "; name and value are separated by a space"
                } else if nearest.similarity < NEAR {
                    "; -help lists all"
                } else {
                    ""
                },
            });
        }
    }
    (errors, warnings)
}

/// Whether an option is one of ours, by its name without the dash.
pub(crate) fn is_own(name: &str) -> bool {
    TABLE
        .iter()
        .any(|ours| ours.name().eq_ignore_ascii_case(name))
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

struct Nearest {
    in_words: String,
    similarity: f64,
}

/// The option that is most like the name, and how like it is. Options that begin with the same word come first: who writes
/// `contact_stiffness` means something about contact. `-options_file` is PETSc's, but a run without its file is another run.
fn nearest(name: &str) -> Nearest {
    let same_word = TABLE
        .iter()
        .any(|ours| first_word(ours.name()) == first_word(name));
    let ours = TABLE
        .iter()
        .filter(|ours| !same_word || first_word(ours.name()) == first_word(name))
        .map(|ours| Nearest {
            in_words: in_words(*ours),
            similarity: similarity(ours.name(), name),
        });
    let file = Nearest {
        in_words: "-options_file (path of an option file)".to_owned(),
        similarity: similarity("options_file", name),
    };
    let none = Nearest {
        in_words: String::new(),
        similarity: f64::NEG_INFINITY,
    };
    let first = if file.similarity >= NEAR { file } else { none };
    ours.fold(first, |best, next| {
        if next.similarity > best.similarity {
            next
        } else {
            best
        }
    })
}

fn similarity(a: &str, b: &str) -> f64 {
    strsim::normalized_damerau_levenshtein(a, b)
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
