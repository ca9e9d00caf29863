//! Options of the nonlinear solver and its line search.

use super::{DIRECT, EIGENVALUES, Fate, NO_GRID, REFUSED_SOLVES, Row, While, refused};

const OF_LINE_SEARCH: Fate = Fate::Unless(
    While::OwnLineSearch,
    "on the program's own line search; with -snes_linesearch_type basic PETSc's reads it",
);
const NO_DIFFERENCES: Fate = refused(
    "differences cannot follow the contacts, whose state jumps",
    "compare the tangent with differences by -snes_test_jacobian",
);
const EISENSTAT: Fate = Fate::Unless(While::Without("snes_ksp_ew"), "without -snes_ksp_ew");

pub(super) const ROWS: &[Row] = &[
    (
        &["snes_error_if_not_converged", "ksp_error_if_not_converged"],
        REFUSED_SOLVES,
    ),
    (&["snes_grid_sequence", "snes_monitor_fields"], NO_GRID),
    (
        &["snes_monitor_ksp*"],
        refused(
            "PETSc takes the residual of the whole system in it, and the linear solves have only the rows in contact",
            "use -ksp_monitor",
        ),
    ),
    (&["snes_monitor_jacupdate_spectrum"], EIGENVALUES),
    (
        &[
            "snes_fd",
            "snes_fd_color",
            "snes_fd_function",
            "snes_mf",
            "snes_mf_operator",
            "snes_mf_version",
        ],
        NO_DIFFERENCES,
    ),
    (
        &["snes_stol"],
        Fate::NoEffect("as the solver of the variational inequality looks at the residual only"),
    ),
    (
        &["snes_max_fail", "snes_max_step_fail"],
        Fate::Rare("a line search of PETSc's fails"),
    ),
    (
        &["snes_max_linear_solve_fail"],
        Fate::Rare("a linear solve fails"),
    ),
    (
        &["snes_force_iteration"],
        Fate::Rare("the first guess of a solve is good enough already"),
    ),
    (&["snes_max_funcs"], Fate::Works),
    (
        &["snes_check_jacobian_domain_error"],
        Fate::NoEffect("as the tangent exists wherever the residual does"),
    ),
    (
        &["snes_lag_jacobian_persists"],
        Fate::Unless(
            While::Without("snes_lag_jacobian"),
            "without -snes_lag_jacobian",
        ),
    ),
    (
        &["snes_lag_preconditioner_persists"],
        Fate::Unless(
            While::Without("snes_lag_preconditioner"),
            "without -snes_lag_preconditioner",
        ),
    ),
    (
        &["snes_norm_schedule", "snes_function_type", "snes_npc_side"],
        Fate::NoEffect("on the solver of the variational inequality, which has no solver within"),
    ),
    (&["snes_ksp_ew"], DIRECT),
    (&["snes_ksp_ew_*"], EISENSTAT),
    (
        &["snes_monitor_pause_final", "ksp_monitor_pause_final"],
        Fate::Rare("a monitor draws"),
    ),
    (
        &[
            "snes_monitor_lg_*",
            "snes_vi_monitor_residual",
            "ksp_monitor_lg_*",
        ],
        Fate::Drawn,
    ),
    (&["snes_linesearch_type"], Fate::Works),
    (
        &["snes_linesearch_precheck_picard*"],
        Fate::Rare("two steps of Newton's method in a row point nearly the same way"),
    ),
    (&["snes_linesearch_*"], OF_LINE_SEARCH),
    (
        &[
            "snes_type",
            "snes_atol",
            "snes_rtol",
            "snes_divergence_tolerance",
            "snes_max_it",
            "snes_lag_jacobian",
            "snes_lag_preconditioner",
            "snes_convergence_test",
            "snes_monitor*",
            "snes_converged_reason*",
            "snes_view*",
            "snes_vi_*",
            "snes_test_*",
        ],
        Fate::Works,
    ),
];
