//! Options of the time stepper, and of monitors of all objects.

use super::{EIGENVALUES, Fate, NO_GRID, REFUSED_SOLVES, Refusal, Row, While, refused};

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
const PYTHON: Fate = refused(
    "it needs Python's petsc4py within the program",
    "read history.csv with Python",
);
const NO_ERROR_ESTIMATE: Fate =
    Fate::NoEffect("as the program chooses the steps and not an estimate of their error");
const NO_ADJOINT: Fate =
    Fate::NoEffect("as no adjoint equations are solved; -sensitivity has derivatives");
const NO_SPLIT: Fate = Fate::NoEffect("as the equations have no explicit part");
const NO_COLOURS: Fate = Fate::NoEffect("as the time stepper has the tangent from the program");

pub(super) const ROWS: &[Row] = &[
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
        &["ts_save_trajectory", "ts_trajectory_*"],
        Fate::NoEffect(
            "as the program takes the steps one by one, and checkpoints keep the states",
        ),
    ),
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
        ],
        Fate::Works,
    ),
];
