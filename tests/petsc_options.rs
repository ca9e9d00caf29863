//! Every option of PETSc's that `-help` lists for the solvers of a run has a row in the program's table of them, for each
//! set-up whose solvers read other options; so a new PETSc cannot add one that is accepted and does nothing.

mod program;

use std::collections::BTreeSet;

use program::run;
use ssnp155::run::fate_of_petsc_option;

/// Options of the set-ups, and their ranks.
const SETUPS: [(&str, usize); 7] = [
    ("", 1),
    ("", 2),
    ("-options_file inputs/band.opts", 1),
    ("-pc_type lu", 1),
    (
        "-pc_type bjacobi -ksp_type gmres -snes_linesearch_type l2",
        1,
    ),
    ("-friction_coefficient 0.1342", 1),
    ("-dynamics none", 1),
];

const FAMILIES: [&str; 5] = ["ts_", "snes_", "ksp_", "pc_", "mat_"];

/// The options in the help that PETSc prints, which comes behind that of the program and a rule.
fn listed(help: &str) -> BTreeSet<String> {
    let petscs = help
        .split_once("----------")
        .expect("PETSc's help follows")
        .1;
    let name = |line: &str| {
        let word = line.strip_prefix(' ')?.trim_start().strip_prefix('-')?;
        let end = word
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(word.len());
        Some(word[..end].to_owned())
    };
    let of_solvers = |name: &String| {
        let bare = ["condensed_", "sub_", "redundant_", "all_"]
            .iter()
            .fold(name.as_str(), |name, prefix| {
                name.trim_start_matches(prefix)
            });
        FAMILIES.iter().any(|family| bare.starts_with(family))
    };
    petscs.lines().filter_map(name).filter(of_solvers).collect()
}

#[test]
fn what_becomes_of_every_listed_option_is_known() {
    let mut all = BTreeSet::new();
    for (words, ranks) in SETUPS {
        let mut words: Vec<&str> = words.split_whitespace().collect();
        words.push("-help");
        let help = run(ranks, 60, &words);
        assert_eq!(help.code, Some(0), "{words:?}: {}", help.stderr);
        let listed = listed(&help.stdout);
        assert!(listed.len() > 150, "{words:?}: only {} found", listed.len());
        all.extend(listed);
    }
    let unknown: Vec<_> = all
        .iter()
        .filter(|name| fate_of_petsc_option(name).is_none())
        .collect();
    assert!(
        unknown.is_empty(),
        "no row in src/run/setup/known/: {unknown:?}; scripts/petsc_options.py finds out what they do"
    );
    // The help is that of the objects in use: the solver of the condensed system and MUMPS are among them.
    for name in [
        "condensed_ksp_type",
        "snes_linesearch_type",
        "ts_theta_theta",
        "sub_pc_type",
    ] {
        assert!(all.contains(name), "{name} is not listed");
    }
}

#[test]
fn an_option_of_each_fate_is_named_as_such() {
    for (name, fate) in [
        ("snes_atol", "works"),
        ("condensed_mat_mumps_icntl_14", "works, by the solver"),
        ("ts_rtol", "no effect"),
        ("snes_converged_reason_view_cancel", "no effect"),
        ("pc_factor_nonzeros_along_diagonal", "works, by the solver"),
        ("snes_max_linear_solve_fail", "works, rarely"),
        ("ts_alpha_radius", "refused"),
        ("condensed_ksp_diagonal_scale", "refused"),
    ] {
        assert_eq!(fate_of_petsc_option(name), Some(fate), "{name}");
    }
    assert_eq!(fate_of_petsc_option("snes_something_new"), None);
}
