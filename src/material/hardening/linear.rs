//! Linear hardening.

use std::ops::Bound;

use super::{Constant, Declaration, Hardening, Law, PlasticStep, STRESS};

pub(super) static LAW: Declaration = Declaration {
    name: "linear",
    formula: "sigma0 + H p",
    constants: &[
        Constant {
            name: "linear_sigma0",
            unit: "MPa",
            default: "194",
            range: STRESS,
            is_exponent: false,
            meaning: "With -hardening linear, sigma = sigma0 + H p: sigma0, the initial yield stress.",
        },
        Constant {
            name: "linear_h",
            unit: "MPa",
            default: "1800",
            range: (Bound::Included(0.0), Bound::Included(1e6)),
            is_exponent: false,
            meaning: "With -hardening linear: H, the slope; 0 is perfect plasticity.",
        },
    ],
    build: Some(|constants, _| Ok(Hardening::Linear(Linear::new(constants[0], constants[1])))),
};

/// σ = σ₀ + H p.
#[derive(Debug, Clone, PartialEq)]
pub struct Linear {
    sigma0: f64,
    h: f64,
}

impl Linear {
    /// From the initial yield stress and the slope `h` >= 0, both in MPa.
    pub fn new(sigma0: f64, h: f64) -> Self {
        Self { sigma0, h }
    }
}

impl Law for Linear {
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        (self.sigma0 + self.h * p, self.h)
    }

    fn plastic_work(&self, p: f64) -> f64 {
        p * (self.sigma0 + 0.5 * self.h * p)
    }

    fn return_map(&self, q_trial: f64, p_n: f64, three_g: f64) -> PlasticStep {
        let (before, slope) = self.flow_stress(p_n);
        let dp = if q_trial <= before {
            0.0
        } else {
            (q_trial - before) / (three_g + slope)
        };
        PlasticStep {
            dp,
            yield_stress: before + slope * dp,
            slope,
        }
    }
}
