//! The hardening curve against direct evaluation, and what its reader refuses.

use proptest::prelude::{any, prop, prop_assert, proptest};
use ssnp155::material::hardening::Hardening;

const YOUNG: f64 = 70500.0;
/// Three times the shear modulus of the benchmark's aluminium, MPa.
const THREE_G: f64 = 3.0 * YOUNG / (2.0 * 1.342);
const TABLE: &str = include_str!("../inputs/reference/hardening.csv");

fn benchmark() -> Hardening {
    Hardening::benchmark(YOUNG).unwrap()
}

/// The points (plastic strain, stress) of the benchmark's table, read independently of the library.
fn points() -> Vec<(f64, f64)> {
    let rows = TABLE
        .lines()
        .filter(|line| line.starts_with(|first: char| first.is_ascii_digit()));
    let mut points: Vec<(f64, f64)> = rows
        .map(|row| {
            let (strain, stress) = row.split_once(',').unwrap();
            let (strain, stress): (f64, f64) = (strain.parse().unwrap(), stress.parse().unwrap());
            (strain - stress / YOUNG, stress)
        })
        .collect();
    points[0].0 = 0.0;
    points
}

/// Direct evaluation: the first pair of points that reaches beyond p, or the last pair.
fn interpolated(points: &[(f64, f64)], p: f64) -> f64 {
    let pair = points
        .windows(2)
        .find(|pair| p < pair[1].0)
        .unwrap_or(&points[points.len() - 2..]);
    pair[0].1 + (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0) * (p - pair[0].0)
}

fn refusal(table: &str) -> String {
    Hardening::from_csv(table, "test.csv", YOUNG)
        .unwrap_err()
        .to_string()
}

#[test]
fn the_curve_goes_through_the_points_and_beyond_the_last() {
    let (curve, points) = (benchmark(), points());
    assert_eq!(points.len(), 19);
    assert_eq!(curve.initial(), 194.0);
    for &(p, stress) in &points {
        assert!((curve.yield_stress(p).0 - stress).abs() < 1e-12 * stress);
    }
    for step in 0..2000 {
        let p = 1e-3 * f64::from(step);
        assert!(
            (curve.yield_stress(p).0 - interpolated(&points, p)).abs() < 1e-9,
            "p = {p}"
        );
    }
}

#[test]
fn slope_is_the_derivative_and_work_the_integral() {
    let curve = benchmark();
    let h = 1e-6;
    for step in 0..1500 {
        let p = 1.3e-4 + 1e-3 * f64::from(step);
        let difference = (curve.yield_stress(p + h).0 - curve.yield_stress(p - h).0) / (2.0 * h);
        assert!(
            (difference - curve.yield_stress(p).1).abs() < 1e-5,
            "slope at p = {p}"
        );
        let difference = (curve.plastic_work(p + h) - curve.plastic_work(p - h)) / (2.0 * h);
        assert!(
            (difference - curve.yield_stress(p).0).abs() < 1e-5,
            "work at p = {p}"
        );
    }
    assert_eq!(curve.plastic_work(0.0), 0.0);
    let trapezoids: f64 = points()
        .windows(2)
        .map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0))
        .sum();
    assert!((curve.plastic_work(points()[18].0) - trapezoids).abs() < 1e-9);
}

#[test]
fn return_mapping_meets_the_curve_at_and_around_every_kink() {
    let (curve, points) = (benchmark(), points());
    for &(start, _) in &points {
        for &(end, _) in &points {
            for aside in [-1e-9, 0.0, 1e-9] {
                let (p_n, p) = (start, end + aside);
                if p <= p_n {
                    continue;
                }
                let q_trial = interpolated(&points, p) + THREE_G * (p - p_n);
                let step = curve.return_map(q_trial, p_n, THREE_G);
                assert!(
                    (p_n + step.dp - p).abs() < 1e-14 * (1.0 + p),
                    "from {p_n} to {p}: {step:?}"
                );
                assert!((step.yield_stress - interpolated(&points, p)).abs() < 1e-9);
                assert!((q_trial - THREE_G * step.dp - step.yield_stress).abs() < 1e-12 * q_trial);
                let (before, after) = (
                    curve.yield_stress(p - 1e-7).1,
                    curve.yield_stress(p + 1e-7).1,
                );
                assert!(step.slope == before || step.slope == after);
            }
        }
    }
}

#[test]
fn below_and_on_the_yield_surface_a_step_is_elastic() {
    let curve = benchmark();
    for p in [0.0, 1e-3, 0.02, 0.3, 2.0] {
        let (yield_stress, slope) = curve.yield_stress(p);
        for q_trial in [0.0, 0.5 * yield_stress, yield_stress] {
            let step = curve.return_map(q_trial, p, THREE_G);
            assert_eq!(
                (step.dp, step.yield_stress, step.slope),
                (0.0, yield_stress, slope)
            );
        }
    }
}

#[test]
fn not_a_number_in_is_not_a_number_out() {
    let curve = benchmark();
    assert!(curve.return_map(f64::NAN, 0.1, THREE_G).dp.is_nan());
    assert!(curve.return_map(300.0, f64::NAN, THREE_G).dp.is_nan());
    assert!(curve.yield_stress(f64::NAN).0.is_nan());
    assert!(curve.plastic_work(f64::NAN).is_nan());
}

#[test]
fn two_points_of_equal_stress_are_perfect_plasticity() {
    let curve = Hardening::from_points(&[(1e-3, 70.5), (1.0, 70.5)], YOUNG).unwrap();
    assert_eq!(curve.yield_stress(5.0), (70.5, 0.0));
    let step = curve.return_map(170.5, 0.0, THREE_G);
    assert!((step.dp - 100.0 / THREE_G).abs() < 1e-16);
    assert_eq!(step.yield_stress, 70.5);
}

#[test]
fn a_malformed_table_is_refused_with_the_line_to_blame() {
    let cases = [
        ("", "table is empty"),
        ("# only a comment\n", "table is empty"),
        ("strain,stress\n", "0 points; at least two"),
        ("strain,stress\n1e-3,70.5\n", "1 points; at least two"),
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
            "line 2: strain 0.001 and stress -70.5 MPa",
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
    std::fs::write(&binary, [0xff, 0xfe, 0x00]).unwrap();
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

    #[test]
    fn every_curve_that_is_read_hardens_and_returns(
        steps in prop::collection::vec((1e-6_f64..0.3, 0.0_f64..50.0), 1..8),
        q in 0.0_f64..5000.0,
        p_n in 0.0_f64..2.0,
    ) {
        let mut points = vec![(70.5 / YOUNG, 70.5)];
        let (mut p, mut stress) = (0.0, 70.5);
        for (dp, rise) in steps {
            p += dp;
            stress += rise;
            points.push((p + stress / YOUNG, stress));
        }
        let curve = Hardening::from_points(&points, YOUNG).unwrap();
        let step = curve.return_map(q, p_n, THREE_G);
        prop_assert!(step.dp >= 0.0 && step.slope >= 0.0);
        prop_assert!((curve.yield_stress(p_n + step.dp).0 - step.yield_stress).abs() < 1e-7 * step.yield_stress);
        if step.dp > 0.0 {
            prop_assert!((q - THREE_G * step.dp - step.yield_stress).abs() < 1e-11 * (1.0 + q));
        }
    }
}
