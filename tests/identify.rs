//! Identification and design on coarse meshes: what a hidden value has produced is found again, what a curve cannot tell is
//! said, and all of it is the same on two ranks.

mod program;

use std::path::Path;

use program::{Ended, history, run, scratch};

/// A coarse mesh, some millimetres down.
const COARSE: &str = "-sheet_nx 40 -sheet_ny 2";

/// Runs the program with these options and its results in the folder.
fn program(ranks: usize, folder: &Path, options: &str) -> Ended {
    let mut words: Vec<&str> = COARSE.split(' ').chain(options.split(' ')).collect();
    words.extend(["-output_dir", folder.to_str().unwrap()]);
    run(ranks, 300, &words)
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Deviates of the normal distribution, by Box and Muller's method from a linear congruential sequence.
fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    let mut uniform = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    move || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos()
}

/// A measured file: the forces of a run with these options at every quarter of a millimetre down to 6 mm, with 1 % of noise.
fn curve(folder: &Path, seed: u64, options: &str) -> String {
    let strokes: Vec<String> = (1..=24)
        .map(|i| (0.25 * f64::from(i)).to_string())
        .collect();
    let hidden = folder.join("hidden");
    let motion = format!(
        "-stroke 6 -time_load {} -unload_fraction 0 -output_every 0",
        900.0 * 6.0 / 28.5
    );
    let ended = program(
        1,
        &hidden,
        &format!("{options} {motion} -report_strokes {}", strokes.join(",")),
    );
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let history = history(&hidden);
    let mut noise = normal(seed);
    let mut table = "stroke_mm,force_N,uncertainty_N\n".to_owned();
    for stroke in &strokes {
        let wanted: f64 = stroke.parse().unwrap();
        let place = history["stroke_mm"]
            .iter()
            .position(|s| (s - wanted).abs() < 1e-9)
            .unwrap();
        let force = history["force_N"][place];
        table += &format!(
            "{stroke},{},{}\n",
            force * (1.0 + 0.01 * noise()),
            0.01 * force
        );
    }
    let file = folder.join("measured.csv");
    std::fs::write(&file, table).unwrap();
    file.to_str().unwrap().to_owned()
}

/// How far each estimate is from the hidden value, in standard errors.
fn off(found: &serde_json::Value, hidden: &[f64]) -> Vec<f64> {
    let parameters = found["parameters"].as_array().unwrap();
    let number = |one: &serde_json::Value, name: &str| one[name].as_f64().unwrap();
    let off = |(one, hidden): (&serde_json::Value, &f64)| {
        (number(one, "estimate") - hidden) / number(one, "standard_error")
    };
    parameters.iter().zip(hidden).map(off).collect()
}

#[test]
fn hidden_friction_and_strength_are_found_again_on_one_rank_and_on_two() {
    let folder = scratch("identify-twin");
    let law = "-hardening hollomon -stroke 28.5";
    let file = curve(
        &folder,
        1,
        "-hardening hollomon -friction_coefficient 0.1342 -hollomon_k 550",
    );
    let mut estimates = Vec::new();
    for ranks in [1, 2] {
        let results = folder.join(format!("ranks-{ranks}"));
        let search = "-friction_coefficient 0.094 -hollomon_k 715 -parameters friction_coefficient:0:0.5,hollomon_k:200:1000";
        let ended = program(ranks, &results, &format!("{law} {search} -identify {file}"));
        assert_eq!(ended.code, Some(0), "{}", ended.text());
        let found = json(&results.join("identification.json"));
        let off = off(&found, &[0.1342, 550.0]);
        assert!(off.iter().all(|off| off.abs() < 3.0), "{off:?}");
        assert!(found["runs"].as_u64().unwrap() <= 15);
        assert!(found["distance"].as_f64().unwrap() <= 0.1);
        for name in ["fit.svg", "fit.png", "run.log", "run-001/summary.json"] {
            assert!(results.join(name).exists(), "{name}");
        }
        // The runs keep to their logs.
        assert!(!ended.says("Newton"), "{}", ended.stdout);
        let values = found["parameters"].as_array().unwrap().iter();
        let near = |one: &serde_json::Value| {
            [
                one["estimate"].as_f64().unwrap(),
                one["standard_error"].as_f64().unwrap(),
            ]
        };
        estimates.push(values.map(near).collect::<Vec<_>>());
    }
    for (one, two) in estimates[0].iter().zip(&estimates[1]) {
        assert!((one[0] - two[0]).abs() < 1e-2 * one[1], "{estimates:?}");
    }
}

/// Of strength and exponent the curve tells little more than one number: what is left bends the valley by its noise.
#[test]
fn friction_strength_and_exponent_are_found_again_and_what_is_hardly_told_is_said() {
    let folder = scratch("identify-valley");
    let law = "-hardening hollomon -stroke 28.5";
    let search = "-friction_coefficient 0.094 -hollomon_k 715 -hollomon_n 0.156 \
                  -parameters friction_coefficient:0:0.5,hollomon_k:200:1000,hollomon_n:0.05:0.5";
    let search = search.split_whitespace().collect::<Vec<_>>().join(" ");
    let hidden =
        "-hardening hollomon -friction_coefficient 0.1342 -hollomon_k 550 -hollomon_n 0.223";
    for seed in [1, 2] {
        let file = curve(&folder, seed, hidden);
        let results = folder.join(format!("seed-{seed}"));
        let ended = program(1, &results, &format!("{law} {search} -identify {file}"));
        assert_eq!(ended.code, Some(1), "{}", ended.text());
        assert!(ended.says("converged: "), "{}", ended.stdout);
        let found = json(&results.join("identification.json"));
        assert_eq!(found["converged"], true);
        assert!(found["runs"].as_u64().unwrap() <= 15);
        assert!(found["distance"].as_f64().unwrap() <= 0.1);
        let off = off(&found, &[0.1342, 550.0, 0.223]);
        assert!(off.iter().all(|off| off.abs() < 3.0), "{off:?}");
        assert_eq!(found["parameters"][0]["identified"], true);
        assert_eq!(found["parameters"][2]["identified"], false);
    }
}

#[test]
fn what_the_curve_cannot_tell_is_said() {
    let folder = scratch("identify-weak");
    let file = curve(&folder, 2, "-friction_coefficient 0.1342");
    // How far a point slips before it slides hardly shows in the force.
    let search = "-friction_coefficient 0.1342 -parameters table_factor:0.5:1.5,friction_compliance:1e-4:1e-2";
    let ended = program(
        1,
        &folder.join("results"),
        &format!("{search} -identify {file} -most_runs 20"),
    );
    assert_eq!(ended.code, Some(1), "{}", ended.text());
    let found = json(&folder.join("results/identification.json"));
    assert_eq!(found["parameters"][0]["identified"], true);
    assert_eq!(found["parameters"][1]["identified"], false);
    assert!(ended.says("not determined: "), "{}", ended.stdout);
    assert!(ended.says("FINISHED, but not every verdict holds"));
}

#[test]
fn a_start_that_cannot_be_run_and_runs_that_are_used_up_are_said() {
    let folder = scratch("identify-ends");
    let file = curve(&folder, 3, "-friction_coefficient 0");
    let search = format!("-table_factor 0.7 -parameters table_factor:0.5:1.5 -identify {file}");
    let ended = program(
        2,
        &folder.join("failed"),
        &format!("{search} -newton_max_iterations 1 -dt_min 0.5"),
    );
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    let sentence = "the run with the values the search starts from was not solved to its end";
    assert!(ended.stderr.contains(sentence), "{}", ended.stderr);
    assert_eq!(ended.stderr.matches("ssnp155: ").count(), 1);
    let ended = program(1, &folder.join("short"), &format!("{search} -most_runs 1"));
    assert_eq!(ended.code, Some(1), "{}", ended.text());
    assert!(ended.says("not converged: the runs that -most_runs allows are used up"));
}

const DESIGN: &str = "-design 100 -stroke 17 -time_load 537";

#[test]
fn a_stroke_is_found_that_releases_at_the_wanted_angle() {
    let folder = scratch("design");
    let ended = program(
        2,
        &folder,
        &format!("{DESIGN} -parameters stroke:14:24 -most_runs 6"),
    );
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let found = json(&folder.join("design.json"));
    let angle = found["best"]["angle_deg"].as_f64().unwrap();
    assert!((angle - 100.0).abs() <= 0.05, "{angle}");
    // It holds on the finer mesh, and the run that stands for it says the same.
    assert_eq!(found["best"]["refinement"], 2);
    assert_eq!(found["trials"][0]["refinement"], 1);
    let best = Path::new(found["best"]["folder"].as_str().unwrap()).join("summary.json");
    let angles = &json(&best)["angles_deg"];
    assert_eq!(angles["tools vanish at 0 mm"].as_f64().unwrap(), angle);
}

#[test]
fn an_angle_out_of_reach_gets_the_nearest_one() {
    let folder = scratch("design-reach");
    let ended = program(
        1,
        &folder,
        &format!("{DESIGN} -design_refinement 1 -parameters stroke:16:17.5"),
    );
    assert_eq!(ended.code, Some(1), "{}", ended.text());
    let found = json(&folder.join("design.json"));
    assert_eq!(found["found"], "out_of_reach");
    assert_eq!(found["best"]["values"][0].as_f64(), Some(17.5));
    assert!(
        ended.says("cannot be reached within the bounds"),
        "{}",
        ended.stdout
    );
}
