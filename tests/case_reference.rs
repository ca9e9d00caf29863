//! The reference values in the program are those the benchmark is judged by.

use ssnp155::case::{Case, Instant, ReferenceValue, Tolerance};

fn value(id: &str) -> ReferenceValue {
    Case::reference()
        .and_then(|case| case.reference_values())
        .unwrap()
        .into_iter()
        .find(|value| value.id == id)
        .unwrap_or_else(|| panic!("no {id}"))
}

#[test]
fn the_document_tests_the_motion_of_the_punch() {
    let loaded = value("dy_a_punch_loaded");
    assert_eq!(
        (loaded.value, loaded.tolerance, loaded.when),
        (-28.5, Tolerance::Relative(0.001), Instant::FullStroke)
    );
    assert!((loaded.allowed_deviation() - 0.0285).abs() < 1e-15);
    assert!(loaded.agrees(-28.5285) && !loaded.agrees(-28.53) && !loaded.agrees(f64::NAN));
    let unloaded = value("dy_a_punch_unloaded");
    assert_eq!(
        (unloaded.value, unloaded.when),
        (-25.65, Instant::EndOfUnloading)
    );
}

#[test]
fn code_asters_results_agree_with_the_values_taken_from_them() {
    for (id, result) in [
        ("dy_a_sheet_loaded", -29.001),
        ("dy_a_sheet_unloaded", -26.850),
        ("force_d1", 49.9),
        ("force_d10", 151.5),
        ("force_d20", 181.0),
        ("force_d20", 183.0),
        ("angle_loaded", 20.40),
        ("angle_loaded", 20.50),
    ] {
        assert!(value(id).agrees(result), "{id} {result}");
    }
    assert_eq!(value("force_d10").when, Instant::Travel(10.0));
}

#[test]
fn every_value_has_a_source_and_a_unit() {
    let values = Case::reference()
        .and_then(|case| case.reference_values())
        .unwrap();
    assert_eq!(values.len(), 8);
    assert!(
        values
            .iter()
            .all(|value| !value.source.is_empty()
                && ["mm", "N", "deg"].contains(&value.unit.as_str()))
    );
}

#[test]
fn values_belong_to_the_case_they_were_taken_at() {
    let count = |change: &dyn Fn(&mut Case)| {
        let mut case = Case::reference().unwrap();
        change(&mut case);
        let values = case.reference_values().unwrap();
        (
            values.len(),
            values.iter().any(|v| v.when == Instant::Withdrawn),
        )
    };
    assert_eq!(count(&|_| ()), (8, false));
    assert_eq!(count(&|case| case.loading.unload_fraction = 1.0), (7, true));
    assert_eq!(
        count(&|case| case.friction.coefficient = 0.1342),
        (7, false)
    );
    assert_eq!(count(&|case| case.friction.coefficient = 0.1), (0, false));
    assert_eq!(count(&|case| case.discretisation.nx = 85), (0, false));
    assert_eq!(count(&|case| case.stepping.dt_max = 3.0), (8, false));
}
