//! Tools from files in a case: what counts as the benchmark's, and which options still have an effect.

use std::collections::BTreeMap;

use ssnp155::case::{Case, CaseError};

const FILES: [(&str, &str); 2] = [
    ("punch_profile", "inputs/tools/benchmark-punch.csv"),
    ("die_profile", "inputs/tools/benchmark-die.csv"),
];
const NOSE: (&str, &str) = ("punch_profile", "inputs/tools/air-bending-punch.csv");

fn read(given: &[(&str, &str)]) -> Result<Case, CaseError> {
    let options: BTreeMap<String, String> = given
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    Case::read(&options)
}

#[test]
fn the_benchmarks_outlines_have_its_reference_values_and_others_have_none() {
    let own = read(&[]).unwrap();
    let files = read(&FILES).unwrap();
    assert!(files.differences_from_reference().unwrap().is_empty());
    assert_eq!(
        files.reference_values().unwrap(),
        own.reference_values().unwrap()
    );
    assert_eq!(
        files.regression_values().unwrap(),
        own.regression_values().unwrap()
    );
    assert!(!files.regression_values().unwrap().is_empty());
    assert_eq!(
        files.reference_force().unwrap(),
        own.reference_force().unwrap()
    );
    let nose = read(&[NOSE, ("stroke", "20")]).unwrap();
    assert!(nose.reference_values().unwrap().is_empty());
    assert!(nose.regression_values().unwrap().is_empty());
    assert!(nose.reference_force().unwrap().curve.is_empty());
    let differences = nose.differences_from_reference().unwrap();
    assert!(
        differences
            .iter()
            .any(|d| d.option == "punch_profile" && d.reference == "benchmark")
    );
    // The benchmark's outline under other radii that it replaces is still the benchmark.
    assert_eq!(files.tool_marks(), own.tool_marks());
    assert_ne!(nose.tool_marks()[1], own.tool_marks()[1]);
    assert_eq!(nose.tool_marks()[0], own.tool_marks()[0]);
}

#[test]
fn a_size_that_a_file_replaces_is_not_shown_and_only_its_default_may_be_given() {
    let shown = |case: &Case, name: &str| case.options().iter().any(|(option, _)| *option == name);
    let case = read(&[
        NOSE,
        ("stroke", "20"),
        ("punch_radius", "23.5"),
        ("die_radius", "26"),
    ])
    .unwrap();
    assert!(!shown(&case, "punch_radius") && shown(&case, "die_radius"));
    let error = read(&[NOSE, ("punch_radius", "23")])
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("option -punch_radius 23 has no effect: -punch_profile"),
        "{error}"
    );
    // Read again from what it shows, it is the same case.
    let again = case.with(&[("stroke", 20.0)]).unwrap();
    assert_eq!(again, case);
}

#[test]
fn tools_stand_on_the_sheet_whatever_its_thickness_and_their_heights() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("case-tools");
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let punch = write("punch.csv", "x_mm,y_mm,radius_mm\n0,107,3\n10,127,0\n");
    let die = write(
        "die.csv",
        "radius_mm,y_mm,x_mm\n0,-50,0\n0,-50,12\n2,-30,12\n0,-30,70\n",
    );
    for thickness in [0.5, 1.0, 2.0] {
        let text = thickness.to_string();
        let case = read(&[
            ("punch_profile", &punch),
            ("die_profile", &die),
            ("sheet_thickness", &text),
            ("stroke", "5"),
        ])
        .unwrap();
        let tip = case.punch().distance([0.0, thickness]);
        assert!(
            tip.value.abs() < 1e-12 && tip.gradient[1] < -0.999,
            "{tip:?}"
        );
        assert!((case.die().distance([20.0, 0.25]).value - 0.25).abs() < 1e-12);
        // 20 mm deep, the punch 5 mm down: its nose is 15 mm and the thickness from the bottom.
        let least = case.least_gap().unwrap();
        assert!(least.gap > thickness && least.stroke == 5.0, "{least:?}");
    }
}
