//! Shared by the tests: a material, a small problem, and numbers that look random.

#![allow(dead_code)]

use ssnp155::case::Case;
use ssnp155::material::VonMises;
use ssnp155::system::Problem;

/// Deterministic noise between -1 and 1 (a linear congruential generator, Knuth's MMIX constants).
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The benchmark's aluminium.
pub fn aluminium() -> VonMises {
    let case = Case::reference().unwrap();
    VonMises::new(
        case.material.young_modulus,
        case.material.poisson_ratio,
        case.material.hardening,
    )
}

/// The benchmark on a coarse mesh of a short sheet.
pub fn small_problem(nx: usize, ny: usize) -> Problem {
    let mut case = Case::reference().unwrap();
    case.discretisation.nx = nx;
    case.discretisation.ny = ny;
    case.discretisation.contact_points_per_edge = 3;
    Problem::new(&case)
}
