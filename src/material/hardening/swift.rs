//! Swift's law (Swift 1952, J. Mech. Phys. Solids 1, 1-18).

use std::ops::Bound;

use super::{Constant, Declaration, Hardening, Law, STRESS};

pub(super) static LAW: Declaration = Declaration {
    name: "swift",
    formula: "K (eps0 + p)^n",
    constants: &[
        Constant {
            name: "swift_k",
            unit: "MPa",
            default: "550.4",
            range: STRESS,
            is_exponent: false,
            meaning: "With -hardening swift, sigma = K (eps0 + p)^n: K.",
        },
        Constant {
            name: "swift_eps0",
            unit: "",
            default: "9.31457e-3",
            range: (Bound::Included(1e-9), Bound::Included(10.0)),
            is_exponent: false,
            meaning: "With -hardening swift: eps0, the strain that makes the initial yield stress K eps0^n.",
        },
        Constant {
            name: "swift_n",
            unit: "",
            default: "0.223",
            range: (Bound::Included(1e-3), Bound::Included(1.0)),
            is_exponent: true,
            meaning: "With -hardening swift: the exponent n.",
        },
    ],
    build: Some(|constants, _| {
        Ok(Hardening::Swift(Swift::new(
            constants[0],
            constants[1],
            constants[2],
        )))
    }),
};

/// σ = K (ε₀ + p)ⁿ.
#[derive(Debug, Clone, PartialEq)]
pub struct Swift {
    k: f64,
    eps0: f64,
    n: f64,
}

impl Swift {
    /// From K (MPa), the strain `eps0` > 0 and the exponent 0 < `n` <= 1.
    pub fn new(k: f64, eps0: f64, n: f64) -> Self {
        Self { k, eps0, n }
    }
}

impl Law for Swift {
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        let strain = self.eps0 + p;
        let stress = self.k * strain.powf(self.n);
        (stress, self.n * stress / strain)
    }

    /// K ((ε₀ + p)ⁿ⁺¹ - ε₀ⁿ⁺¹) / (n + 1).
    fn plastic_work(&self, p: f64) -> f64 {
        let up_to = |strain: f64| self.k * strain.powf(self.n + 1.0) / (self.n + 1.0);
        up_to(self.eps0 + p) - up_to(self.eps0)
    }
}
