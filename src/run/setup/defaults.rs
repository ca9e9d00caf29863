//! PETSc options this program chooses; whatever the user sets takes precedence.

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Ts;
use petsc::options::set_default;

use crate::case::Case;
use crate::run::error::RunError;

/// By how much a step shrinks when its solve is refused.
pub(in crate::run) const CUT_BACK: f64 = 0.4;

/// Most refused solves of one step; the least step ends them long before.
pub(in crate::run) const MOST_REJECTIONS: i32 = 1000;

/// Options that hold for every case.
const DEFAULTS: &[(&str, &str)] = &[
    // Newton on the reduced set of a variational inequality: the primal-dual active set method.
    ("snes_type", "vinewtonrsls"),
    // The first residual is the tool's motion times the number of points: no measure of anything.
    ("snes_rtol", "0"),
    ("snes_stol", "0"),
    ("snes_divergence_tolerance", "-1"),
    // Step size is ours; PETSc's part is to cut back when a solve is refused.
    ("ts_adapt_type", "none"),
    ("ts_max_snes_failures", "-1"),
    ("ts_max_steps", "1000000"),
    ("ts_exact_final_time", "stepover"),
];

/// Lets PETSc's time stepper and the solvers below it read their options: with -help they print what there is, and a
/// value they do not know is refused. Collective.
///
/// # Errors
/// PETSc's words about the value.
pub(in crate::run) fn read_options(case: &Case, comm: &SimpleCommunicator) -> Result<(), RunError> {
    set(case)?;
    Ok(Ts::new(&comm.duplicate())?.set_from_options()?)
}

/// Whether the option has the value that this program gave it.
pub(super) fn is_default(name: &str, value: Option<&str>) -> bool {
    DEFAULTS
        .iter()
        .any(|(ours, default)| *ours == name && value == Some(*default))
}

/// Options whose values follow from the case.
pub(super) fn of_case(case: &Case) -> [(&'static str, String); 4] {
    let stepping = &case.stepping;
    [
        (Ts::REJECTIONS_OPTION, MOST_REJECTIONS.to_string()),
        ("ts_adapt_scale_solve_failed", CUT_BACK.to_string()),
        ("snes_atol", stepping.newton_tolerance.to_string()),
        ("snes_max_it", stepping.newton_max_iterations.to_string()),
    ]
}

/// Puts the defaults into PETSc's option database.
pub(in crate::run) fn set(case: &Case) -> petsc::Result<()> {
    for (name, value) in DEFAULTS {
        set_default(name, value)?;
    }
    for (name, value) in of_case(case) {
        set_default(name, &value)?;
    }
    Ok(())
}
