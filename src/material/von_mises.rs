//! Finite-strain von Mises plasticity in logarithmic strains, plane strain.
//!
//! Multiplicative split with the exponential map: the return in principal logarithmic strains has the form of the
//! small-strain one (Simo 1992, Comput. Methods Appl. Mech. Engrg. 99, 61-112; de Souza Neto, Perić and Owen 2008, boxes
//! 14.3 and 14.4; the comments number the steps of the first; the radial return and its consistent tangent: Simo and Hughes
//! 1998, box 3.2).

mod slope;

pub use slope::{Linearised, MaterialSlope, ResponseSlope};

use super::Hardening;
use super::principal::PrincipalStrains;
use crate::plane::{self, Matrix, PlaneTensor};

/// Largest logarithmic strain, elastic trial or total, that is evaluated, and the squared stretch it belongs to. Beyond it
/// an iterate is lost; up to it everything that follows is far within the range of numbers.
const LARGEST_STRAIN: f64 = 46.0;
const LARGEST_SQUARED_STRETCH: f64 = 1e40;

/// Elastic constants and hardening of an isotropic von Mises material.
#[derive(Clone, Debug)]
pub struct VonMises {
    /// Bulk modulus, MPa.
    bulk: f64,
    /// Shear modulus, MPa.
    shear: f64,
    hardening: Hardening,
}

/// History of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointState {
    /// Inverse of the plastic right Cauchy-Green tensor.
    pub cp_inverse: PlaneTensor,
    /// Equivalent plastic strain.
    pub equivalent_plastic_strain: f64,
}

impl PointState {
    /// A point that never yielded.
    pub const VIRGIN: Self = Self {
        cp_inverse: PlaneTensor::IDENTITY,
        equivalent_plastic_strain: 0.0,
    };
}

/// A deformation gradient for which there is no response.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DeformationError {
    /// The Jacobian determinant is not positive.
    #[error(
        "the element is inverted: the deformation gradient has the determinant {determinant:.3e}"
    )]
    Inverted {
        /// Determinant of the deformation gradient.
        determinant: f64,
    },
    /// Strains are not finite, or so large that what follows from them would not be.
    #[error(
        "the deformation cannot be evaluated: a logarithmic strain is beyond {LARGEST_STRAIN} or not a number, and the \
         deformation gradient has the determinant {determinant:.3e}"
    )]
    Unbounded {
        /// Determinant of the deformation gradient.
        determinant: f64,
    },
}

/// What a material point answers: the stress at once, tangent, state and energy when they are asked for, because a
/// residual needs none of them. All of it is finite.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Kirchhoff stress, MPa.
    pub kirchhoff: PlaneTensor,
    /// Bulk and shear modulus, MPa.
    moduli: [f64; 2],
    deformation_gradient: Matrix,
    determinant: f64,
    before: PointState,
    trial: PrincipalStrains,
    /// Mean and deviators of the trial strains, and the deviators' squared norm.
    mean: f64,
    deviator: [f64; 3],
    norm_squared: f64,
    /// Principal stresses, MPa.
    stress: [f64; 3],
    /// θ of [`Response::tangent`]: the return scales the deviator by this factor.
    theta: f64,
    /// θ̄ of [`Response::tangent`].
    theta_bar: f64,
    equivalent_plastic_strain: f64,
}

impl VonMises {
    /// From Young's modulus (MPa), Poisson's ratio and the hardening law.
    pub fn new(young_modulus: f64, poisson_ratio: f64, hardening: Hardening) -> Self {
        Self {
            bulk: young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)),
            shear: young_modulus / (2.0 * (1.0 + poisson_ratio)),
            hardening,
        }
    }

    /// The hardening law.
    pub fn hardening(&self) -> &Hardening {
        &self.hardening
    }

    /// The response to the deformation gradient `f` (rows x, y), starting from `state`, which is left alone.
    ///
    /// # Errors
    /// The determinant of `f` is not positive, or strains are not finite.
    #[inline]
    pub fn respond(&self, f: &Matrix, state: &PointState) -> Result<Response, DeformationError> {
        let determinant = plane::determinant(f);
        if determinant <= 0.0 {
            return Err(DeformationError::Inverted { determinant });
        }

        // Box 14.3 (i), (ii): elastic trial state b = F C_p⁻¹ Fᵀ and its principal logarithmic strains.
        let b = plane::congruence(f, &state.cp_inverse.in_plane());
        let trial = PrincipalStrains::of(b, state.cp_inverse.zz);
        if !is_bounded(f, determinant, &trial) {
            return Err(DeformationError::Unbounded { determinant });
        }

        // Box 14.3 (iii), which is the small-strain return map: the trial stress ...
        let mean = (trial.strain[0] + trial.strain[1] + trial.strain[2]) / 3.0;
        let deviator = trial.strain.map(|e| e - mean);
        let norm_squared: f64 = deviator.iter().map(|e| e * e).sum();
        let q_trial = self.shear * (6.0 * norm_squared).sqrt();
        // ... and the radial return, q_trial - 3G Δp = σ_y(p_n + Δp) (Simo and Hughes 1998, box 3.2).
        let p_n = state.equivalent_plastic_strain;
        let three_g = 3.0 * self.shear;
        let step = self.hardening.return_map(q_trial, p_n, three_g);
        let (theta, theta_bar) = if step.dp > 0.0 {
            let theta = step.yield_stress / q_trial;
            (theta, theta - step.slope / (three_g + step.slope))
        } else {
            (1.0, 0.0)
        };

        // Box 14.3 (iv): the stress. The new elastic strains go into the state only if the step is accepted.
        let pressure = 3.0 * self.bulk * mean;
        let stress = deviator.map(|e| pressure + 2.0 * self.shear * theta * e);
        Ok(Response {
            kirchhoff: trial.tensor(stress),
            moduli: [self.bulk, self.shear],
            deformation_gradient: *f,
            determinant,
            before: *state,
            trial,
            mean,
            deviator,
            norm_squared,
            stress,
            theta,
            theta_bar,
            equivalent_plastic_strain: p_n + step.dp,
        })
    }
}

/// Whether trial strains and deformation are such that stress, tangent and new state are finite. False for a NaN.
fn is_bounded(f: &Matrix, determinant: f64, trial: &PrincipalStrains) -> bool {
    let [[xx, xy], [yx, yy]] = f;
    // The squared stretches λ₁ ≥ λ₂ of F have this sum and the product det², so λ₁ <= sum and λ₂ >= det²/sum.
    let sum = xx * xx + xy * xy + yx * yx + yy * yy;
    sum <= LARGEST_SQUARED_STRETCH
        && determinant * determinant * LARGEST_SQUARED_STRETCH >= sum
        && trial.strain.iter().all(|e| e.abs() <= LARGEST_STRAIN)
}

impl Response {
    /// Spatial tangent of the Kirchhoff stress, MPa, in the order xx, yy, xy (engineering shear): the Lie derivative of
    /// the stress is this matrix times the rate of deformation.
    ///
    /// The return map has the consistent tangent (Simo and Hughes 1998, box 3.2)
    ///
    /// ```text
    /// ∂τ/∂ε = K 1⊗1 + 2G θ (I - 1⊗1/3) - 2G θ̄ n⊗n        n = dev ε / |dev ε|, H = dσ_y/dp
    /// θ = 1 - 3G Δp/q_trial = σ_y/q_trial                 θ̄ = 1/(1 + H/3G) - (1 - θ) = θ - H/(3G + H)
    /// ```
    ///
    /// (elastic: θ = 1, θ̄ = 0), and with λ_a = exp 2ε_a the squared trial stretches the spatial tangent in the principal
    /// axes is (Simo 1992; de Souza Neto, Perić and Owen 2008, chapter 14)
    ///
    /// ```text
    /// c_aabb = ∂τ_a/∂ε_b - 2 τ_a δ_ab
    /// c_1212 = (τ₁ λ₂ - τ₂ λ₁)/(λ₁ - λ₂) = G θ (λ₁ + λ₂)(ε₁ - ε₂)/(λ₁ - λ₂) - (τ₁ + τ₂)/2
    /// ```
    ///
    /// the last because τ₁ - τ₂ = 2G θ (ε₁ - ε₂).
    pub fn tangent(&self) -> [[f64; 3]; 3] {
        let ([bulk, shear], stress) = (self.moduli, &self.stress);
        let flow = if self.norm_squared > 0.0 {
            self.deviator.map(|e| e / self.norm_squared.sqrt())
        } else {
            [0.0; 3]
        };
        let modulus = |a: usize, b: usize| {
            let same = if a == b { 1.0 } else { 0.0 };
            bulk + 2.0 * shear * self.theta * (same - 1.0 / 3.0)
                - 2.0 * shear * self.theta_bar * flow[a] * flow[b]
        };
        let normal = [
            [modulus(0, 0) - 2.0 * stress[0], modulus(0, 1)],
            [modulus(1, 0), modulus(1, 1) - 2.0 * stress[1]],
        ];
        let twist = shear * self.theta * self.trial.spin_factor - 0.5 * (stress[0] + stress[1]);
        self.trial.rotate_tangent(normal, twist)
    }

    /// The state if this step is accepted: b_e = exp 2ε_e in the trial axes, C_p⁻¹ = F⁻¹ b_e F⁻ᵀ.
    pub fn state(&self) -> PointState {
        let elastic_strain = self.deviator.map(|e| self.mean + self.theta * e);
        PointState {
            cp_inverse: if self.theta < 1.0 {
                pull_back(
                    &self.deformation_gradient,
                    self.determinant,
                    &self.trial.tensor(elastic_strain.map(|e| (2.0 * e).exp())),
                )
            } else {
                self.before.cp_inverse
            },
            equivalent_plastic_strain: self.equivalent_plastic_strain,
        }
    }

    /// Stored elastic energy per reference volume, mJ/mm³.
    pub fn elastic_energy(&self) -> f64 {
        let [bulk, shear] = self.moduli;
        4.5 * bulk * self.mean * self.mean + shear * self.theta * self.theta * self.norm_squared
    }
}

/// F⁻¹ b F⁻ᵀ with the component normal to the plane kept.
fn pull_back(f: &Matrix, determinant: f64, b: &PlaneTensor) -> PlaneTensor {
    let inverse = plane::inverse(f, determinant);
    let pulled = plane::congruence(&inverse, &b.in_plane());
    PlaneTensor {
        xx: pulled.xx,
        yy: pulled.yy,
        zz: b.zz,
        xy: pulled.xy,
    }
}
