//! Values of PETSc's options that cannot work on these equations: PETSc would end with an error code, or the solve would
//! stand still without a reason.

use super::doubtful::value;
use crate::case::CaseError;
use crate::run::error::RunError;

/// Values of an option that are refused, with the reason and with what to do in their place.
struct Forbidden {
    option: &'static str,
    values: &'static [&'static str],
    /// Whether they work on one rank.
    alone: bool,
    reason: &'static str,
    instead: &'static str,
}

const FORBIDDEN: &[Forbidden] = &[
    Forbidden {
        option: "snes_type",
        values: &[
            "newtonls",
            "newtontr",
            "newtontrdc",
            "newtonal",
            "python",
            "nrichardson",
            "ksponly",
            "ksptransposeonly",
            "ngmres",
            "qn",
            "shell",
            "ngs",
            "ncg",
            "fas",
            "ms",
            "nasm",
            "anderson",
            "aspin",
            "composite",
            "patch",
        ],
        alone: false,
        reason: "the bound of the gap needs a solver of variational inequalities, vinewtonrsls (the default) or \
                 vinewtonssls",
        instead: "watch the default at work with -snes_monitor",
    },
    Forbidden {
        option: "ksp_type",
        values: &[
            "cg", "groppcg", "pipecg", "pipecgrr", "pipelcg", "pipeprcg", "pipecg2", "fcg",
            "pipefcg", "nash", "stcg", "gltr", "qcg", "minres", "symmlq", "cr", "pipecr",
        ],
        alone: false,
        reason: "the matrix with the contact unknowns is not symmetric, which this method needs",
        instead: "use -ksp_type bcgs, gmres or fgmres",
    },
    Forbidden {
        option: "pc_type",
        values: &["cholesky", "icc"],
        alone: false,
        reason: "the matrix with the contact unknowns is not symmetric, so it has no such factors",
        instead: "use -pc_type lu, or -condensed_pc_type cholesky for the system without them",
    },
    Forbidden {
        option: "pc_type",
        values: &[
            "gamg",
            "mg",
            "hmg",
            "ml",
            "hypre",
            "bddc",
            "fieldsplit",
            "galerkin",
        ],
        alone: false,
        reason: "the rows that are solved for change with the contacts from iteration to iteration, which this \
                 preconditioner cannot follow",
        instead: "use -pc_type lu, bjacobi or asm",
    },
    Forbidden {
        option: "pc_type",
        values: &["ilu", "qr"],
        alone: true,
        reason: "it factorises on one rank only",
        instead: "use -pc_type bjacobi or asm, which do so on each rank for its part, or -pc_type lu",
    },
    Forbidden {
        option: "snes_linesearch_type",
        values: &["shell"],
        alone: false,
        reason: "PETSc would ask for a function it has not got; the program's own line search is one, and the default",
        instead: "watch it at work with -monitor_iterations",
    },
    Forbidden {
        option: "fp_trap",
        values: &["", "1", "true", "yes", "on"],
        alone: false,
        reason: "compilers of this program and of its libraries take for granted that nothing traps, and a trap would end it",
        instead: "watch the residuals with -monitor_iterations: a step whose residual is not a number is refused",
    },
];

/// Refuses the first value that cannot work.
///
/// # Errors
/// Which one, why, and what to do.
pub(super) fn refuse(ranks: i32) -> Result<(), RunError> {
    for forbidden in FORBIDDEN {
        let cannot_work = |given: &String| {
            forbidden.values.contains(&given.as_str()) && !(forbidden.alone && ranks == 1)
        };
        if let Some(given) = value(forbidden.option)?.filter(cannot_work) {
            return Err(CaseError::Reserved {
                option: forbidden.option.to_owned(),
                given,
                reason: forbidden.reason,
                allowed: None,
                instead: forbidden.instead,
            }
            .into());
        }
    }
    Ok(())
}
