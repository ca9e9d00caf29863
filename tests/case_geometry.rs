//! Combinations of options that cannot work are refused with the numbers that show it.

use std::collections::BTreeMap;

use ssnp155::case::{Case, CaseError, check_ranks};

fn read(given: &[(&str, &str)]) -> Result<Case, CaseError> {
    let options: BTreeMap<String, String> = given
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    Case::read(&options)
}

fn refusal(given: &[(&str, &str)]) -> String {
    read(given).unwrap_err().to_string()
}

#[test]
fn tools_and_sheets_that_cannot_work_are_refused_with_numbers() {
    let text = refusal(&[("sheet_thickness", "1.5")]);
    assert!(
        text.contains("leaves 1.5 mm and -sheet_thickness is 1.5 mm; make the clearance greater"),
        "{text}"
    );
    assert!(refusal(&[("punch_radius", "26")]).contains("leaves -1 mm"));
    assert!(
        refusal(&[
            ("die_radius", "1.1"),
            ("punch_radius", "0.1"),
            ("stroke", "1")
        ])
        .contains("leaves 1 mm")
    );
    let text = refusal(&[("stroke", "29")]);
    assert!(
        text.starts_with(
            "-stroke 29 mm squeezes the sheet on the bottom of the die, which is 29 mm below"
        ),
        "{text}"
    );
    assert!(read(&[("stroke", "28.999")]).is_ok());
    let text = refusal(&[("sheet_length", "60")]);
    assert!(
        text.contains("half of -sheet_length is 30 mm and the die's flat begins at 29 mm"),
        "{text}"
    );
    assert!(text.contains("use a -sheet_length above 60 mm"), "{text}");
    let text = refusal(&[("sheet_length", "80")]);
    assert!(text.contains("the path round the punch to the shoulder is 39.290 mm and half of -sheet_length is 40 mm"), "{text}");
    assert!(text.contains("above 80.581 mm"), "{text}");
    assert!(read(&[("sheet_length", "80.6")]).is_ok());
    assert!(read(&[("sheet_length", "80"), ("stroke", "15")]).is_ok());
}

#[test]
fn every_rank_needs_an_element() {
    let case = read(&[("sheet_nx", "2"), ("sheet_ny", "1")]).unwrap();
    assert!(check_ranks(2, &case).is_ok());
    let text = check_ranks(3, &case).unwrap_err().to_string();
    assert!(
        text.starts_with(
            "too many MPI ranks: 3, and the mesh has -sheet_nx 2 times -sheet_ny 1 elements"
        ),
        "{text}"
    );
}

#[test]
fn steps_are_ordered() {
    let text = refusal(&[("dt_initial", "10")]);
    assert!(
        text.contains("-dt_min 0.000001 ms <= -dt_initial 10 ms <= -dt_max 9 ms does not hold"),
        "{text}"
    );
    assert!(read(&[("dt_initial", "9"), ("dt_min", "9")]).is_ok());
}
