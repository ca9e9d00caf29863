//! The hardening curve against direct evaluation.

use proptest::prelude::{prop, prop_assert, proptest};
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

proptest! {
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
