//! The von Mises material with every hardening law: consistency, tangent, energy, objectivity, and nothing but finite
//! numbers or a refusal. No PETSc: seconds.

mod common;

use common::Noise;
use proptest::prelude::{prop, prop_assert, proptest};
use ssnp155::element::{ElementForce, Quad8, Quadrature};
use ssnp155::material::hardening::LAWS;
use ssnp155::material::{DeformationError, Hardening, PointState, Response, VonMises};
use ssnp155::plane::{Matrix, PlaneTensor};

const YOUNG: f64 = 70500.0;
const POISSON: f64 = 0.342;

/// The benchmark's elasticity with every law at its defaults, by name.
fn materials() -> Vec<(&'static str, VonMises)> {
    LAWS.iter()
        .map(|law| {
            let constants: Vec<f64> = law
                .constants
                .iter()
                .map(|constant| constant.default.parse().unwrap())
                .collect();
            let hardening = match law.build {
                Some(build) => build(&constants, YOUNG).unwrap(),
                None => Hardening::benchmark(YOUNG).unwrap(),
            };
            (law.name, VonMises::new(YOUNG, POISSON, hardening))
        })
        .collect()
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

fn turn(angle: f64) -> Matrix {
    let (sin, cos) = angle.sin_cos();
    [[cos, -sin], [sin, cos]]
}

/// A deformation with stretches and shear of `size`, turned.
fn deformation(size: f64, noise: &mut Noise) -> Matrix {
    let mut one = || size * noise.next();
    let stretched = [[1.0 + one(), one()], [one(), 1.0 + one()]];
    product(&turn(0.7), &stretched)
}

/// States of a point that never yielded and of one that did.
fn states(material: &VonMises) -> [PointState; 2] {
    let mut noise = Noise::new(21);
    let yielded = material
        .respond(&deformation(0.1, &mut noise), &PointState::VIRGIN)
        .unwrap()
        .state();
    assert!(yielded.equivalent_plastic_strain > 0.01);
    [PointState::VIRGIN, yielded]
}

fn equivalent(stress: &PlaneTensor) -> f64 {
    let mean = (stress.xx + stress.yy + stress.zz) / 3.0;
    let [xx, yy, zz, xy] = stress.components();
    let squares = [xx, yy, zz].map(|s| (s - mean).powi(2));
    (1.5 * (squares.iter().sum::<f64>() + 2.0 * xy * xy)).sqrt()
}

#[test]
fn a_plastic_step_ends_on_the_yield_surface_and_an_elastic_one_within() {
    for (name, material) in materials() {
        let mut noise = Noise::new(1);
        let (mut plastic, mut elastic) = (0, 0);
        for state in states(&material) {
            for k in 0..400 {
                let f = deformation(1e-4 * 1.02_f64.powi(k), &mut noise);
                let response = material.respond(&f, &state).unwrap();
                let p = response.state().equivalent_plastic_strain;
                let excess =
                    equivalent(&response.kirchhoff) - material.hardening().yield_stress(p).0;
                if p > state.equivalent_plastic_strain {
                    plastic += 1;
                    assert!(excess.abs() < 1e-9, "{name}: {excess}");
                } else {
                    elastic += 1;
                    assert!(excess < 1e-9, "{name}: {excess}");
                }
                // Plastic flow keeps the volume: det C_p = 1.
                let c = response.state().cp_inverse;
                let determinant = (c.xx * c.yy - c.xy * c.xy) * c.zz;
                assert!((determinant - 1.0).abs() < 1e-10, "{name}: {determinant}");
            }
        }
        assert!(plastic > 50 && elastic > 50, "{name}: {plastic} {elastic}");
    }
}

/// Rate of the Kirchhoff stress for the velocity gradient `l`, by the tangent: c d + l τ + τ lᵀ (xx, yy, xy).
fn stress_rate(response: &Response, l: &Matrix) -> [f64; 3] {
    let d = [l[0][0], l[1][1], l[0][1] + l[1][0]];
    let tau = response.kirchhoff.in_plane().rows();
    let lt = product(l, &tau);
    let convected = [2.0 * lt[0][0], 2.0 * lt[1][1], lt[0][1] + lt[1][0]];
    let lie = response
        .tangent()
        .map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
    [0, 1, 2].map(|i| lie[i] + convected[i])
}

#[test]
fn the_tangent_is_the_derivative_of_the_stress() {
    for (name, material) in materials() {
        let mut noise = Noise::new(3);
        for state in states(&material) {
            for size in [1e-5, 1e-3, 0.02, 0.3] {
                let f = deformation(size, &mut noise);
                let response = material.respond(&f, &state).unwrap();
                for component in 0..4 {
                    let mut l = [[0.0; 2]; 2];
                    l[component / 2][component % 2] = 1.0;
                    let h = 1e-6;
                    let at = |h: f64| {
                        let mut step = [[1.0, 0.0], [0.0, 1.0]];
                        step[component / 2][component % 2] += h;
                        material
                            .respond(&product(&step, &f), &state)
                            .unwrap()
                            .kirchhoff
                    };
                    let (up, down) = (at(h), at(-h));
                    let exact = stress_rate(&response, &l);
                    let slopes = [up.xx - down.xx, up.yy - down.yy, up.xy - down.xy];
                    for (exact, slope) in exact.iter().zip(slopes.map(|s| s / (2.0 * h))) {
                        assert!(
                            (exact - slope).abs() < 2e-6 * YOUNG,
                            "{name} {size} l[{component}]: {exact} {slope}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn stored_and_dissipated_energy_are_the_work_of_the_stress() {
    for (name, material) in materials() {
        let path = |t: f64| [[1.0 + 0.1 * t, 0.15 * t], [-0.05 * t, 1.0 - 0.06 * t * t]];
        let imbalance = |steps: i32| {
            let mut state = PointState::VIRGIN;
            let (mut before, mut work, mut energy) = (PlaneTensor::default(), 0.0, 0.0);
            for step in 0..steps {
                let [t, end] = [step, step + 1].map(|s| f64::from(s) / f64::from(steps));
                let (f, next) = (path(t), path(end));
                let response = material.respond(&next, &state).unwrap();
                // Mean stress times the increment of F in the middle of the step, P : ΔF with P = τ F⁻ᵀ.
                let middle = path(0.5 * (t + end));
                let determinant = middle[0][0] * middle[1][1] - middle[0][1] * middle[1][0];
                let inverse = [
                    [middle[1][1] / determinant, -middle[0][1] / determinant],
                    [-middle[1][0] / determinant, middle[0][0] / determinant],
                ];
                let increment = [0, 1].map(|i| [0, 1].map(|j| next[i][j] - f[i][j]));
                let l = product(&increment, &inverse);
                let now = response.kirchhoff;
                work += 0.5 * (before.xx + now.xx) * l[0][0]
                    + 0.5 * (before.yy + now.yy) * l[1][1]
                    + 0.5 * (before.xy + now.xy) * (l[0][1] + l[1][0]);
                before = now;
                state = response.state();
                let p = state.equivalent_plastic_strain;
                energy = response.elastic_energy() + material.hardening().plastic_work(p);
            }
            (work - energy) / energy
        };
        let (coarse, fine) = (imbalance(500), imbalance(1000));
        assert!(fine.abs() < 2e-3, "{name}: {fine}");
        assert!(
            fine.abs() < 0.6 * coarse.abs() || fine.abs() < 1e-5,
            "{name}: {coarse} {fine}"
        );
    }
}

#[test]
fn a_rotation_turns_the_stress_and_leaves_the_state() {
    for (name, material) in materials() {
        let mut noise = Noise::new(5);
        for state in states(&material) {
            for size in [1e-4, 0.05, 0.4] {
                let f = deformation(size, &mut noise);
                let r = turn(2.3);
                let (a, b) = (
                    material.respond(&f, &state).unwrap(),
                    material.respond(&product(&r, &f), &state).unwrap(),
                );
                let transposed = turn(-2.3);
                let turned = product(&product(&r, &a.kirchhoff.in_plane().rows()), &transposed);
                let b_plane = b.kirchhoff.in_plane().rows();
                for i in 0..2 {
                    for j in 0..2 {
                        assert!((turned[i][j] - b_plane[i][j]).abs() < 1e-8, "{name}");
                    }
                }
                assert!((a.kirchhoff.zz - b.kirchhoff.zz).abs() < 1e-8, "{name}");
                let pairs = a
                    .state()
                    .cp_inverse
                    .components()
                    .into_iter()
                    .zip(b.state().cp_inverse.components());
                assert!(
                    pairs.into_iter().all(|(x, y)| (x - y).abs() < 1e-11),
                    "{name}"
                );
                let p = [a, b].map(|response| response.state().equivalent_plastic_strain);
                assert!((p[0] - p[1]).abs() < 1e-12, "{name}");
            }
        }
    }
}

fn all_finite(response: &Response) -> bool {
    let state = response.state();
    let tangent = response.tangent();
    let numbers = response
        .kirchhoff
        .components()
        .into_iter()
        .chain(state.cp_inverse.components())
        .chain(tangent.into_iter().flatten())
        .chain([state.equivalent_plastic_strain, response.elastic_energy()]);
    numbers.into_iter().all(f64::is_finite)
}

#[test]
fn no_law_allocates() {
    for (name, material) in materials() {
        let [_, state] = states(&material);
        let f = deformation(0.2, &mut Noise::new(9));
        let counted = allocation_counter::measure(|| {
            let response = material.respond(&f, &state).unwrap();
            std::hint::black_box((
                response.tangent(),
                response.state(),
                response.elastic_energy(),
            ));
            std::hint::black_box(material.hardening().plastic_work(0.1));
        });
        assert_eq!(counted.count_total, 0, "{name}");
    }
}

#[test]
fn a_determinant_that_is_tiny_zero_negative_or_none_is_refused_and_says_which() {
    for (name, material) in materials() {
        let respond = |f: Matrix| material.respond(&f, &PointState::VIRGIN);
        for f in [
            [[1e-160, 0.0], [0.0, 1e-160]],
            [[1.0, 0.0], [0.0, 1e-300]],
            [[1.0, 1.0], [1.0, 1.0 + 2.3e-16]],
            [[1e200, 0.0], [0.0, 1e-200]],
            [[1e160, 0.0], [0.0, 1e160]],
            [[f64::NAN, 0.0], [0.0, 1.0]],
            [[f64::INFINITY, 0.0], [0.0, 1.0]],
        ] {
            match respond(f) {
                // A nearly singular one may still be within bounds.
                Ok(response) => assert!(all_finite(&response), "{name} {f:?}"),
                Err(error) => {
                    assert!(
                        matches!(error, DeformationError::Unbounded { .. }),
                        "{name} {f:?}"
                    );
                    assert!(error.to_string().contains("determinant"));
                }
            }
        }
        for f in [
            [[1.0, 0.0], [0.0, -1.0]],
            [[1.0, 1.0], [1.0, 1.0]],
            [[0.0; 2]; 2],
        ] {
            let refused = respond(f).unwrap_err();
            assert!(
                matches!(refused, DeformationError::Inverted { .. }),
                "{name} {f:?}"
            );
        }
        assert!(respond([[1e-160, 0.0], [0.0, 1e-160]]).is_err(), "{name}");
    }
}

#[test]
fn an_element_names_the_gauss_point_that_fails() {
    let (_, material) = materials().swap_remove(0);
    let nodes = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [1.0, 0.5],
        [0.5, 1.0],
        [0.0, 0.5],
    ];
    let kernel = Quad8::new(&nodes, Quadrature::Reduced);
    let states = [PointState::VIRGIN; 4];
    let mut out = ElementForce::ZERO;
    // Pressed flat: the determinant is zero to rounding, on either side of it.
    let pressed = nodes.map(|[_, y]| [0.0, -y]);
    let error = kernel
        .internal_force(&pressed, &material, &states, false, &mut out)
        .unwrap_err();
    assert!(error.to_string().starts_with("Gauss point "), "{error}");
    // One corner is moved over the opposite one: only the Gauss point near it is inverted.
    let mut folded = [[0.0; 2]; 8];
    folded[2] = [-0.8, -0.8];
    let error = kernel
        .internal_force(&folded, &material, &states, false, &mut out)
        .unwrap_err();
    assert_eq!(error.point, 3);
    assert!(
        error
            .to_string()
            .contains("Gauss point 3: the element is inverted"),
        "{error}"
    );
}

proptest! {
    #[test]
    fn every_response_is_finite_or_refused(
        which in 0..LAWS.len(),
        exponents in prop::array::uniform4(-320.0_f64..308.0),
        mantissas in prop::array::uniform4(-1.0_f64..1.0),
        narrow in prop::bool::ANY,
        before in prop::bool::ANY,
    ) {
        let (_, material) = materials().swap_remove(which);
        let state = states(&material)[usize::from(before)];
        // Numbers of any size, or of the sizes between which a response is refused or not.
        let size = |i: usize| if narrow { exponents[i] / 10.0 } else { exponents[i] };
        let entry = |i: usize| mantissas[i] * 10_f64.powf(size(i));
        let f = [[entry(0), entry(1)], [entry(2), entry(3)]];
        if let Ok(response) = material.respond(&f, &state) {
            prop_assert!(all_finite(&response), "{f:?}");
            // What was committed can be continued.
            let next = product(&f, &[[1.1, 0.2], [-0.1, 0.9]]);
            if let Ok(response) = material.respond(&next, &response.state()) {
                prop_assert!(all_finite(&response), "{next:?}");
            }
        }
    }
}
