//! Options of PETSc's that are taken as they are given although they are known to do harm: they are named at the start, and
//! first among what can be tried when the run fails.

use petsc::options;

use super::linear;

/// An option, the values of it that do no harm, and what the others do.
struct Doubtful {
    option: &'static str,
    harmless: &'static [&'static str],
    effect: &'static str,
}

const DOUBTFUL: &[Doubtful] = &[
    Doubtful {
        option: "snes_type",
        harmless: &["vinewtonrsls"],
        effect: "the semismooth method stagnates on this problem where contacts change",
    },
    Doubtful {
        option: "snes_linesearch_type",
        harmless: &["shell", "basic"],
        effect: "a change of contact raises the residual for an iteration, which a line search may not let pass",
    },
    Doubtful {
        option: "ksp_type",
        harmless: &["preonly", "gmres", "fgmres", "lgmres", "bcgs", "fbcgs"],
        effect: "the matrix is neither symmetric nor definite, so the method may break down or stagnate",
    },
    Doubtful {
        option: "pc_type",
        harmless: &["lu", "redundant", "svd"],
        effect: "the matrix is ill-conditioned: with an inexact preconditioner GMRES stagnates, and bcgs may",
    },
    Doubtful {
        option: "ksp_max_it",
        harmless: &[],
        effect: "a linear solve that ends before its tolerance refuses the step",
    },
    Doubtful {
        option: "snes_max_funcs",
        harmless: &[],
        effect: "a solve that has used up its evaluations is refused",
    },
    Doubtful {
        option: "snes_divergence_tolerance",
        harmless: &["-1"],
        effect: "a change of contact raises the residual, which is not divergence",
    },
];

/// The value of an option, without marking it as read if nobody has read it.
pub(super) fn value(name: &str) -> petsc::Result<Option<String>> {
    let unread = options::unused()?
        .into_iter()
        .find(|(given, _)| given.eq_ignore_ascii_case(name));
    match unread {
        Some((_, value)) => Ok(Some(value.unwrap_or_default())),
        None => options::get(name),
    }
}

/// What the user gave that is known to do harm: the option with its value, and what it does.
pub(in crate::run) fn given() -> petsc::Result<Vec<(String, &'static str)>> {
    let mut found = Vec::new();
    for doubtful in DOUBTFUL {
        let harmful = |value: &String| {
            !doubtful.harmless.contains(&value.as_str())
                && !linear::is_default(doubtful.option, Some(value))
        };
        if let Some(value) = value(doubtful.option)?.filter(harmful) {
            let option = format!("-{} {value}", doubtful.option);
            found.push((option, doubtful.effect));
        }
    }
    Ok(found)
}
