//! What the reader of hardening tables takes and what it refuses, and in which words.

use proptest::prelude::{any, prop, proptest};
use ssnp155::material::hardening::Hardening;

/// MPa; a stress of 70.5 MPa is at a strain of 1e-3.
const YOUNG: f64 = 70500.0;

fn refusal(table: &str) -> String {
    Hardening::from_csv(table, "test.csv", YOUNG)
        .unwrap_err()
        .to_string()
}

#[test]
fn a_malformed_table_is_refused_with_the_line_to_blame() {
    let cases = [
        ("", "table is empty"),
        ("# only a comment\n", "table is empty"),
        ("strain,stress\n", "points: 0; at least two"),
        ("strain,stress\n1e-3,70.5\n", "points: 1; at least two"),
        (
            "0.001,70.5\n0.1,80\n",
            "line 1: the header is '0.001,70.5' instead of strain,stress",
        ),
        (
            "strain,stress\n0.001\n",
            "line 2: one column instead of two",
        ),
        (
            "strain,stress\n0.001;70.5\n",
            "line 2: one column instead of two",
        ),
        (
            "strain,stress\n0.001,70.5,3\n",
            "line 2: 3 columns instead of two",
        ),
        (
            "# comment\nstrain,stress\n\n0.001,abc\n",
            "line 4: the stress 'abc' is not a number",
        ),
        (
            "strain,stress\n1d-3,70.5\n",
            "line 2: the strain '1d-3' is not a number",
        ),
        (
            "strain,stress\nNaN,70.5\n0.1,80\n",
            "line 2: the strain 'NaN' is not finite",
        ),
        (
            "strain,stress\n0.001,inf\n0.1,80\n",
            "line 2: the stress 'inf' is not finite",
        ),
        (
            "strain,stress\n0.001,-70.5\n0.1,80\n",
            "line 2: strain 1e-3 and stress -70.5 MPa",
        ),
        (
            "strain,stress\n0,0\n0.1,80\n",
            "line 2: strain 0 and stress 0 MPa",
        ),
        (
            "strain,stress\n0.002,70.5\n0.1,80\n",
            "line 2: the first point is not on the elastic line",
        ),
        (
            "strain,stress\n0.001,70.5\n0.1,80\n0.05,90\n",
            "line 4: the plastic strain",
        ),
        (
            "strain,stress\n0.001,70.5\n0.0011,80\n",
            "line 3: the plastic strain",
        ),
        (
            "strain,stress\n0.001,70.5\n0.1,80\n0.1,80\n",
            "line 4: the plastic strain",
        ),
        (
            "strain,stress\n0.001,70.5\n0.1,80\n0.2,79\n",
            "line 4: the stress 79 MPa is below the one before (80 MPa)",
        ),
    ];
    for (table, expected) in cases {
        let text = refusal(table);
        assert!(
            text.starts_with("hardening table test.csv") && text.contains(expected),
            "{table:?}: {text}"
        );
        assert_eq!(text.lines().count(), 1);
    }
}

#[test]
fn comments_blanks_windows_lines_and_a_byte_order_mark_do_no_harm() {
    let table =
        "\u{feff}# units: MPa\r\n\r\n strain , stress \r\n 1e-3 , 70.5 \r\n# more\r\n0.1,80\r\n";
    assert_eq!(
        Hardening::from_csv(table, "test.csv", YOUNG)
            .unwrap()
            .initial(),
        70.5
    );
}

#[test]
fn another_young_modulus_needs_another_first_point() {
    let text = Hardening::benchmark(210e3).unwrap_err().to_string();
    assert!(
        text.contains("line 5: the first point is not on the elastic line")
            && text.contains("-young_modulus")
    );
}

#[test]
fn what_is_no_text_file_is_refused_by_name() {
    let directory = std::env::temp_dir();
    let text = Hardening::from_file(&directory, YOUNG)
        .unwrap_err()
        .to_string();
    assert!(text.contains("cannot be read"), "{text}");
    let text = Hardening::from_file("no/such/table.csv".as_ref(), YOUNG)
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("no/such/table.csv cannot be read (No such file"),
        "{text}"
    );
    let binary = directory.join(format!("ssnp155-not-utf8-{}.csv", std::process::id()));
    std::fs::write(&binary, [0xff, 0xfe]).unwrap();
    let text = Hardening::from_file(&binary, YOUNG)
        .unwrap_err()
        .to_string();
    std::fs::remove_file(&binary).unwrap();
    assert!(text.contains("not UTF-8"), "{text}");
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in any::<String>(), young in any::<f64>()) {
        let _ = Hardening::from_csv(&text, "test.csv", young);
        let _ = Hardening::from_csv(&format!("strain,stress\n{text}"), "test.csv", young);
    }

    #[test]
    fn any_numbers_are_read_or_refused(
        rows in prop::collection::vec((any::<f64>(), any::<f64>()), 0..6),
        young in any::<f64>(),
        (q, p, three_g) in any::<(f64, f64, f64)>(),
    ) {
        if let Ok(curve) = Hardening::from_points(&rows, young) {
            curve.return_map(q, p, three_g);
            curve.plastic_work(p);
        }
    }
}
