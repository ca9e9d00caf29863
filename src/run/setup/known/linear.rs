//! Options of the linear solvers, the preconditioners, the factorisations and the matrices.

use super::{DIRECT, Fate, Refusal, Row, While, refused};

const NO_EXACT_SOLUTION: Fate = refused(
    "there is no exact solution to compare with",
    "use -ksp_monitor_true_residual",
);
const OWN_SOLVE: Fate = Fate::Unless(While::OwnSolve, "");

pub(super) const ROWS: &[Row] = &[
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
            "see what holds the sheet with -dry_run",
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
    (
        &["ksp_reuse_preconditioner"],
        Fate::Unless(
            While::NotCondensed,
            "as -snes_lag_preconditioner decides it; the program's own linear solve reads -condensed_ksp_reuse_preconditioner",
        ),
    ),
    (
        &["ksp_guess_*", "ksp_fischer_guess*"],
        refused(
            "the rows that are solved for change with the contacts, so no earlier solution is as long as the next",
            "leave the first guess of a step to -extrapolate",
        ),
    ),
    (
        &["ksp_dynamic_tolerance"],
        refused(
            "PETSc sets one more monitor for it in every solve, until it has no room for another",
            "set the tolerance with -ksp_rtol",
        ),
    ),
    (
        &["ksp_converged_use_*"],
        Fate::NoEffect("as each linear solve begins at zero, where both norms are the same"),
    ),
    (
        &["ksp_converged_maxits"],
        Fate::Rare("an iterative solve reaches -ksp_max_it"),
    ),
    (&["ksp_lag_norm"], Fate::Rare("the method is ibcgs")),
    (
        &["ksp_gmres_breakdown_tolerance"],
        Fate::Rare("GMRES breaks down"),
    ),
    (
        &["ksp_gmres_preallocate"],
        Fate::Rare("the memory of GMRES is counted"),
    ),
    (
        &["ksp_gmres_classicalgramschmidt"],
        Fate::NoEffect("as it is what GMRES does by itself"),
    ),
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
            "ksp_converged_neg_curve",
            "ksp_max_it",
            "ksp_min_it",
            "ksp_rtol",
            "ksp_atol",
            "ksp_divtol",
            "ksp_knoll",
            "ksp_convergence_test",
            "ksp_norm_type",
            "ksp_check_norm_iteration",
            "ksp_pc_side",
            "ksp_nestedness*",
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
    (
        &[
            "pc_type",
            "pc_factor_mat_solver_type",
            "pc_factor_mat_ordering_type",
        ],
        OWN_SOLVE,
    ),
    (
        &["pc_factor_nonzeros_along_diagonal"],
        Fate::RefusedWhile(
            While::OtherPackage,
            Refusal {
                allowed: None,
                reason: "PETSc ends by a signal with it where another package than its own factorises",
                instead: "let PETSc factorise with -pc_factor_mat_solver_type petsc",
            },
            "an entry of the diagonal is zero",
        ),
    ),
    (
        &["pc_factor_in_place"],
        refused(
            "the matrix is filled anew for each solve, so its factors cannot stand in its place",
            "save memory with -condensed_mat_mumps_icntl_22 1",
        ),
    ),
    (
        &["pc_factor_shift_amount"],
        Fate::Rare("PETSc itself factorises with -pc_factor_shift_type, and a pivot is zero"),
    ),
    (
        &["pc_factor_column_pivot"],
        Fate::NoEffect("on these factorisations, which do not read it"),
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
            "pc_factor_shift_in_blocks",
            "pc_factor_shift_nonzero",
            "pc_factor_shift_positive_definite",
            "pc_factor_zeropivot",
            "pc_factor_reuse_fill",
            "pc_factor_reuse_ordering",
            "pc_factor_levels",
            "pc_factor_diagonal_fill",
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
        &["mat_mumps_icntl_15"],
        Fate::Refused(Refusal {
            allowed: Some("0"),
            reason: "PETSc does not tell MUMPS of blocks",
            instead: "choose the ordering with -condensed_mat_mumps_icntl_7",
        }),
    ),
    (
        &["mat_mumps_icntl_20"],
        Fate::Rare("MUMPS factorises over several ranks"),
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
