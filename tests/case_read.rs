//! A case is read from options, refuses what is malformed or out of range, and gives its options back.

use std::collections::BTreeMap;

use proptest::prelude::{any, proptest};
use ssnp155::case::{Case, CaseError, Difference, Dynamics, OptionSource};

fn options(given: &[(&str, &str)]) -> BTreeMap<String, String> {
    given
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect()
}

fn read(given: &[(&str, &str)]) -> Result<Case, CaseError> {
    Case::read(&options(given))
}

fn refusal(given: &[(&str, &str)]) -> String {
    read(given).unwrap_err().to_string()
}

/// A source that knows one option only and fails on it.
struct Broken(&'static str);

impl OptionSource for Broken {
    fn get(&self, name: &str) -> Result<Option<String>, CaseError> {
        if name != self.0 {
            return Ok(None);
        }
        Err(CaseError::Unreadable {
            option: name.to_owned(),
            reason: "PETSc error 63".to_owned(),
        })
    }
}

#[test]
fn a_source_that_fails_is_no_reason_for_the_default() {
    let reference = Case::reference().unwrap();
    for (name, _) in reference.options() {
        let error = Case::read(&Broken(name)).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("option -{name} cannot be read: PETSc error 63")
        );
    }
    assert_eq!(Case::read(&Broken("nobody's")).unwrap(), reference);
}

#[test]
fn without_options_it_is_the_frictionless_benchmark() {
    let case = Case::reference().unwrap();
    assert_eq!(
        (case.sheet.length, case.sheet.thickness, case.sheet.width),
        (120.0, 1.0, 30.0)
    );
    assert_eq!(
        (
            case.discretisation.nx,
            case.discretisation.ny,
            case.discretisation.quadrature()
        ),
        (170, 5, ssnp155::element::Quadrature::Reduced)
    );
    assert_eq!(
        (
            case.tools.punch_radius,
            case.tools.die_radius,
            case.tools.die_shoulder_radius
        ),
        (23.5, 25.0, 4.0)
    );
    assert_eq!(
        (case.material.young_modulus, case.material.poisson_ratio),
        (70500.0, 0.342)
    );
    assert_eq!(
        (case.material.density, case.material.hardening.initial()),
        (2.7e-3, 194.0)
    );
    assert_eq!(
        (
            case.sheet.force_factor(),
            case.tools.die_edge(),
            case.loading.motion().end()
        ),
        (60.0, 29.0, 1000.0)
    );
    assert_eq!(case.loading.dynamics, Dynamics::Slow);
    assert!(case.differences_from_reference().unwrap().is_empty());
}

#[test]
fn the_punch_goes_down_and_a_share_of_the_way_back() {
    let loading = Case::reference().unwrap().loading;
    for (time, travel) in [
        (-1.0, 0.0),
        (0.0, 0.0),
        (450.0, 14.25),
        (900.0, 28.5),
        (950.0, 27.075),
        (1000.0, 25.65),
    ] {
        assert!(
            (loading.motion().depth(time) - travel).abs() < 1e-12,
            "t = {time}"
        );
    }
    assert_eq!(
        loading.motion().depth(2000.0),
        loading.motion().depth(1000.0)
    );
    let loading = read(&[("unload_fraction", "0")]).unwrap().loading;
    assert_eq!(loading.motion().end(), 900.0);
}

#[test]
fn what_is_shown_reads_back_as_the_same_case() {
    // A value unlike the default for each option, so that no option is shown from another one's field.
    let given = [
        ("sheet_length", "130.5"),
        ("sheet_thickness", "0.75"),
        ("sheet_width", "31"),
        ("punch_radius", "22.5"),
        ("die_radius", "25.5"),
        ("die_shoulder_radius", "3.5"),
        // With radii of their own only; tests/case_tools.rs has paths.
        ("punch_profile", "benchmark"),
        ("die_profile", "benchmark"),
        ("stroke", "27"),
        ("unload_fraction", "0.25"),
        ("time_load", "800"),
        ("time_unload", "120"),
        ("dynamics", "none"),
        ("young_modulus", "70500.001"),
        ("poisson_ratio", "0.33"),
        ("density", "2.8e-3"),
        ("hardening", "table"),
        ("hardening_file", "inputs/reference/hardening.csv"),
        ("table_factor", "1.25"),
        ("sheet_nx", "171"),
        ("sheet_ny", "6"),
        ("quadrature", "3"),
        ("quadrature_thickness", "7"),
        ("contact_location", "nodes"),
        ("contact_points_per_edge", "7"),
        ("contact_compliance", "6e-5"),
        ("penetration_limit", "6e-3"),
        ("friction_coefficient", "0.2"),
        ("friction_compliance", "7e-4"),
        ("fixed_steps_load", "90"),
        ("fixed_steps_unload", "20"),
        ("report_strokes", "3,4.5"),
        ("report_returns", "0.5,2"),
        ("dt_initial", "1.5"),
        ("dt_min", "2e-7"),
        ("dt_max", "8.5"),
        ("extrapolate", "false"),
        ("newton_tolerance", "2e-9"),
        ("newton_max_iterations", "31"),
        ("output_dir", "elsewhere"),
        ("output_every", "0"),
        ("monitor_iterations", "true"),
        ("quiet", "true"),
        ("compare", "one,two"),
        ("checkpoint_every", "20"),
        ("checkpoint_minutes", "7.5"),
        ("wall_limit", "3600"),
        ("overwrite", "true"),
        ("dry_run", "true"),
        ("sensitivity", "friction_coefficient,table_factor"),
    ];
    // What only one run, an identification or a design can have.
    let single = [
        ("restart", "results/checkpoint-000123"),
        ("identify", "none"),
        ("design", "none"),
        ("parameters", "none"),
        ("most_runs", "15"),
        ("design_tolerance", "0.05"),
        ("design_refinement", "2"),
    ];
    let searched = |identify, design| {
        [
            ("restart", "no"),
            ("identify", identify),
            ("design", design),
            ("parameters", "sheet_thickness:0.5:1"),
            ("most_runs", "12"),
            ("design_tolerance", "0.1"),
            ("design_refinement", "3"),
        ]
    };
    for of_kind in [
        single,
        searched("curve.csv", "none"),
        searched("none", "50.5"),
    ] {
        let given = [&given[..], &of_kind].concat();
        let case = read(&given).unwrap();
        let shown: BTreeMap<String, String> = case
            .options()
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
        assert_eq!(Case::read(&shown).unwrap(), case);
        assert_eq!(shown, options(&given));
    }
}

#[test]
fn a_case_differs_by_physics_and_mesh_only() {
    let case = read(&[
        ("stroke", "20"),
        ("sheet_nx", "85"),
        ("dt_max", "5"),
        ("output_dir", "elsewhere"),
    ])
    .unwrap();
    let differences = case.differences_from_reference().unwrap();
    let expected =
        [("stroke", "20", "28.5"), ("sheet_nx", "85", "170")].map(|(option, value, reference)| {
            Difference {
                option,
                value: value.to_owned(),
                reference: reference.to_owned(),
            }
        });
    assert_eq!(differences, expected);
    assert!(
        read(&[("stroke", "28.500"), ("output_every", "0")])
            .unwrap()
            .differences_from_reference()
            .unwrap()
            .is_empty()
    );
}

#[test]
fn the_benchmarks_table_from_a_file_is_still_the_reference() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/inputs/reference/hardening.csv"
    );
    assert!(
        read(&[("hardening_file", path)])
            .unwrap()
            .differences_from_reference()
            .unwrap()
            .is_empty()
    );
}

#[test]
fn numbers_are_finite_and_in_range() {
    assert_eq!(
        refusal(&[("stroke", "abc")]),
        "option -stroke abc: this is not a number; specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)"
    );
    assert!(refusal(&[("density", "1d-3")]).contains("the exponent is written with e, as in 1e-3"));
    assert!(refusal(&[("density", "1,5")]).contains("the decimal sign is a point"));
    for text in ["nan", "inf", "-inf", "1e999"] {
        assert!(
            refusal(&[("stroke", text)]).contains("the number is not finite"),
            "{text}"
        );
    }
    for (name, text) in [
        ("stroke", "0"),
        ("stroke", "-1"),
        ("sheet_length", "1e6"),
        ("die_shoulder_radius", "0"),
        ("poisson_ratio", "0.5"),
        ("poisson_ratio", "-0.1"),
        ("unload_fraction", "1.0001"),
        ("contact_compliance", "0"),
        ("young_modulus", "-1"),
        ("sheet_nx", "0"),
        ("sheet_ny", "-3"),
        ("contact_points_per_edge", "25"),
        ("sheet_nx", "99999999999999999999"),
        ("newton_max_iterations", "0"),
        ("time_load", "0"),
        ("dt_min", "0"),
        ("newton_tolerance", "1"),
    ] {
        let text_of_error = refusal(&[(name, text)]);
        assert!(
            text_of_error.starts_with(&format!("option -{name} {text}: the value is out of range")),
            "{text_of_error}"
        );
    }
    assert!(read(&[("poisson_ratio", "0"), ("unload_fraction", "1")]).is_ok());
}

#[test]
fn whole_numbers_words_and_flags_are_what_they_are() {
    for text in ["3.0", "1e3", "five", "0x10", "-", "1 2"] {
        assert!(
            refusal(&[("sheet_nx", text)]).contains("this is not a whole number"),
            "{text}"
        );
    }
    assert!(
        refusal(&[("dynamics", "fast")])
            .contains("none of the choices; specify one of the words: slow or none")
    );
    assert!(
        refusal(&[("quadrature", "4")]).contains("specify one of the words: 2 or 3 (default 2)")
    );
    // One point through the thickness of an element would not resist bending.
    assert!(refusal(&[("quadrature_thickness", "1")]).contains("none of the choices"));
    assert!(refusal(&[("extrapolate", "maybe")]).contains("neither true nor false"));
    for (text, on) in [
        ("", true),
        ("TRUE", true),
        ("1", true),
        ("yes", true),
        ("no", false),
        ("0", false),
        ("off", false),
    ] {
        assert_eq!(
            read(&[("extrapolate", text)]).unwrap().stepping.extrapolate,
            on
        );
    }
    assert_eq!(
        read(&[("sheet_nx", " +12 ")]).unwrap().discretisation.nx,
        12
    );
}

#[test]
fn an_option_without_its_value_is_refused() {
    for (name, _) in Case::reference().unwrap().options() {
        let read = read(&[(name, "")]);
        let bare = [
            "extrapolate",
            "monitor_iterations",
            "quiet",
            "dry_run",
            "restart",
            "overwrite",
        ];
        assert_eq!(read.is_ok(), bare.contains(&name), "-{name}");
    }
    assert_eq!(
        refusal(&[("hardening_file", "")]),
        "option -hardening_file has no value: specify a path (default benchmark)"
    );
}

#[test]
fn a_hardening_table_that_cannot_be_used_names_the_option_and_the_file() {
    let text = refusal(&[("hardening_file", "no/such.csv")]);
    assert!(
        text.starts_with("option -hardening_file: hardening table no/such.csv cannot be read"),
        "{text}"
    );
    let text = refusal(&[("young_modulus", "210000")]);
    assert!(
        text.contains("of the benchmark, line 5: the first point is not on the elastic line"),
        "{text}"
    );
}

proptest! {
    #[test]
    fn any_text_of_any_option_is_read_or_refused_in_one_sentence(which in 0_usize..100, text in any::<String>()) {
        let names = Case::reference().unwrap().options();
        let name = names[which % names.len()].0;
        if name != "hardening_file" {
            let _ = read(&[(name, &text)]).map_err(|error| error.to_string());
        }
    }

    #[test]
    fn any_numbers_are_read_or_refused(
        which in 0_usize..100, other in 0_usize..100, a in any::<f64>(), b in -10.0..200.0_f64,
    ) {
        let names = Case::reference().unwrap().options();
        let (a, b) = (a.to_string(), b.to_string());
        let _ = read(&[(names[which % names.len()].0, &a), (names[other % names.len()].0, &b)]);
    }
}
