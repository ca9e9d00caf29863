//! Laws of isotropic hardening: the flow stress as a function of the equivalent plastic strain p.
//!
//! To add a law: a file here with a type that is a [`Law`] and a [`Declaration`] called `LAW`, and two lines below, its
//! `mod` and its entry in the registry. Options, help and documentation of its constants follow from the declaration.

use std::ops::Bound;

mod hollomon;
mod hollomon_total;
mod linear;
mod return_map;
mod swift;
mod table;
mod table_text;
mod voce;

pub use table::{HardeningError, Table};

/// What a hardening law says. Stresses are in MPa; p >= 0 is the equivalent plastic strain.
///
/// The flow stress is positive and never falls with p, so that every return has exactly one solution.
pub trait Law {
    /// Flow stress and its slope at `p`; at a kink the slope beyond it.
    fn flow_stress(&self, p: f64) -> (f64, f64);

    /// Integral of the flow stress from 0 to `p`: plastic work per volume.
    fn plastic_work(&self, p: f64) -> f64;

    /// Radial return, see [`Hardening::return_map`]. The default solves for any law to rounding; a law with a closed
    /// form has that instead.
    fn return_map(&self, q_trial: f64, p_n: f64, three_g: f64) -> PlasticStep {
        return_map::iterate(self, q_trial, p_n, three_g)
    }
}

/// The answer of a radial return.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlasticStep {
    /// Increment of the equivalent plastic strain; 0 for an elastic step.
    pub dp: f64,
    /// Flow stress after the step, MPa.
    pub yield_stress: f64,
    /// Slope of the hardening law after the step, MPa.
    pub slope: f64,
}

/// How a law is chosen, and its constants.
#[derive(Debug)]
pub struct Declaration {
    /// The word by which it is chosen.
    pub name: &'static str,
    /// The flow stress as a formula.
    pub formula: &'static str,
    /// What it needs, in the order in which `build` takes the values.
    pub constants: &'static [Constant],
    /// How it is made; none for a law that is read from a file.
    pub build: Option<Build>,
}

/// Makes a law from the values of its constants, each in its range, and Young's modulus (MPa).
pub type Build = fn(&[f64], f64) -> Result<Hardening, ImpossibleLaw>;

/// Two declarations are the same law if they have the same name.
impl PartialEq for Declaration {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// A constant of one or more laws.
#[derive(Debug)]
pub struct Constant {
    /// Its name; it begins with that of the law.
    pub name: &'static str,
    /// Unit, or nothing.
    pub unit: &'static str,
    /// Default as a person would write it.
    pub default: &'static str,
    /// The values it can have.
    pub range: (Bound<f64>, Bound<f64>),
    /// Whether it is the exponent of a strain, a factor on its logarithm.
    pub is_exponent: bool,
    /// One sentence.
    pub meaning: &'static str,
}

/// Constants that are each in their range but make no hardening law together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("hardening law {law}: {problem}")]
pub struct ImpossibleLaw {
    /// Name of the law.
    pub law: &'static str,
    /// What is wrong, with numbers, and what to do.
    pub problem: String,
}

/// Range of a stress that describes a law, MPa.
const STRESS: (Bound<f64>, Bound<f64>) = (Bound::Included(1e-3), Bound::Included(1e6));
/// Steepest slope that a law may have anywhere, MPa: far above any stiffness, and far below what overflows.
const STEEPEST: f64 = 1e15;

macro_rules! registry {
    ($($(#[$comment:meta])* $law:ident = $module:ident,)*) => {
        /// A hardening law with its constants. Nothing is allocated after construction.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Hardening {
            $($(#[$comment])* $law($module::$law),)*
        }

        /// Every law, in the order of the listings.
        pub static LAWS: &[&Declaration] = &[$(&$module::LAW),*];

        impl Hardening {
            /// Flow stress and slope (both MPa) at the equivalent plastic strain `p` >= 0; at a kink the slope beyond it.
            #[inline]
            pub fn yield_stress(&self, p: f64) -> (f64, f64) {
                match self {
                    $(Self::$law(law) => law.flow_stress(p),)*
                }
            }

            /// Integral of the flow stress from 0 to `p` >= 0, in closed form: work per volume, MPa.
            pub fn plastic_work(&self, p: f64) -> f64 {
                match self {
                    $(Self::$law(law) => law.plastic_work(p),)*
                }
            }

            /// Radial return for von Mises plasticity (Simo and Hughes 1998, box 3.2): the dp >= 0 with
            /// `q_trial` - 3G dp = flow stress at `p_n` + dp, or an elastic step where `q_trial` does not exceed the
            /// flow stress at `p_n`.
            ///
            /// `q_trial`: equivalent trial stress, MPa; `p_n` >= 0: equivalent plastic strain before; `three_g`: three
            /// times the shear modulus, MPa, > 0. A NaN comes out as NaN.
            #[inline]
            pub fn return_map(&self, q_trial: f64, p_n: f64, three_g: f64) -> PlasticStep {
                match self {
                    $(Self::$law(law) => law.return_map(q_trial, p_n, three_g),)*
                }
            }
        }
    };
}

registry! {
    /// Piecewise linear through the points of a table.
    Table = table,
    /// K pⁿ above an elastic limit.
    Hollomon = hollomon,
    /// K εⁿ with the total strain ε.
    HollomonTotal = hollomon_total,
    /// K (ε₀ + p)ⁿ.
    Swift = swift,
    /// σ₀ + Q (1 - exp(-b p)).
    Voce = voce,
    /// σ₀ + H p.
    Linear = linear,
}

impl Hardening {
    /// Initial yield stress, MPa.
    pub fn initial(&self) -> f64 {
        self.yield_stress(0.0).0
    }
}

/// The law with this name.
pub fn law_named(name: &str) -> Option<&'static Declaration> {
    LAWS.iter().copied().find(|law| law.name == name)
}
