//! What becomes of each option of PETSc's that the objects of a run list with `-help`: the one table of it.
//!
//! Names are patterns: a star at the end stands for any ending. The first pattern that fits counts. A version of PETSc may lack an
//! option; one that lists a new option makes `tests/petsc_options.rs` fail until it has a row here.

use super::given::SolveOf;

/// What becomes of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It does what PETSc's manual says.
    Works,
    /// It does, but only where something happens that a run may never see: in words behind "matters only where".
    Rare(&'static str),
    /// PETSc reads it and nothing follows: in words behind "has no effect".
    NoEffect(&'static str),
    /// As [`Fate::NoEffect`] while this holds; it works otherwise.
    Unless(While, &'static str),
    /// It draws on a display, and is refused where there is none.
    Drawn,
    /// It is not the user's to choose.
    Refused(Refusal),
}

/// What can keep an option from having an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum While {
    /// The solver is direct: one application of the preconditioner.
    Direct,
    /// The program eliminates the contact unknowns itself.
    OwnSolve,
    /// The line search is the program's own.
    OwnLineSearch,
    /// Another package than PETSc factorises.
    OtherPackage,
    /// Another option is not given.
    Without(&'static str),
}

/// Why an option is refused, and what to do instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    /// The only value that does no harm; none does without.
    pub allowed: Option<&'static str>,
    /// In words that fit behind "option -name value:".
    pub reason: &'static str,
    /// In words that fit behind "leave it out, and".
    pub instead: &'static str,
}

const fn refused(reason: &'static str, instead: &'static str) -> Fate {
    Fate::Refused(Refusal {
        allowed: None,
        reason,
        instead,
    })
}

const STEPS: &str = "the program chooses the steps itself";
const STEP_OPTIONS: &str = "set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load";
const END_OF_STEP: Fate = refused(
    "contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0)",
    "shorten the steps with -dt_max where vibrations are damped too much",
);
const IMPLICIT: Fate = refused(
    "the static equations hold at the end of a step only",
    "shorten the steps with -dt_max",
);
const TIMES: &str = "set the times with -time_load and -time_unload";
const REFUSED_SOLVES: Fate = refused(
    "a solve that does not converge is done again with a shorter step, and a run that fails says why",
    "watch the solves with -monitor_iterations",
);
const NO_GRID: Fate = refused(
    "it needs a grid of PETSc's, and the sheet's mesh is none",
    "look at the fields with ParaView",
);
const PYTHON: Fate = refused(
    "it needs Python's petsc4py within the program",
    "read history.csv with Python",
);
const NO_EXACT_SOLUTION: Fate = refused(
    "there is no exact solution to compare with",
    "use -ksp_monitor_true_residual",
);
const EIGENVALUES: Fate = refused(
    "the rows that are solved for change with the contacts, so there is no one matrix whose values it could show",
    "use -ksp_monitor_singular_value with -pc_type lu -ksp_type gmres",
);

const NO_ERROR_ESTIMATE: Fate =
    Fate::NoEffect("as the program chooses the steps and not an estimate of their error");
const NO_ADJOINT: Fate =
    Fate::NoEffect("as no adjoint equations are solved; -sensitivity has derivatives");
const NO_SPLIT: Fate = Fate::NoEffect("as the equations have no explicit part");
const DIRECT: Fate = Fate::Unless(
    While::Direct,
    "as the solve is direct, which -ksp_type preonly stands for",
);
const OF_LINE_SEARCH: Fate = Fate::Unless(
    While::OwnLineSearch,
    "on the program's own line search; with -snes_linesearch_type basic PETSc's reads it",
);
const NO_COLOURS: Fate = Fate::NoEffect("as the time stepper has the tangent from the program");
const NO_DIFFERENCES: Fate = refused(
    "differences cannot follow the contacts, whose state jumps",
    "compare the tangent with differences by -snes_test_jacobian",
);
const OWN_SOLVE: Fate = Fate::Unless(While::OwnSolve, "");
const EISENSTAT: Fate = Fate::Unless(While::Without("snes_ksp_ew"), "without -snes_ksp_ew");

/// Patterns and what becomes of the options that fit one. Behind the prefixes of solvers within solvers, such as
/// `condensed_` and `sub_`, names are the same.
pub(super) const KNOWN: &[(&[&str], Fate)] = &[
    // Time stepper.
    (&["ts_dt"], refused(STEPS, STEP_OPTIONS)),
    (
        &["ts_init_time"],
        refused("every run begins at time 0", TIMES),
    ),
    (
        &["ts_max_time", "ts_time_span", "ts_eval_times"],
        refused("the motion of the punch ends the run", TIMES),
    ),
    (
        &["ts_adapt_type"],
        Fate::Refused(Refusal {
            allowed: Some("none"),
            reason: STEPS,
            instead: STEP_OPTIONS,
        }),
    ),
    (&["ts_alpha_*"], END_OF_STEP),
    (&["ts_theta_*"], IMPLICIT),
    (&["ts_error_if_step_fails"], REFUSED_SOLVES),
    (
        &["ts_rhs_jacobian_test_mult*"],
        refused(
            "there is no right-hand side whose derivative could be tested",
            "test the tangent with -snes_test_jacobian",
        ),
    ),
    (
        &[
            "ts_dmswarm_*",
            "ts_monitor_sp_swarm*",
            "ts_monitor_dmda_ray",
            "ts_monitor_lg_dmda_ray",
            "ts_monitor_solution_vtk*",
            "ts_monitor_envelope",
            "ts_monitor_draw_solution_phase",
        ],
        NO_GRID,
    ),
    (
        &[
            "ts_monitor_python",
            "snes_monitor_python",
            "ksp_monitor_python",
        ],
        PYTHON,
    ),
    (&["ts_monitor_sp_eig"], EIGENVALUES),
    (
        &["ts_adjoint_solve"],
        refused(
            "no adjoint equations are set up",
            "use -sensitivity for derivatives",
        ),
    ),
    (&["ts_adjoint_*"], NO_ADJOINT),
    (
        &[
            "ts_rtol",
            "ts_atol",
            "ts_adapt_always_accept",
            "ts_adapt_safety",
            "ts_adapt_reject_safety",
            "ts_adapt_clip",
            "ts_adapt_max_ignore",
            "ts_adapt_glee_use_local",
            "ts_adapt_wnormtype",
            "ts_adapt_time_step_increase_delay",
        ],
        NO_ERROR_ESTIMATE,
    ),
    (&["ts_use_splitrhsfunction"], NO_SPLIT),
    (
        &[
            "ts_max_snes_failures",
            "ts_max_reject",
            "ts_max_step_rejections",
        ],
        Fate::Rare("as many solves of one step are refused"),
    ),
    (
        &["ts_adapt_dt_min", "ts_adapt_dt_max"],
        Fate::NoEffect("as -dt_min and -dt_max are the program's"),
    ),
    (
        &["ts_exact_final_time"],
        Fate::NoEffect("as the program's steps end at the end of the motion"),
    ),
    (&["ts_monitor_lg_*", "ts_monitor_draw_*"], Fate::Drawn),
    (
        &["ts_monitor_frequency"],
        Fate::Unless(While::Without("ts_monitor"), "without -ts_monitor"),
    ),
    (&["ts_fd_color"], NO_COLOURS),
    (
        &[
            "ts_monitor_cancel",
            "snes_monitor_cancel",
            "ksp_monitor_cancel",
            "*_view_cancel",
        ],
        Fate::NoEffect("as options that ask for monitors come after it"),
    ),
    (
        &[
            "ts_type",
            "ts_max_steps",
            "ts_run_steps",
            "ts_adapt_scale_solve_failed",
            "ts_adapt_monitor",
            "ts_monitor*",
            "ts_view*",
            "ts_save_trajectory",
            "ts_trajectory_*",
        ],
        Fate::Works,
    ),
    // Nonlinear solver.
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
    // Linear solver.
    (&["ksp_monitor_error"], NO_EXACT_SOLUTION),
    (
        &["ksp_initial_guess_nonzero"],
        refused(
            "each linear solve begins at zero",
            "use -extrapolate for the first guess of a step",
        ),
    ),
    (
        &["ksp_diagonal_scale*", "ksp_view_diagonal_scale"],
        refused(
            "it writes into the matrix, which the program fills anew for each solve",
            "scale within MUMPS with -condensed_mat_mumps_icntl_8",
        ),
    ),
    (
        &["ksp_constant_null_space"],
        refused(
            "the matrix has no null space",
            "fix nothing that the tools hold",
        ),
    ),
    (
        &[
            "ksp_view_mat_explicit",
            "ksp_view_preconditioned_operator_explicit",
        ],
        refused(
            "it applies the solver to every unit vector in every solve",
            "use -ksp_view_mat with -pc_type lu",
        ),
    ),
    (&["ksp_plot_*", "ksp_gmres_krylov_monitor"], Fate::Drawn),
    (&["ksp_reuse_preconditioner"], OWN_SOLVE),
    (
        &["ksp_matsolve_batch_size", "ksp_use_explicittranspose"],
        Fate::NoEffect("as there is one right-hand side at a time, and no transposed system"),
    ),
    (
        &[
            "ksp_view_eigenvalues*",
            "ksp_view_singularvalues",
            "ksp_compute_*",
            "ksp_converged_rate",
            "ksp_converged_use_*",
            "ksp_converged_maxits",
            "ksp_converged_neg_curve",
            "ksp_max_it",
            "ksp_min_it",
            "ksp_rtol",
            "ksp_atol",
            "ksp_divtol",
            "ksp_knoll",
            "ksp_guess_*",
            "ksp_fischer_guess*",
            "ksp_convergence_test",
            "ksp_norm_type",
            "ksp_check_norm_iteration",
            "ksp_lag_norm",
            "ksp_pc_side",
            "ksp_nestedness*",
            "ksp_dynamic_tolerance",
            "ksp_gmres_*",
            "ksp_fgmres_*",
            "ksp_lgmres_*",
            "ksp_dgmres_*",
            "ksp_pgmres_*",
            "ksp_bcgsl_*",
            "ksp_qmrcgs_*",
            "ksp_idr_*",
            "ksp_gcr_*",
            "ksp_richardson_*",
            "ksp_chebyshev_*",
        ],
        DIRECT,
    ),
    (
        &[
            "ksp_type",
            "ksp_monitor*",
            "all_ksp_monitor*",
            "ksp_view",
            "ksp_view_pre",
            "ksp_view_mat",
            "ksp_view_pmat",
            "ksp_view_rhs",
            "ksp_view_solution",
            "ksp_view_final_residual",
            "ksp_final_residual",
            "ksp_converged_reason*",
            "ksp_error_if_not_converged",
        ],
        Fate::Works,
    ),
    // Preconditioner and factorisation.
    (&["pc_type", "pc_factor_mat_solver_type"], OWN_SOLVE),
    (
        &["pc_factor_in_place"],
        refused(
            "the matrix is filled anew for each solve, so its factors cannot stand in its place",
            "save memory with -condensed_mat_mumps_icntl_22 1",
        ),
    ),
    (&["pc_use_amat"], Fate::NoEffect("as there is one matrix")),
    (
        &["pc_factor_pivot_in_blocks"],
        Fate::NoEffect("as the matrix has no blocks"),
    ),
    (
        &[
            "pc_factor_fill",
            "pc_factor_shift_type",
            "pc_factor_shift_amount",
            "pc_factor_shift_in_blocks",
            "pc_factor_shift_nonzero",
            "pc_factor_shift_positive_definite",
            "pc_factor_zeropivot",
            "pc_factor_column_pivot",
            "pc_factor_reuse_fill",
            "pc_factor_reuse_ordering",
            "pc_factor_mat_ordering_type",
            "pc_factor_levels",
            "pc_factor_diagonal_fill",
            "pc_factor_nonzeros_along_diagonal",
            "pc_factor_mat_factor_on_host",
            "pc_factor_mat_solve_on_host",
        ],
        Fate::Unless(
            While::OtherPackage,
            "on a factorisation by another package than PETSc's own (-pc_factor_mat_solver_type petsc)",
        ),
    ),
    (
        &[
            "mat_mumps_icntl_19",
            "mat_mumps_icntl_25",
            "mat_mumps_icntl_26",
            "mat_mumps_icntl_31",
        ],
        refused(
            "with it MUMPS solves something else than the system",
            "see what MUMPS does with -condensed_mat_mumps_icntl_4 2",
        ),
    ),
    (
        &["mat_mumps_ooc_tmpdir"],
        Fate::Rare("MUMPS keeps its factors on the disk (ICNTL(22) = 1)"),
    ),
    (
        &[
            "pc_asm_*",
            "pc_bjacobi_*",
            "pc_gasm_*",
            "pc_jacobi_*",
            "pc_sor_*",
            "pc_redundant_*",
            "pc_svd_*",
            "pc_composite_*",
            "pc_view*",
            "mat_mumps_*",
            "mat_superlu*",
            "mat_umfpack_*",
            "mat_strumpack_*",
            "mat_mkl_*",
            "mat_cholmod_*",
            "mat_pastix_*",
        ],
        OWN_SOLVE,
    ),
    (
        &["mat_factor_view"],
        refused(
            "PETSc cannot show factors by themselves",
            "use -condensed_ksp_view ::ascii_info_detail",
        ),
    ),
    (
        &[
            "mat_view*",
            "mat_no_unroll",
            "mat_no_inode",
            "mat_inode_limit",
            "mat_seqaij_type",
            "mat_mpiaij_type",
            "mat_type",
        ],
        Fate::Works,
    ),
];

/// What becomes of an option, by its name without the dash; none if it is not known. Prefixes of inner solvers do not matter.
pub(super) fn fate(name: &str) -> Option<Fate> {
    let name = SolveOf::split(name).1;
    KNOWN
        .iter()
        .find(|(patterns, _)| patterns.iter().any(|pattern| fits(pattern, name)))
        .map(|(_, fate)| *fate)
}

fn fits(pattern: &str, name: &str) -> bool {
    match pattern.strip_suffix('*') {
        Some(start) => name.starts_with(start),
        None => name == pattern,
    }
}
