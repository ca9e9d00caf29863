//! Our own values on a small mesh, found again: contact at points, nodes and the closest point, without and with friction,
//! with and without mass. One rank with the band solver gives them to 1e-8, and so do two ranks with MUMPS.
//!
//! The values are in tests/regression.csv. Where a change is meant to change results, `UPDATE_REGRESSION=1 cargo test
//! --release --test regression` writes them anew, and the commit says why. The benchmark's own mesh has
//! inputs/reference/regression.csv, which every run of the four cases is compared with.

mod program;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use program::{history, run, scratch, summary};

/// Largest relative difference, of one rank from the table and of two ranks from one. Found between one rank and two:
/// 7e-12 at most, in the plastic work; the rest is for machines that round otherwise.
const TOLERANCE: f64 = 1e-8;
const STROKES: [f64; 3] = [2.0, 4.0, 6.0];
/// Columns of history.csv that are compared.
const QUANTITIES: [&str; 6] = [
    "force_N",
    "dy_A_sheet_mm",
    "angle_deg",
    "strain_energy_mJ",
    "plastic_dissipation_mJ",
    "contact_energy_mJ",
];

/// Values by configuration, stroke and quantity, in the order of the file.
type Values = Vec<(String, f64)>;

/// Names and options of the configurations.
fn configurations() -> Vec<(String, Vec<&'static str>)> {
    let mut all = Vec::new();
    for location in ["points", "nodes", "closest"] {
        for (rubbing, friction) in [("smooth", "0"), ("rough", "0.1342")] {
            for (mass, dynamics) in [("slow", "slow"), ("static", "none")] {
                let mut words = vec!["-contact_location", location];
                words.extend(["-friction_coefficient", friction, "-dynamics", dynamics]);
                all.push((format!("{location} {rubbing} {mass}"), words));
            }
        }
    }
    all
}

fn values(name: &str, words: &[&str], ranks: usize, solver: &[&str]) -> Values {
    let solved = if solver.is_empty() { "default" } else { "band" };
    let folder = scratch(&format!(
        "regression-{}-{ranks}-{solved}",
        name.replace(' ', "-")
    ));
    // Nodes of a coarse mesh are far apart, and a tool comes deep between them: the limit is not what is tested here. The
    // tolerance of Newton's method is tight, so that the values do not hang on how a solve gets there.
    let mut all: Vec<&str> =
        "-sheet_nx 40 -sheet_ny 2 -stroke 6 -time_load 189 -unload_fraction 0 -output_every 0 -report_strokes 2,4 \
         -penetration_limit 0.1 -newton_tolerance 1e-12"
            .split_whitespace()
            .collect();
    all.extend(words);
    all.extend(solver);
    all.extend(["-output_dir", folder.to_str().unwrap()]);
    let ended = run(ranks, 120, &all);
    assert_eq!(ended.code, Some(0), "{name}: {}", ended.text());
    assert_eq!(summary(&folder)["status"], "finished", "{name}");
    let history = history(&folder);
    let mut found = Vec::new();
    for stroke in STROKES {
        let row = history["stroke_mm"]
            .iter()
            .position(|at| (at - stroke).abs() < 1e-9)
            .unwrap_or_else(|| panic!("{name}: no row at {stroke} mm"));
        for quantity in QUANTITIES {
            found.push((
                format!("{name},{stroke},{quantity}"),
                history[quantity][row],
            ));
        }
    }
    found
}

/// Every difference beyond the tolerance, in words; a value of one that the other lacks counts.
fn differences(expected: &BTreeMap<String, f64>, found: &Values, tolerance: f64) -> Vec<String> {
    let mut wrong = Vec::new();
    for (key, value) in found {
        match expected.get(key) {
            Some(known) if (value - known).abs() <= tolerance * known.abs() => (),
            Some(known) => wrong.push(format!(
                "{key}: {value:e}, expected {known:e}, relative difference {:.1e}",
                (value / known - 1.0).abs()
            )),
            None => wrong.push(format!("{key}: {value:e}, expected nothing")),
        }
    }
    wrong
}

fn file() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regression.csv")
}

#[test]
fn one_rank_finds_the_values_of_the_table_again() {
    let options = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/band.opts");
    let solver = ["-options_file", options.to_str().unwrap()];
    let found: Values = configurations()
        .iter()
        .flat_map(|(name, words)| values(name, words, 1, &solver))
        .collect();
    if std::env::var_os("UPDATE_REGRESSION").is_some() {
        let mut text = "configuration,stroke_mm,quantity,value\n".to_owned();
        for (key, value) in &found {
            writeln!(text, "{key},{value:.12e}").unwrap();
        }
        std::fs::write(file(), text).unwrap();
        return;
    }
    let text = std::fs::read_to_string(file()).unwrap();
    let expected: BTreeMap<String, f64> = text
        .lines()
        .skip(1)
        .map(|line| {
            let (key, value) = line.rsplit_once(',').unwrap();
            (key.to_owned(), value.parse().unwrap())
        })
        .collect();
    assert_eq!(expected.len(), found.len(), "values in the table and found");
    let wrong = differences(&expected, &found, TOLERANCE);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn two_ranks_find_what_one_does() {
    // One of each kind of contact; several ranks on a busy machine are slow.
    let chosen = [
        "points rough slow",
        "nodes smooth static",
        "closest rough static",
    ];
    let mut compared = 0;
    for (name, words) in configurations() {
        if !chosen.contains(&name.as_str()) {
            continue;
        }
        let one = values(&name, &words, 1, &[]).into_iter().collect();
        let two = values(&name, &words, 2, &[]);
        let wrong = differences(&one, &two, TOLERANCE);
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        compared += 1;
    }
    assert_eq!(compared, chosen.len());
}
