//! Independent reference solutions of the von Mises material: rates, not return maps.

use ssnp155::case::Case;
use ssnp155::material::{Hardening, VonMises};

/// The constants of a material, known to the reference and to the program alike.
#[derive(Clone)]
pub struct Constants {
    pub young: f64,
    pub poisson: f64,
    pub hardening: Hardening,
}

impl Constants {
    /// The benchmark's aluminium.
    pub fn aluminium() -> Self {
        let material = Case::reference().expect("the reference case").material;
        Self {
            young: material.young_modulus,
            poisson: material.poisson_ratio,
            hardening: material.hardening,
        }
    }

    /// The benchmark's elastic constants without yielding.
    pub fn elastic() -> Self {
        let Self { young, poisson, .. } = Self::aluminium();
        let points = [(10.0, 10.0 * young), (20.0, 11.0 * young)];
        Self {
            hardening: Hardening::from_points(&points, young).expect("a valid table"),
            young,
            poisson,
        }
    }

    /// Aluminium with strains `factor` times smaller at the same stress: the stiffer it is, the
    /// closer is the finite strain solution to that of small strains.
    pub fn stiffened(factor: f64) -> Self {
        let aluminium = Self::aluminium();
        let young = aluminium.young * factor;
        let points: Vec<(f64, f64)> = (0..=300)
            .map(|i| 0.004 * f64::from(i))
            .map(|p| {
                let stress = aluminium.hardening.yield_stress(p).0;
                (p / factor + stress / young, stress)
            })
            .collect();
        Self {
            young,
            poisson: aluminium.poisson,
            hardening: Hardening::from_points(&points, young).expect("a valid table"),
        }
    }

    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Young's modulus in plane strain.
    pub fn plane_modulus(&self) -> f64 {
        self.young / (1.0 - self.poisson * self.poisson)
    }

    pub fn material(&self) -> VonMises {
        VonMises::new(self.young, self.poisson, self.hardening.clone())
    }

    /// Stress and plastic strain in plane strain tension (no strain in z, no stress in y) at growing
    /// strains `at`: stress in x and z and equivalent plastic strain, by the classical Runge-Kutta
    /// method on the Prandtl-Reuss rates with steps of at most `step`.
    pub fn plane_strain_tension(&self, at: &[f64], step: f64) -> Vec<[f64; 3]> {
        let nu = self.poisson;
        let yield_ratio = (1.0 - nu + nu * nu).sqrt();
        let first_yield = self.hardening.initial() / (yield_ratio * self.plane_modulus());
        let elastic = |strain: f64| {
            let x = self.plane_modulus() * strain;
            [x, nu * x, 0.0]
        };
        let mut state = elastic(first_yield);
        let mut strain = first_yield;
        at.iter()
            .map(|&end| {
                if end <= first_yield {
                    return elastic(end);
                }
                let steps = ((end - strain) / step).ceil().max(1.0) as usize;
                let h = (end - strain) / steps as f64;
                for _ in 0..steps {
                    state = runge_kutta(&state, h, |s| self.prandtl_reuss(s));
                }
                strain = end;
                state
            })
            .collect()
    }

    /// Rates of stress in x and z and of plastic strain for a unit strain rate in x (Hill 1950, The
    /// Mathematical Theory of Plasticity, chapter II).
    fn prandtl_reuss(&self, &[x, z, p]: &[f64; 3]) -> [f64; 3] {
        let (young, nu) = (self.young, self.poisson);
        let q = (x * x - x * z + z * z).sqrt();
        let normal = [(2.0 * x - z) / (2.0 * q), (2.0 * z - x) / (2.0 * q)];
        let hardening = self.hardening.yield_stress(p).1;
        // Elastic stress rates of a strain rate (a, b) in x and z.
        let stress = |a: f64, b: f64| {
            let c = young / (1.0 - nu * nu);
            [c * (a + nu * b), c * (b + nu * a)]
        };
        let trial = stress(1.0, 0.0);
        let flow = stress(normal[0], normal[1]);
        let dot = |a: [f64; 2]| normal[0] * a[0] + normal[1] * a[1];
        let rate = dot(trial) / (hardening + dot(flow));
        [trial[0] - rate * flow[0], trial[1] - rate * flow[1], rate]
    }
}

/// One step of the classical Runge-Kutta method.
pub fn runge_kutta<const N: usize>(
    state: &[f64; N],
    h: f64,
    rate: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let moved = |by: f64, along: &[f64; N]| std::array::from_fn(|i| state[i] + by * along[i]);
    let k1 = rate(state);
    let k2 = rate(&moved(0.5 * h, &k1));
    let k3 = rate(&moved(0.5 * h, &k2));
    let k4 = rate(&moved(h, &k3));
    std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// The root of an increasing function between `low` and `high`.
pub fn bisect(mut low: f64, mut high: f64, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if value(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
