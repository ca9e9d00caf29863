//! The derivatives of a run are those of its discrete solution: central differences of whole runs with the same steps agree,
//! for every parameter; they change nothing else, and neither ranks nor a restart change them.

mod program;

use std::collections::BTreeMap;
use std::path::Path;

use program::{history, run_into, scratch, summary};
use ssnp155::case::Case;

/// To d = 20 mm by equal steps; the tolerance takes the solves down to rounding, which the differences divide by the share.
const COARSE: &str = "-sheet_nx 40 -sheet_ny 3 -stroke 20 -time_load 630 -unload_fraction 0 -report_strokes none \
                      -dt_max 9 -newton_tolerance 1e-12 -output_every 0";
const FREE: &str = "-fixed_steps_load 70 -dt_initial 9";
const RUBBED: &str = "-fixed_steps_load 140 -dt_initial 4.5 -newton_max_iterations 60 -friction_coefficient 0.1342 \
                      -hardening hollomon";
/// Two shares of the parameter for the differences: rounding spoils the small one, a point that changes what it does between
/// the two runs the large one.
const SHARES: [f64; 2] = [1e-5, 1e-6];
/// Largest difference as a share of the column's largest derivative.
const AGREE: f64 = 1e-4;
/// To what an angle is known, degrees: the solves stop at 1e-12 mm, and the arm that is fitted is 10 mm long.
const ROUNDING: f64 = 1e-10;

/// Largest difference between numbers of ranks, likewise.
const RANKS: f64 = 1e-8;

const QUANTITIES: [&str; 3] = ["force_N", "angle_deg", "dy_A_sheet_mm"];

type Table = BTreeMap<String, Vec<f64>>;

fn finish(folder: &Path, ranks: usize, parts: &[&str]) {
    let ended = run_into(folder, ranks, parts);
    assert_eq!(ended.code, Some(0), "{parts:?}: {}", ended.text());
}

/// The columns of `sensitivity.csv`.
fn derivatives(folder: &Path) -> Table {
    let mut reader = csv::Reader::from_path(folder.join("sensitivity.csv")).unwrap();
    let names = reader.headers().unwrap().clone();
    let mut columns = Table::new();
    for row in reader.records() {
        for (name, value) in names.iter().zip(&row.unwrap()) {
            let column = columns.entry(name.to_owned()).or_default();
            column.push(value.parse().unwrap());
        }
    }
    columns
}

fn column<'a>(table: &'a Table, quantity: &str, name: &str) -> &'a [f64] {
    let begins = |key: &str| {
        let unit = key.strip_prefix(&format!("d_{quantity}_by_{name}"));
        unit.is_some_and(|unit| ["", "_mm", "_MPa", "_mm_per_MPa"].contains(&unit))
    };
    table
        .iter()
        .find(|(key, _)| begins(key))
        .unwrap_or_else(|| panic!("no d_{quantity}_by_{name}"))
        .1
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Compares all derivatives of a run with differences of runs.
fn agrees(name: &str, parameters: &[&str], options: &[&str]) {
    let folder = scratch(&format!("sensitivity-{name}"));
    let list = format!("-sensitivity {}", parameters.join(","));
    finish(&folder.join("exact"), 1, &[options, &[&list]].concat());
    let exact = derivatives(&folder.join("exact"));
    let of_exact = summary(&folder.join("exact"));
    let case = &of_exact["provenance"]["options"];
    let released = &of_exact["sensitivity"]["angles"]["tools vanish at 20 mm"];
    for &parameter in parameters {
        let value: f64 = case[parameter].as_str().unwrap().parse().unwrap();
        let mut best = [f64::INFINITY; 4];
        for share in SHARES {
            let [above, below] = [1.0 + share, 1.0 - share].map(|factor| {
                let beside = folder.join("beside");
                let changed = format!("-{parameter} {:?} -overwrite", value * factor);
                finish(&beside, 1, &[options, &[&changed]].concat());
                let angle = &summary(&beside)["angles_deg"]["tools vanish at 20 mm"];
                (history(&beside), angle.as_f64())
            });
            assert_eq!(above.0["t_ms"], exact["t_ms"], "{parameter}: other steps");
            assert_eq!(below.0["t_ms"], exact["t_ms"], "{parameter}: other steps");
            let width = 2.0 * share * value;
            for (best, quantity) in best.iter_mut().zip(QUANTITIES) {
                let slopes = column(&exact, quantity, parameter);
                let scale = largest(slopes).max(1e-300);
                let sides = above.0[quantity].iter().zip(&below.0[quantity]);
                let errors = slopes
                    .iter()
                    .zip(sides)
                    .map(|(slope, (above, below))| ((above - below) / width - slope).abs() / scale);
                *best = best.min(errors.fold(0.0, f64::max));
            }
            let difference = above.1.unwrap_or(f64::NAN) - below.1.unwrap_or(f64::NAN);
            if let Some(slope) = released[parameter].as_f64() {
                let error = (difference - slope * width).abs() - ROUNDING;
                best[3] = best[3].min(error.max(0.0) / (slope * width).abs());
            }
        }
        println!("{name}, {parameter}: {best:?}");
        let [.., of_release] = best;
        assert!(
            best[..3].iter().all(|error| *error < AGREE),
            "{name}, {parameter}: {best:?}"
        );
        let elastic = released[parameter].is_f64();
        assert!(
            !elastic || of_release < AGREE,
            "{name}, {parameter}, released: {of_release:.1e}"
        );
    }
}

const WITHOUT_FRICTION: [&str; 7] = [
    "young_modulus",
    "table_factor",
    "contact_compliance",
    "sheet_thickness",
    "punch_radius",
    "die_radius",
    "die_shoulder_radius",
];
const WITH_FRICTION: [&str; 10] = [
    "friction_coefficient",
    "hollomon_k",
    "hollomon_n",
    "hollomon_elastic_limit",
    "young_modulus",
    "contact_compliance",
    "sheet_thickness",
    "punch_radius",
    "die_radius",
    "die_shoulder_radius",
];

#[test]
fn every_parameter_agrees_without_friction() {
    agrees("free", &WITHOUT_FRICTION, &[COARSE, FREE]);
}

#[test]
fn every_parameter_agrees_with_friction() {
    agrees("rubbed", &WITH_FRICTION, &[COARSE, RUBBED]);
}

#[test]
fn the_constants_of_the_other_laws_agree() {
    for (law, parameters) in [
        ("swift", &["swift_k", "swift_eps0", "swift_n"][..]),
        ("voce", &["voce_sigma0", "voce_q", "voce_b"]),
        ("linear", &["linear_sigma0", "linear_h"]),
        ("hollomon_total", &["hollomon_k", "hollomon_n"]),
    ] {
        let chosen = format!("-hardening {law}");
        agrees(law, parameters, &[COARSE, FREE, &chosen]);
    }
}

/// Contact points that move along their edges, and statics.
#[test]
fn moving_points_and_statics_agree() {
    let moving = "-contact_location closest -friction_coefficient 0.1342 -newton_max_iterations 60 -stroke 6 \
                  -time_load 189 -fixed_steps_load 42 -dt_initial 4.5";
    let still = "-dynamics none -stroke 6 -time_load 189 -fixed_steps_load 42 -dt_initial 4.5";
    for (name, options) in [("moving", moving), ("static", still)] {
        let parameters = ["table_factor", "sheet_thickness", "punch_radius"];
        agrees(name, &parameters, &[COARSE, options]);
    }
}

/// A run of a second, down and back.
const PLAIN: &str = "-sheet_nx 40 -sheet_ny 3 -stroke 6 -time_load 189 -unload_fraction 0.5 -time_unload 94.5 \
                     -report_strokes none -output_every 0";
const SHORT: &str = "-sheet_nx 40 -sheet_ny 3 -stroke 6 -time_load 189 -unload_fraction 0.5 -time_unload 94.5 \
                     -report_strokes none -output_every 0 -friction_coefficient 0.1342";
const LIST: &str =
    "-sensitivity friction_coefficient,young_modulus,sheet_thickness,die_shoulder_radius";

#[test]
fn the_run_itself_is_the_same_to_the_last_bit() {
    let folder = scratch("sensitivity-neutral");
    finish(&folder.join("without"), 1, &[SHORT]);
    finish(&folder.join("with"), 1, &[SHORT, LIST]);
    finish(&folder.join("factor"), 1, &[SHORT, "-table_factor 1"]);
    let rows = |name: &str| std::fs::read(folder.join(name).join("history.csv")).unwrap();
    assert_eq!(rows("with"), rows("without"));
    assert_eq!(rows("factor"), rows("without"));
    assert!(!folder.join("without/sensitivity.csv").exists());
    assert!(
        summary(&folder.join("without"))
            .get("sensitivity")
            .is_none()
    );
    // What a run without derivatives finds of an earlier one's is gone.
    finish(&folder.join("with"), 1, &[SHORT]);
    for name in ["sensitivity.csv", "sensitivity.svg", "sensitivity.png"] {
        assert!(!folder.join("with").join(name).exists(), "{name}");
    }
}

#[test]
fn all_numbers_of_ranks_have_the_same_derivatives() {
    let rubbed = "-friction_coefficient 0.1342 -hardening hollomon";
    for (name, parameters, options) in [
        ("free", &WITHOUT_FRICTION[..], ""),
        ("rubbed", &WITH_FRICTION, rubbed),
    ] {
        let folder = scratch(&format!("sensitivity-ranks-{name}"));
        let list = format!(
            "-sensitivity {} -newton_tolerance 1e-12",
            parameters.join(",")
        );
        let [one, others @ ..] = [1, 2, 3].map(|ranks| {
            let folder = folder.join(ranks.to_string());
            finish(&folder, ranks, &[PLAIN, options, &list]);
            derivatives(&folder)
        });
        for other in &others {
            assert_eq!(one["t_ms"], other["t_ms"]);
            for (name, values) in one.iter().filter(|(name, _)| name.starts_with("d_")) {
                let scale = largest(values);
                assert!(scale > 0.0, "{name}");
                for (a, b) in values.iter().zip(&other[name]) {
                    assert!((a - b).abs() <= RANKS * scale, "{name}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_restart_has_the_same_bits() {
    let folder = scratch("sensitivity-restart");
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    finish(&whole, 1, &[SHORT, LIST]);
    run_into(
        &broken,
        1,
        &[SHORT, LIST, "-ts_max_steps 14 -checkpoint_every 7"],
    );
    finish(&broken, 1, &[SHORT, LIST, "-restart"]);
    for name in ["history.csv", "sensitivity.csv"] {
        let text = |folder: &Path| std::fs::read_to_string(folder.join(name)).unwrap();
        assert_eq!(text(&broken), text(&whole), "{name}");
    }
    let [one, other] = [&whole, &broken].map(|folder| summary(folder)["sensitivity"].clone());
    for key in ["angles", "notes", "factorisations", "linear_solves"] {
        assert_eq!(one[key], other[key], "{key}");
    }
    // Two ranks go on with what one has kept.
    run_into(
        &broken,
        1,
        &[
            SHORT,
            LIST,
            "-ts_max_steps 14 -checkpoint_every 7 -overwrite",
        ],
    );
    finish(&broken, 2, &[SHORT, LIST, "-restart"]);
    let [one, two] = [&whole, &broken].map(|folder| derivatives(folder));
    for quantity in QUANTITIES {
        let [one, two] = [&one, &two].map(|table| column(table, quantity, "sheet_thickness"));
        let last = one.len() - 1;
        assert!(
            (one[last] - two[last]).abs() < 1e-4 * largest(one),
            "{quantity}"
        );
    }
}

#[test]
fn a_checkpoint_with_other_derivatives_is_refused() {
    let folder = scratch("sensitivity-refused");
    run_into(&folder, 1, &[SHORT, "-ts_max_steps 4 -checkpoint_every 4"]);
    let ended = run_into(&folder, 1, &[SHORT, LIST, "-restart"]);
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    assert!(
        ended.stderr.contains("carries no derivatives"),
        "{}",
        ended.stderr
    );
    assert_eq!(ended.stderr.trim().lines().count(), 1);
    run_into(
        &folder,
        1,
        &[
            SHORT,
            LIST,
            "-ts_max_steps 4 -checkpoint_every 4 -overwrite",
        ],
    );
    let ended = run_into(&folder, 1, &[SHORT, "-sensitivity die_radius -restart"]);
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    assert!(
        ended.stderr.contains("sheet_thickness,die_shoulder_radius"),
        "{}",
        ended.stderr
    );
    // Without -sensitivity the derivatives are left behind.
    finish(&folder, 1, &[SHORT, "-restart"]);
    assert!(!folder.join("sensitivity.csv").exists());
}

/// Every parameter that can be named is compared with differences above.
#[test]
fn no_parameter_is_forgotten() {
    let case = Case::reference().unwrap();
    let all = case.with(&[]).unwrap().options();
    let source = include_str!("sensitivity.rs");
    let named = all.iter().map(|(name, _)| *name);
    let refused: Vec<&str> = named
        .filter(|name| {
            let mut options: BTreeMap<String, String> = BTreeMap::new();
            options.insert("sensitivity".to_owned(), (*name).to_owned());
            options.insert("friction_coefficient".to_owned(), "0.1".to_owned());
            let known = Case::read(&options).is_ok();
            known && !source.contains(&format!("\"{name}\""))
        })
        .collect();
    assert!(refused.is_empty(), "{refused:?}");
}
