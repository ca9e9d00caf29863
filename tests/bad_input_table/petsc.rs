//! The bad options of PETSc: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// What contradicts the program's own choice, and what PETSc does not take.
pub const MISTAKES: &[Mistake] = &[
    words(
        "PETSc's step control",
        BOTH,
        "-ts_adapt_type basic",
        "option -ts_adapt_type basic: the program chooses the steps itself, so only none works here; leave it out, and set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load",
    ),
    words(
        "PETSc's other steppers",
        ONE,
        "-ts_type euler",
        "option -ts_type euler: the equations with inertia (-dynamics slow) are of second order in time, so only alpha2 works here; leave it out, and choose between inertia and statics with -dynamics",
    ),
    words(
        "PETSc's other steppers in statics",
        BOTH,
        "-dynamics none -ts_type alpha2",
        "option -ts_type alpha2: the static equations (-dynamics none) hold at the end of each step, so only beuler works here; leave it out, and choose between inertia and statics with -dynamics",
    ),
    words(
        "spectral radius of PETSc's stepper",
        BOTH,
        "-ts_alpha_radius 0.5",
        "option -ts_alpha_radius 0.5: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "alpha_m of PETSc's stepper",
        ONE,
        "-ts_alpha_alpha_m 1.5",
        "option -ts_alpha_alpha_m 1.5: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "alpha_f of PETSc's stepper",
        ONE,
        "-ts_alpha_alpha_f 0.9",
        "option -ts_alpha_alpha_f 0.9: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "gamma of PETSc's stepper",
        ONE,
        "-ts_alpha_gamma 0.6",
        "option -ts_alpha_gamma 0.6: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "beta of PETSc's stepper",
        ONE,
        "-ts_alpha_beta 0.3",
        "option -ts_alpha_beta 0.3: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "PETSc's first step",
        ONE,
        "-ts_dt 0.5",
        "option -ts_dt 0.5: the program chooses the steps itself; leave it out, and set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load",
    ),
    words(
        "PETSc's first time",
        ONE,
        "-ts_init_time 1",
        "option -ts_init_time 1: every run begins at time 0; leave it out, and set the times with -time_load and -time_unload",
    ),
    words(
        "PETSc's last time",
        ONE,
        "-ts_max_time 1",
        "option -ts_max_time 1: the motion of the punch ends the run; leave it out, and set the times with -time_load and -time_unload",
    ),
    words(
        "unknown solver of PETSc",
        BOTH,
        "-snes_type foo",
        "PETSc error 86: Unknown type. Check for miss-spelling or missing package: https://petsc.org/release/install/install/#external-packages: Unable to find requested SNES type foo; if a value of one of PETSc's options is to blame: -help lists what each can be",
    ),
    words(
        "word for a number of PETSc",
        ONE,
        "-snes_max_it many",
        "PETSc error 63: Argument out of range: Input string many has no integer value (do not include . in it); if a value of one of PETSc's options is to blame: -help lists what each can be",
    ),
];
