//! Hollomon's law in the total logarithmic strain (Hollomon 1945, Trans. AIME 162, 268-290).

use super::hollomon::{K, N};
use super::{Declaration, Hardening, ImpossibleLaw, Law};

pub(super) static LAW: Declaration = Declaration {
    name: "hollomon_total",
    formula: "K eps^n with eps = p + sigma/E",
    constants: &[K, N],
    build: Some(|constants, young| {
        HollomonTotal::new(constants[0], constants[1], young).map(Hardening::HollomonTotal)
    }),
};

/// σ = K εⁿ with the total logarithmic strain ε = p + σ/E, from the strain ε₀ = (K/E)^(1/(1-n)) on at which it meets the
/// elastic line: that is where the material yields first.
#[derive(Debug, Clone, PartialEq)]
pub struct HollomonTotal {
    k: f64,
    n: f64,
    young: f64,
    /// Total strain ε₀ at first yield.
    yield_strain: f64,
}

/// Strains at first yield between which the law makes sense; they bound its slope as well.
const YIELD_STRAINS: std::ops::RangeInclusive<f64> = 1e-9..=1.0;
/// Newton's method for the total strain converges quadratically.
const MOST_ITERATIONS: usize = 100;

impl HollomonTotal {
    /// From K and Young's modulus (MPa) and the exponent 0 < `n` < 1.
    ///
    /// # Errors
    /// The power law meets the elastic line at a strain that is no yield strain.
    pub fn new(k: f64, n: f64, young: f64) -> Result<Self, ImpossibleLaw> {
        let yield_strain = (k / young).powf((1.0 - n).recip());
        if !YIELD_STRAINS.contains(&yield_strain) {
            return Err(ImpossibleLaw {
                law: LAW.name,
                problem: format!(
                    "K eps^n meets the elastic line of E {young} MPa at a strain of {yield_strain:.1e}, and a yield strain \
                     lies between {:e} and {}; change -hollomon_k, -hollomon_n or -young_modulus",
                    YIELD_STRAINS.start(),
                    YIELD_STRAINS.end()
                ),
            });
        }
        Ok(Self {
            k,
            n,
            young,
            yield_strain,
        })
    }

    /// The total strain ε with ε - K εⁿ/E = `p`.
    ///
    /// The left side is convex and rises with a slope of at least 1 - n from ε₀ on. So the root is not above
    /// ε₀ + p/(1-n), and from there Newton's method comes down to it without overshooting.
    fn total_strain(&self, p: f64) -> f64 {
        let mut strain = self.yield_strain + p / (1.0 - self.n);
        for _ in 0..MOST_ITERATIONS {
            let elastic = self.k * strain.powf(self.n) / self.young;
            let excess = strain - elastic - p;
            let next = strain - excess / (1.0 - self.n * elastic / strain);
            // At the root rounding ends the descent.
            if next < strain && next > self.yield_strain {
                strain = next;
            } else {
                break;
            }
        }
        strain
    }
}

impl Law for HollomonTotal {
    /// With the tangent modulus E_t = n σ/ε the slope by p = ε - σ/E is E_t / (1 - E_t/E).
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        let strain = self.total_strain(p);
        let stress = self.k * strain.powf(self.n);
        let tangent = self.n * stress / strain;
        (stress, tangent / (1.0 - tangent / self.young))
    }

    /// ∫ σ dp = ∫ σ d(ε - σ/E) = K (εⁿ⁺¹ - ε₀ⁿ⁺¹)/(n + 1) - (σ² - σ₀²)/(2 E).
    fn plastic_work(&self, p: f64) -> f64 {
        let up_to = |strain: f64| {
            let stress = self.k * strain.powf(self.n);
            stress * (strain / (self.n + 1.0) - 0.5 * stress / self.young)
        };
        up_to(self.total_strain(p)) - up_to(self.yield_strain)
    }
}
