//! Every hardening law against itself and against the others.

use proptest::prelude::{prop, prop_assert, proptest};
use ssnp155::material::hardening::{Declaration, Hardening, LAWS, law_named};

const YOUNG: f64 = 70500.0;
/// Three times the shear modulus of the benchmark's aluminium, MPa.
const THREE_G: f64 = 3.0 * YOUNG / (2.0 * 1.342);

/// A law with these constants.
fn law(name: &str, constants: &[f64]) -> Hardening {
    law_named(name).unwrap().build.unwrap()(constants, YOUNG).unwrap()
}

fn defaults(law: &Declaration) -> Vec<f64> {
    let of = |text: &str| text.parse::<f64>().unwrap();
    law.constants.iter().map(|c| of(c.default)).collect()
}

/// Every law with its default constants, by name.
fn all() -> Vec<(&'static str, Hardening)> {
    LAWS.iter()
        .map(|law| match law.build {
            Some(build) => (law.name, build(&defaults(law), YOUNG).unwrap()),
            None => (law.name, Hardening::benchmark(YOUNG).unwrap()),
        })
        .collect()
}

/// Plastic strains over many orders of magnitude, with zero.
fn strains() -> impl Iterator<Item = f64> {
    (-120..=20)
        .map(|k| 10_f64.powf(0.1 * f64::from(k)))
        .chain([0.0])
}

/// Integral by Gauss's rule of five points on many pieces, finer towards the start.
fn integral(value: impl Fn(f64) -> f64, end: f64) -> f64 {
    const PIECES: i32 = 4000;
    let at = |i: i32| end * (f64::from(i) / f64::from(PIECES)).powi(3);
    let (near, far) = (
        (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
        (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
    );
    let root = 13.0 * 70.0_f64.sqrt();
    let rule = [
        (0.0, 128.0 / 225.0),
        (near, (322.0 + root) / 900.0),
        (-near, (322.0 + root) / 900.0),
        (far, (322.0 - root) / 900.0),
        (-far, (322.0 - root) / 900.0),
    ];
    (0..PIECES)
        .map(|i| {
            let (middle, half) = (0.5 * (at(i) + at(i + 1)), 0.5 * (at(i + 1) - at(i)));
            let piece = rule.map(|(x, weight)| weight * value(middle + half * x));
            half * piece.iter().sum::<f64>()
        })
        .sum()
}

#[test]
fn the_words_of_the_laws_are_these() {
    let names: Vec<&str> = LAWS.iter().map(|law| law.name).collect();
    for name in [
        "table",
        "hollomon",
        "hollomon_total",
        "swift",
        "voce",
        "linear",
    ] {
        assert!(names.contains(&name), "{name}");
    }
}

#[test]
fn slope_is_the_derivative_and_work_the_integral_and_stress_never_falls() {
    for (name, law) in all() {
        let kink = |p: f64| {
            let (before, after) = (law.yield_stress(0.999 * p).1, law.yield_stress(1.001 * p).1);
            (before - after).abs() > 0.02 * (before + after)
        };
        let mut last = law.initial();
        for p in strains().filter(|&p| p > 0.0) {
            let (stress, slope) = law.yield_stress(p);
            assert!(stress.is_finite() && slope.is_finite() && slope >= 0.0);
            if kink(p) || p < 1e-6 {
                continue;
            }
            let h = 1e-4 * p;
            let difference = (law.yield_stress(p + h).0 - law.yield_stress(p - h).0) / (2.0 * h);
            let rounding = 1e-15 * stress / h;
            assert!(
                (difference - slope).abs() < 1e-6 * slope + 4.0 * rounding,
                "{name}, slope at {p}: {slope} {difference}"
            );
        }
        for p in [1e-4, 3e-3, 0.02, 0.4, 2.0] {
            let (exact, quadrature) = (law.plastic_work(p), integral(|p| law.yield_stress(p).0, p));
            assert!(
                (exact - quadrature).abs() < 1e-9 * exact,
                "{name}, work at {p}: {exact} {quadrature}"
            );
            assert!(law.yield_stress(p).0 >= last, "{name} at {p}");
            last = law.yield_stress(p).0;
        }
        assert_eq!(law.plastic_work(0.0), 0.0, "{name}");
    }
}

#[test]
fn the_return_ends_on_the_law_to_rounding() {
    for (name, law) in all() {
        for p_n in strains() {
            let start = law.yield_stress(p_n).0;
            assert_eq!(law.return_map(start, p_n, THREE_G).dp, 0.0, "{name}");
            let mut last = 0.0;
            for exponent in -120..=40 {
                let q_trial = start * (1.0 + 10_f64.powf(0.1 * f64::from(exponent)));
                let step = law.return_map(q_trial, p_n, THREE_G);
                let (stress, slope) = law.yield_stress(p_n + step.dp);
                let residual = q_trial - THREE_G * step.dp - step.yield_stress;
                assert!(
                    residual.abs() < 1e-14 * q_trial && step.dp > 0.0,
                    "{name} from {p_n} at {q_trial}: {residual}, {step:?}"
                );
                assert!(
                    (stress - step.yield_stress).abs() < 1e-13 * q_trial,
                    "{name}"
                );
                assert!(
                    (slope - step.slope).abs() <= 1e-9 * slope.max(step.slope),
                    "{name}"
                );
                assert!(step.dp >= last * (1.0 - 1e-12), "{name} is not monotone");
                last = step.dp;
            }
        }
    }
}

#[test]
fn a_law_from_any_corner_of_its_ranges_returns_or_is_refused() {
    let mut built = 0;
    for declaration in LAWS {
        let Some(build) = declaration.build else {
            continue;
        };
        let choices: Vec<[f64; 3]> = declaration
            .constants
            .iter()
            .map(|constant| {
                let bound = |bound: std::ops::Bound<f64>, inwards: f64| match bound {
                    std::ops::Bound::Included(value) => value,
                    std::ops::Bound::Excluded(0.0) => 1e-300,
                    std::ops::Bound::Excluded(value) => value * inwards,
                    std::ops::Bound::Unbounded => unreachable!("every constant has a range"),
                };
                [
                    bound(constant.range.0, 1.0 + 1e-12),
                    constant.default.parse().unwrap(),
                    bound(constant.range.1, 1.0 - 1e-12),
                ]
            })
            .collect();
        for corner in 0..3_usize.pow(choices.len() as u32) {
            let constants: Vec<f64> = (0..choices.len())
                .map(|i| choices[i][corner / 3_usize.pow(i as u32) % 3])
                .collect();
            let law = match build(&constants, YOUNG) {
                Ok(law) => law,
                Err(error) => {
                    assert_eq!(error.to_string().lines().count(), 1);
                    continue;
                }
            };
            built += 1;
            let initial = law.initial();
            assert!(initial > 0.0 && initial.is_finite(), "{law:?}");
            for p_n in [0.0, 1e-12, 1e-3, 1.0, 1e3] {
                for q in [0.0, 0.5, 1.0 + 1e-12, 2.0, 1e3, 1e9].map(|factor| factor * initial) {
                    let step = law.return_map(q, p_n, THREE_G);
                    let numbers = [
                        step.dp,
                        step.yield_stress,
                        step.slope,
                        law.plastic_work(p_n),
                    ];
                    assert!(
                        numbers.iter().all(|x| x.is_finite() && *x >= 0.0),
                        "{law:?} from {p_n} at {q}: {numbers:?}"
                    );
                    let residual = q - THREE_G * step.dp - step.yield_stress;
                    assert!(
                        step.dp == 0.0 || residual.abs() < 1e-12 * q,
                        "{law:?} from {p_n} at {q}: {residual}, {step:?}"
                    );
                }
            }
        }
    }
    assert!(built > 50, "{built}");
}

#[test]
fn hollomon_in_plastic_strain_is_the_law_the_benchmarks_table_is_made_of() {
    let (hollomon, table) = (
        law("hollomon", &[550.4, 0.223, 194.0]),
        Hardening::benchmark(YOUNG).unwrap(),
    );
    assert_eq!(hollomon.initial(), 194.0);
    for p in [0.02, 0.04, 0.06, 0.1, 0.2, 0.5, 1.0] {
        let (law, table) = (hollomon.yield_stress(p).0, table.yield_stress(p).0);
        assert!((law - table).abs() < 2e-3, "at {p}: {law} {table}");
    }
}

#[test]
fn hollomon_in_total_strain_lies_on_its_curve_and_yields_on_the_elastic_line() {
    for n in [0.05, 0.223, 0.5, 0.7] {
        let total = law("hollomon_total", &[550.4, n]);
        let initial = total.initial();
        assert!((550.4 * (initial / YOUNG).powf(n) - initial).abs() < 1e-12 * initial);
        for p in strains() {
            let stress = total.yield_stress(p).0;
            let on_the_curve = 550.4 * (p + stress / YOUNG).powf(n);
            assert!((stress - on_the_curve).abs() < 1e-13 * stress, "{n} {p}");
        }
    }
}

#[test]
fn a_stiff_hollomon_in_total_strain_is_the_one_in_plastic_strain() {
    // The elastic strain is what distinguishes them.
    let build = law_named("hollomon_total").unwrap().build.unwrap();
    let total = build(&[550.4, 0.223], 1e7).unwrap();
    let plastic = law("hollomon", &[550.4, 0.223, total.initial()]);
    for p in [0.01, 0.1, 1.0] {
        let (a, b) = (total.yield_stress(p).0, plastic.yield_stress(p).0);
        let elastic_strain = b / 1e7;
        assert!(
            (a - b - plastic.yield_stress(p).1 * elastic_strain).abs()
                < 1e-4 * (a - b).abs() + 1e-4
        );
    }
}

#[test]
fn swift_is_hollomon_shifted_by_its_strain() {
    let (k, n, eps0) = (550.4, 0.223, 9.4e-3);
    let swift = law("swift", &[k, eps0, n]);
    let hollomon = law("hollomon", &[k, n, 0.99 * k * eps0.powf(n)]);
    for p in strains() {
        let ((a, slope_a), (b, slope_b)) = (swift.yield_stress(p), hollomon.yield_stress(eps0 + p));
        assert!(
            (a - b).abs() < 1e-12 * a && (slope_a - slope_b).abs() < 1e-9 * slope_a,
            "{p}"
        );
        let (a, b) = (
            swift.plastic_work(p),
            hollomon.plastic_work(eps0 + p) - hollomon.plastic_work(eps0),
        );
        assert!((a - b).abs() < 1e-12 * (1.0 + a), "{p}: {a} {b}");
    }
}

#[test]
fn voce_with_a_slow_rate_is_linear_with_the_slope_q_b() {
    let (sigma0, slope, b) = (194.0, 800.0, 1e-6);
    let voce = law("voce", &[sigma0, slope / b, b]);
    for p in [0.0, 1e-3, 0.1, 1.0] {
        let expected = sigma0 + slope * p;
        // The next term of the exponential's series.
        let rest = 0.5 * slope * b * p * p;
        assert!((voce.yield_stress(p).0 - expected + rest).abs() < 1e-9);
        let step = voce.return_map(expected + THREE_G * p, 0.0, THREE_G);
        assert!((step.dp - p).abs() < 1e-8);
    }
}

#[test]
fn linear_is_a_table_of_two_points_and_voce_with_a_slow_rate_and_swift_with_the_exponent_one() {
    let (sigma0, slope) = (194.0, 1800.0);
    let linear = law("linear", &[sigma0, slope]);
    let points = [0.0, 1.0].map(|p| {
        let stress = sigma0 + slope * p;
        (p + stress / YOUNG, stress)
    });
    let table = Hardening::from_points(&points, YOUNG).unwrap();
    let voce = law("voce", &[sigma0, slope / 1e-10, 1e-10]);
    let swift = law("swift", &[slope, sigma0 / slope, 1.0]);
    for p_n in [0.0, 1e-6, 0.02, 0.5, 3.0] {
        for q in [100.0, 195.0, 300.0, 1e4] {
            let exact = linear.return_map(q, p_n, THREE_G);
            for other in [&table, &voce, &swift] {
                let step = other.return_map(q, p_n, THREE_G);
                assert!(
                    (step.dp - exact.dp).abs() < 1e-8 * exact.dp + 1e-12,
                    "{other:?}: {step:?}"
                );
                assert!(
                    (step.yield_stress - exact.yield_stress).abs() < 1e-5,
                    "{other:?}"
                );
                assert!((step.slope - exact.slope).abs() < 1e-4, "{other:?}");
            }
        }
        let works = [&table, &voce, &swift].map(|other| other.plastic_work(p_n));
        for work in works {
            assert!(
                (work - linear.plastic_work(p_n)).abs() < 1e-5 * (1.0 + work),
                "{works:?}"
            );
        }
    }
}

#[test]
fn not_a_number_in_is_not_a_number_out_of_any_law() {
    for (name, law) in all() {
        assert!(law.return_map(f64::NAN, 0.1, THREE_G).dp.is_nan(), "{name}");
        assert!(
            law.return_map(300.0, f64::NAN, THREE_G).dp.is_nan(),
            "{name}"
        );
        assert!(law.yield_stress(f64::NAN).0.is_nan(), "{name}");
        assert!(law.plastic_work(f64::NAN).is_nan(), "{name}");
    }
}

/// Points of a table (total strain, stress) on a law, denser towards the start.
fn sampled(law: &Hardening, count: i32) -> Hardening {
    let points: Vec<(f64, f64)> = (0..=count)
        .map(|i| (f64::from(i) / f64::from(count)).powi(3))
        .map(|p| {
            let stress = law.yield_stress(p).0;
            (p + stress / YOUNG, stress)
        })
        .collect();
    Hardening::from_points(&points, YOUNG).unwrap()
}

#[test]
fn a_fine_table_sampled_from_a_law_comes_to_the_law_with_second_order() {
    for (name, law) in all() {
        let distance = |count: i32| {
            let table = sampled(&law, count);
            let probe = |p_n: f64, rise: f64| {
                let q = law.yield_stress(p_n).0 + rise;
                let (a, b) = (
                    law.return_map(q, p_n, THREE_G),
                    table.return_map(q, p_n, THREE_G),
                );
                (a.yield_stress - b.yield_stress).abs()
            };
            let mut worst = 0.0_f64;
            for i in 0..200 {
                let p = 0.9 * (f64::from(i) / 200.0).powi(3);
                worst = worst.max(probe(p, 30.0)).max(probe(p, 3000.0));
                let work = (law.plastic_work(p) - table.plastic_work(p)).abs();
                assert!(
                    work < 2e-3 * law.plastic_work(p) + 1e-3,
                    "{name}: {work} at {p}"
                );
            }
            worst
        };
        let (coarse, fine) = (distance(500), distance(4000));
        assert!(fine < 0.02, "{name}: {fine}");
        // A kink of the law is met with first order only.
        assert!(
            fine < coarse / 4.0 || fine < 1e-4,
            "{name}: {coarse} {fine}"
        );
    }
}

proptest! {
    #[test]
    fn any_law_within_its_ranges_returns_to_rounding(
        which in 0..LAWS.len(),
        shares in prop::collection::vec(0.0_f64..1.0, 4),
        q in 0.0_f64..1e5,
        p_n in 0.0_f64..3.0,
    ) {
        let declaration = LAWS[which];
        let Some(build) = declaration.build else {
            return Ok(());
        };
        // Constants from a third to three times their defaults, within their ranges.
        let constants: Vec<f64> = declaration
            .constants
            .iter()
            .zip(shares)
            .map(|(constant, share)| {
                let value = constant.default.parse::<f64>().unwrap() * 9_f64.powf(share - 0.5);
                if constant.range.1 == std::ops::Bound::Excluded(1.0) { value.min(0.99) } else { value }
            })
            .collect();
        let Ok(law) = build(&constants, YOUNG) else {
            return Ok(());
        };
        let step = law.return_map(q, p_n, THREE_G);
        prop_assert!(step.dp >= 0.0 && step.slope >= 0.0 && step.yield_stress > 0.0);
        if step.dp > 0.0 {
            prop_assert!((q - THREE_G * step.dp - step.yield_stress).abs() < 1e-14 * q);
            prop_assert!((law.yield_stress(p_n + step.dp).0 - step.yield_stress).abs() < 1e-12 * q);
        }
    }
}
