//! Voce's law: the flow stress saturates (Voce 1948, J. Inst. Metals 74, 537-562).

use std::ops::Bound;

use super::{Constant, Declaration, Hardening, Law, STRESS};

pub(super) static LAW: Declaration = Declaration {
    name: "voce",
    formula: "sigma0 + Q (1 - exp(-b p))",
    constants: &[
        Constant {
            name: "voce_sigma0",
            unit: "MPa",
            default: "194",
            range: STRESS,
            is_exponent: false,
            meaning: "With -hardening voce, sigma = sigma0 + Q (1 - exp(-b p)): sigma0, the initial yield stress.",
        },
        Constant {
            name: "voce_q",
            unit: "MPa",
            default: "240",
            range: (Bound::Included(0.0), Bound::Included(1e6)),
            is_exponent: false,
            meaning: "With -hardening voce: Q, by which the flow stress grows in all.",
        },
        Constant {
            name: "voce_b",
            unit: "",
            default: "8.25",
            range: (Bound::Excluded(0.0), Bound::Included(1e6)),
            is_exponent: false,
            meaning: "With -hardening voce: b, how fast it grows.",
        },
    ],
    build: Some(|constants, _| {
        Ok(Hardening::Voce(Voce::new(
            constants[0],
            constants[1],
            constants[2],
        )))
    }),
};

/// σ = σ₀ + Q (1 - exp(-b p)).
#[derive(Debug, Clone, PartialEq)]
pub struct Voce {
    sigma0: f64,
    q: f64,
    b: f64,
}

impl Voce {
    /// From the initial yield stress and the growth `q` >= 0 (MPa) and the rate `b` > 0.
    pub fn new(sigma0: f64, q: f64, b: f64) -> Self {
        Self { sigma0, q, b }
    }
}

impl Law for Voce {
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        let grown = -(-self.b * p).exp_m1();
        (
            self.sigma0 + self.q * grown,
            self.q * self.b * (1.0 - grown),
        )
    }

    /// σ₀ p + Q (p - (1 - exp(-b p)) / b).
    fn plastic_work(&self, p: f64) -> f64 {
        self.sigma0 * p + self.q * (p + (-self.b * p).exp_m1() / self.b)
    }
}
