//! `scripts/error_bars.py` on a small mesh: its bars against a reference of twice the elements and half the step.

use std::path::Path;
use std::process::{Command, Output};

#[path = "mpi_environment/mod.rs"]
mod mpi_environment;

/// Four millimetres of the benchmark, at which the sheet yields, and what springs back.
const SMALL: &str = "-options_file inputs/band.opts -sheet_nx 60 -sheet_ny 4 -stroke 4 -time_load 126 -unload_fraction 0 \
                     -report_strokes 2,3";

fn script(name: &str, words: &str) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/error_bars.py");
    Command::new("python3")
        .args(["-B", script])
        .args(words.split_whitespace())
        .env("SSNP155", env!("CARGO_BIN_EXE_ssnp155"))
        .env("ERROR_BARS", &folder)
        .envs(mpi_environment::FEW_CORES)
        .output()
        .expect("python3 is needed")
}

#[test]
fn bars_hold_the_distance_to_a_finer_solution() {
    let ended = script("error-bars", &format!("--effectivity {SMALL}"));
    let text = String::from_utf8_lossy(&ended.stdout);
    assert!(
        ended.status.success(),
        "{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    // Place by place; behind an empty line the same as norms along the parts of the path.
    let (places, norms) = text.split_once("\n\n").unwrap();
    let rows = |table: &str| -> Vec<(String, Vec<String>)> {
        let cells = |line: &str| {
            line.trim_matches('|')
                .split('|')
                .map(|cell| cell.trim().to_owned())
                .collect()
        };
        table
            .lines()
            .skip(2)
            .filter(|line| !line.is_empty())
            .map(|line| (line.to_owned(), cells(line)))
            .collect()
    };
    let norms = rows(norms);
    let mut long = 0;
    for (line, cells) in &norms {
        let effectivity: f64 = cells[5].parse().unwrap();
        assert!(effectivity >= 0.7, "{line}");
        // A part with one place has no norm but its own.
        if cells[2] != "1" {
            assert!(effectivity <= 3.0, "{line}");
            long += 1;
        }
    }
    assert_eq!(long, 3, "each quantity on the way down: {text}");
    let mut angles = 0;
    for (line, cells) in rows(places) {
        let effectivity: f64 = cells[9].parse().unwrap_or_else(|_| panic!("{line}"));
        // The goal of docs/error-bars.md. A distance can be small by accident, so a bar may be larger than it; that of
        // an angle, which has no teeth, may not.
        assert!(effectivity >= 0.7, "{line}");
        if cells[1] == "angle deg" {
            assert!(effectivity <= 3.0, "{line}");
            angles += 1;
        }
    }
    assert_eq!(
        angles, 4,
        "two strokes, full stroke, and without tools: {text}"
    );
    let parts = Path::new(env!("CARGO_TARGET_TMPDIR")).join("error-bars/error-bars.csv");
    let mut reader = csv::Reader::from_path(parts).unwrap();
    for row in reader.records() {
        let row = row.unwrap();
        let [bar, mesh, integration, spacing, steps, scatter] =
            std::array::from_fn(|k| row[3 + k].parse::<f64>().unwrap());
        let sum = mesh.max(integration) + spacing + steps.max(scatter);
        assert!(bar > 0.0 && (bar - sum).abs() < 1e-4 * bar, "{row:?}");
    }
}

#[test]
fn what_has_no_companions_is_refused_in_one_sentence() {
    for (name, words, answer) in [
        (
            "error-bars-mesh",
            format!("{SMALL} -sheet_ny 1"),
            "a mesh of 60 x 1 elements has no half; take at least 2 x 2",
        ),
        (
            "error-bars-restart",
            format!("{SMALL} -restart newest"),
            "-restart has no meaning here",
        ),
        (
            "error-bars-option",
            format!("{SMALL} -sheet_nz 3"),
            "sheet_nz",
        ),
        (
            "error-bars-failed",
            format!("{SMALL} -newton_max_iterations 2 -dt_min 1"),
            "did not finish",
        ),
    ] {
        let ended = script(name, &words);
        let text = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(1), "{name}: {text}");
        let last = text.lines().rfind(|line| line.contains("error_bars:"));
        assert!(
            text.contains(answer) && last.is_some() && !text.contains("Traceback"),
            "{name}: {text}"
        );
    }
}
