//! Hollomon's law in the plastic strain, with an elastic limit (Hollomon 1945, Trans. AIME 162, 268-290).

use std::ops::Bound;

use super::{Constant, Declaration, Hardening, ImpossibleLaw, Law, STEEPEST, STRESS};

pub(super) static LAW: Declaration = Declaration {
    name: "hollomon",
    formula: "max(elastic_limit, K p^n)",
    constants: &[
        K,
        N,
        Constant {
            name: "hollomon_elastic_limit",
            unit: "MPa",
            default: "194",
            range: STRESS,
            is_exponent: false,
            meaning: "With -hardening hollomon: initial yield stress; the flow stress stays at it until K p^n exceeds it.",
        },
    ],
    build: Some(|constants, _| {
        Hollomon::new(constants[0], constants[1], constants[2]).map(Hardening::Hollomon)
    }),
};

/// Shared by both readings of the law.
pub(super) const K: Constant = Constant {
    name: "hollomon_k",
    unit: "MPa",
    default: "550.4",
    range: STRESS,
    is_exponent: false,
    meaning: "K of Hollomon's law: sigma = K p^n above -hollomon_elastic_limit with -hardening hollomon, where p is the \
              plastic strain; sigma = K eps^n with -hardening hollomon_total, where eps is the total logarithmic strain.",
};
pub(super) const N: Constant = Constant {
    name: "hollomon_n",
    unit: "",
    default: "0.223",
    range: (Bound::Included(1e-3), Bound::Excluded(1.0)),
    is_exponent: true,
    meaning: "n of Hollomon's law, with -hardening hollomon or hollomon_total.",
};

/// σ = max(σ₀, K pⁿ).
///
/// K pⁿ alone begins at zero with an infinite slope. The elastic limit σ₀ cuts this off: the flow stress is σ₀ up to
/// p₀ = (σ₀/K)^(1/n) and K pⁿ from there on, with a kink between.
#[derive(Debug, Clone, PartialEq)]
pub struct Hollomon {
    k: f64,
    n: f64,
    elastic_limit: f64,
    /// Plastic strain p₀ at which the power law takes over.
    takes_over: f64,
}

impl Hollomon {
    /// From K and the elastic limit (MPa) and the exponent 0 < `n` < 1.
    ///
    /// # Errors
    /// The power law is too steep where it takes over.
    pub fn new(k: f64, n: f64, elastic_limit: f64) -> Result<Self, ImpossibleLaw> {
        let takes_over = (elastic_limit / k).powf(n.recip());
        let slope = n * elastic_limit / takes_over;
        if slope > STEEPEST || slope.is_nan() {
            return Err(ImpossibleLaw {
                law: LAW.name,
                problem: format!(
                    "K p^n exceeds the elastic limit of {elastic_limit} MPa from a plastic strain of {takes_over:.1e} on, \
                     with a slope of {slope:.1e} MPa there, and at most {STEEPEST:e} MPa can be computed with; use a larger \
                     -hollomon_elastic_limit or -hollomon_n"
                ),
            });
        }
        Ok(Self {
            k,
            n,
            elastic_limit,
            takes_over,
        })
    }
}

impl Law for Hollomon {
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        if p < self.takes_over {
            return (self.elastic_limit, 0.0);
        }
        // At the kink rounding may leave the power law below the limit.
        let stress = self.k * p.powf(self.n);
        (
            if stress < self.elastic_limit {
                self.elastic_limit
            } else {
                stress
            },
            self.n * stress / p,
        )
    }

    /// σ₀ p₀ + K (pⁿ⁺¹ - p₀ⁿ⁺¹) / (n + 1) beyond p₀.
    fn plastic_work(&self, p: f64) -> f64 {
        if p < self.takes_over {
            return self.elastic_limit * p;
        }
        let up_to = |p: f64| self.k * p.powf(self.n + 1.0) / (self.n + 1.0);
        self.elastic_limit * self.takes_over + (up_to(p) - up_to(self.takes_over))
    }
}
