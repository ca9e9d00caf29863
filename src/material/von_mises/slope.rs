//! How the answer of a material point moves with a parameter of the problem, along with its deformation and its history:
//! the derivative of [`VonMises::respond`], step by step, on the branch it took.
//!
//! With q the trial stress, p = p_n + Δp, H the slope of the flow stress σ_y and ∂σ_y its derivative by the parameter at a
//! held p, q - 3G Δp = σ_y(p) becomes
//!
//! ```text
//! (3G + H) dp = dq - 3 dG Δp + 3G dp_n - ∂σ_y
//! ```
//!
//! and an isotropic function of b with the principal values v_a, in the axes of b, has dv_a on the diagonal and
//! (v₁ - v₂)/(λ₁ - λ₂) db₁₂ off it.

use super::{Hardening, PointState, Response, VonMises, pull_back};
use crate::plane::{self, Matrix, PlaneTensor};

/// Derivatives of the constants of a material by a parameter.
#[derive(Clone, Debug)]
pub struct MaterialSlope {
    bulk: f64,
    shear: f64,
    /// The hardening law with more and with less of the parameter, and how far apart these are; none where it stays.
    laws: Option<([Hardening; 2], f64)>,
}

/// An answer with what its derivatives by all parameters have in common.
#[derive(Clone, Copy, Debug)]
pub struct Linearised {
    response: Response,
    /// Squared trial stretches.
    squared: [f64; 3],
    trial_stress: f64,
    /// C_p⁻¹ Fᵀ before.
    right: Matrix,
    yielded: Option<Yielded>,
}

/// The same of a point that yields.
#[derive(Clone, Copy, Debug)]
struct Yielded {
    /// Squared elastic stretches.
    squared: [f64; 3],
    /// (exp 2ε_e1 - exp 2ε_e2) (λ₁ + λ₂)/(λ₁ - λ₂).
    twist: f64,
    /// C_p⁻¹ Fᵀ after.
    right: Matrix,
}

/// Derivatives of an answer.
#[derive(Clone, Copy, Debug)]
pub struct ResponseSlope {
    /// Of the Kirchhoff stress.
    pub kirchhoff: PlaneTensor,
    /// Of the state if the step is accepted, number for number.
    pub state: PointState,
    /// Of the equivalent trial stress.
    trial_stress: f64,
}

impl MaterialSlope {
    /// From the materials with more and with less of the parameter, `width` of it apart.
    pub fn between(above: &VonMises, below: &VonMises, width: f64) -> Self {
        let laws = [above, below].map(|side| side.hardening.clone());
        Self {
            bulk: (above.bulk - below.bulk) / width,
            shear: (above.shear - below.shear) / width,
            laws: (laws[0] != laws[1]).then_some((laws, width)),
        }
    }

    /// Whether the parameter leaves the answer of a point as it is, where the point and its history stay.
    pub fn is_zero(&self, yields: bool) -> bool {
        self.bulk == 0.0 && self.shear == 0.0 && (self.laws.is_none() || !yields)
    }

    /// Derivative of the flow stress at a held plastic strain. It is a difference of the law itself, at one and the same
    /// strain, so that a law needs nothing more than its stress.
    fn flow_stress(&self, p: f64) -> f64 {
        self.laws.as_ref().map_or(0.0, |([above, below], width)| {
            (above.yield_stress(p).0 - below.yield_stress(p).0) / width
        })
    }
}

impl VonMises {
    /// How far `response` is from the yield surface it started from: trial stress by flow stress before, less one.
    pub fn excess(&self, response: &Response) -> f64 {
        let before = response.before.equivalent_plastic_strain;
        response.trial_stress() / self.hardening.yield_stress(before).0 - 1.0
    }

    /// Derivative of the excess, with the derivatives of the response and of the state `before`.
    pub fn excess_slope(
        &self,
        of: &Linearised,
        slope: &ResponseSlope,
        before: &PointState,
        by: &MaterialSlope,
    ) -> f64 {
        let p = of.response.before.equivalent_plastic_strain;
        let (flow_stress, hardening) = self.hardening.yield_stress(p);
        let moved = hardening * before.equivalent_plastic_strain + by.flow_stress(p);
        (slope.trial_stress - of.trial_stress / flow_stress * moved) / flow_stress
    }
}

impl PointState {
    /// The derivative of a state that stays as it is.
    pub const STILL: Self = Self {
        cp_inverse: PlaneTensor::ZERO,
        equivalent_plastic_strain: 0.0,
    };
}

impl Response {
    /// Whether the point yields.
    pub fn yields(&self) -> bool {
        self.theta < 1.0
    }

    fn trial_stress(&self) -> f64 {
        self.moduli[1] * (6.0 * self.norm_squared).sqrt()
    }

    /// Ready to be differentiated.
    pub fn linearised(self) -> Linearised {
        Linearised {
            squared: self.trial.squared(),
            trial_stress: self.trial_stress(),
            right: times_transpose(&self.before.cp_inverse, &self.deformation_gradient),
            yielded: self.yields().then(|| self.yielded()),
            response: self,
        }
    }

    fn yielded(&self) -> Yielded {
        let squared = self
            .deviator
            .map(|e| (2.0 * (self.mean + self.theta * e)).exp());
        let f = &self.deformation_gradient;
        // ε_e1 - ε_e2 = θ (ε₁ - ε₂), and (λ₁ - λ₂)/(λ₁ + λ₂) = tanh(ε₁ - ε₂).
        let difference = self.trial.strain[0] - self.trial.strain[1];
        let ratio = if difference > 0.0 {
            (self.theta * difference).sinh() / difference.tanh()
        } else {
            self.theta
        };
        let state = pull_back(f, self.determinant, &self.trial.tensor(squared));
        Yielded {
            twist: 2.0 * (squared[0] * squared[1]).sqrt() * ratio,
            right: times_transpose(&state, f),
            squared,
        }
    }
}

impl Linearised {
    /// The answer.
    pub fn response(&self) -> &Response {
        &self.response
    }

    /// Derivatives along those of the deformation gradient, of the state before and of the constants.
    pub fn slope(
        &self,
        deformation: &Matrix,
        before: &PointState,
        by: &MaterialSlope,
    ) -> ResponseSlope {
        let at = &self.response;
        let b = self.trial_tensor_slope(deformation, before);
        let trial = at.trial.slope(&b, &self.squared);
        let mean = (trial.strain[0] + trial.strain[1] + trial.strain[2]) / 3.0;
        let deviator = trial.strain.map(|e| e - mean);
        let [bulk, shear] = at.moduli;
        let along: f64 = at.deviator.iter().zip(deviator).map(|(e, d)| e * d).sum();
        let trial_stress = if at.norm_squared > 0.0 {
            self.trial_stress * (by.shear / shear + along / at.norm_squared)
        } else {
            0.0
        };
        let (p, theta) = match self.yielded {
            Some(_) => self.return_slope(trial_stress, before, by),
            None => (before.equivalent_plastic_strain, 0.0),
        };
        let pressure = 3.0 * (by.bulk * at.mean + bulk * mean);
        let scale = by.shear * at.theta + shear * theta;
        let stress = std::array::from_fn(|a| {
            pressure + 2.0 * (scale * at.deviator[a] + shear * at.theta * deviator[a])
        });
        // τ₁ - τ₂ = 2G θ (ε₁ - ε₂).
        let twist = 2.0 * shear * at.theta * at.trial.spin_factor * trial.shear;
        let elastic_strain =
            std::array::from_fn(|a| mean + theta * at.deviator[a] + at.theta * deviator[a]);
        let cp_inverse = self.yielded.as_ref().map_or(before.cp_inverse, |yielded| {
            yielded.cp_inverse_slope(at, elastic_strain, trial.shear, deformation)
        });
        ResponseSlope {
            kirchhoff: at.trial.sheared_tensor(stress, twist),
            state: PointState {
                cp_inverse,
                equivalent_plastic_strain: p,
            },
            trial_stress,
        }
    }

    /// Of b = F C_p⁻¹ Fᵀ.
    fn trial_tensor_slope(&self, deformation: &Matrix, before: &PointState) -> PlaneTensor {
        let moved = plane::with_transpose(&plane::product(deformation, &self.right));
        let f = &self.response.deformation_gradient;
        let remembered = plane::congruence(f, &before.cp_inverse.in_plane());
        PlaneTensor {
            xx: moved.xx + remembered.xx,
            yy: moved.yy + remembered.yy,
            zz: before.cp_inverse.zz,
            xy: moved.xy + remembered.xy,
        }
    }

    /// Of p and θ = σ_y/q where the point yields.
    fn return_slope(
        &self,
        trial_stress: f64,
        before: &PointState,
        by: &MaterialSlope,
    ) -> (f64, f64) {
        let at = &self.response;
        let three_g = 3.0 * at.moduli[1];
        // θ - θ̄ = H/(3G + H).
        let share = at.theta - at.theta_bar;
        let dp = at.equivalent_plastic_strain - at.before.equivalent_plastic_strain;
        let flow_stress = by.flow_stress(at.equivalent_plastic_strain);
        let driving = trial_stress - 3.0 * by.shear * dp - flow_stress;
        let p = (1.0 - share) * (driving / three_g + before.equivalent_plastic_strain);
        let yield_stress = flow_stress + three_g * share / (1.0 - share) * p;
        (
            p,
            (yield_stress - at.theta * trial_stress) / self.trial_stress,
        )
    }
}

impl Yielded {
    /// Of C_p⁻¹ = F⁻¹ b_e F⁻ᵀ, which is F⁻¹ (db_e - dF C_p⁻¹ Fᵀ - F C_p⁻¹ dFᵀ) F⁻ᵀ.
    fn cp_inverse_slope(
        &self,
        at: &Response,
        elastic_strain: [f64; 3],
        shear: f64,
        deformation: &Matrix,
    ) -> PlaneTensor {
        let values = std::array::from_fn(|a| 2.0 * self.squared[a] * elastic_strain[a]);
        let b = at.trial.sheared_tensor(values, self.twist * shear);
        let moved = plane::with_transpose(&plane::product(deformation, &self.right));
        let convected = PlaneTensor {
            xx: b.xx - moved.xx,
            yy: b.yy - moved.yy,
            zz: b.zz,
            xy: b.xy - moved.xy,
        };
        pull_back(&at.deformation_gradient, at.determinant, &convected)
    }
}

/// c fᵀ in the plane.
fn times_transpose(c: &PlaneTensor, f: &Matrix) -> Matrix {
    let [first, second] = f.map(|row| c.in_plane().times(row));
    [[first[0], second[0]], [first[1], second[1]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything that moves, at this distance along its direction.
    struct Beside {
        material: VonMises,
        deformation: Matrix,
        state: PointState,
    }

    fn beside(shear: f64, by: f64) -> Beside {
        let law = (super::super::super::hardening::law_named("hollomon"))
            .and_then(|law| law.build?(&[550.4 + 30.0 * by, 0.223 + 0.1 * by, 194.0], 7e4).ok());
        Beside {
            material: VonMises::new(7e4 * (1.0 + by), 0.342, law.unwrap()),
            deformation: [
                [1.0005 + 0.02 * by, shear - 0.03 * by],
                [0.01 * by, 0.9995 + 0.01 * by],
            ],
            state: PointState {
                cp_inverse: PlaneTensor {
                    xx: 1.001 + 0.02 * by,
                    yy: 0.9995 - 0.01 * by,
                    zz: 0.9995 - 0.01 * by,
                    xy: 0.0003 + 0.005 * by,
                },
                equivalent_plastic_strain: 0.012 + 0.01 * by,
            },
        }
    }

    #[test]
    fn slopes_agree_with_central_differences() {
        let (h, mut seen) = (1e-6, [0; 2]);
        // Elastic, hardly plastic and far beyond, and axes that are hardly known.
        for shear in [0.0, 1e-9, 1e-3, 0.01, 0.3] {
            let [here, above, below] = [0.0, h, -h].map(|by| beside(shear, by));
            let difference = |above: f64, below: f64| (above - below) / (2.0 * h);
            let of_tensors = |a: PlaneTensor, b: PlaneTensor| {
                let (a, b) = (a.components(), b.components());
                std::array::from_fn(|i| difference(a[i], b[i]))
            };
            let respond = |at: &Beside| at.material.respond(&at.deformation, &at.state).unwrap();
            let [answer, more, less] = [&here, &above, &below].map(respond);
            seen[usize::from(answer.yields())] += 1;
            let by = MaterialSlope::between(&above.material, &below.material, 2.0 * h);
            let (a, b) = (above.deformation, below.deformation);
            let deformation = [0, 1].map(|i| [0, 1].map(|j| difference(a[i][j], b[i][j])));
            let [xx, yy, zz, xy] = of_tensors(above.state.cp_inverse, below.state.cp_inverse);
            let before = PointState {
                cp_inverse: PlaneTensor { xx, yy, zz, xy },
                equivalent_plastic_strain: 0.01,
            };
            let linearised = answer.linearised();
            let slope = linearised.slope(&deformation, &before, &by);
            let close = |slope: f64, difference: f64, scale: f64| {
                assert!(
                    (slope - difference).abs() < 1e-6 * (difference.abs() + scale),
                    "{shear}: {slope} {difference}"
                );
            };
            let stress: [f64; 4] = of_tensors(more.kirchhoff, less.kirchhoff);
            for (slope, difference) in slope.kirchhoff.components().into_iter().zip(stress) {
                close(slope, difference, 100.0);
            }
            let (more_state, less_state) = (more.state(), less.state());
            let state: [f64; 4] = of_tensors(more_state.cp_inverse, less_state.cp_inverse);
            for (slope, difference) in slope.state.cp_inverse.components().into_iter().zip(state) {
                close(slope, difference, 0.01);
            }
            let [p, less_p] = [more_state, less_state].map(|s| s.equivalent_plastic_strain);
            close(
                slope.state.equivalent_plastic_strain,
                difference(p, less_p),
                0.01,
            );
            let excess = |at: &Beside, of: &Response| at.material.excess(of);
            close(
                here.material
                    .excess_slope(&linearised, &slope, &before, &by),
                difference(excess(&above, &more), excess(&below, &less)),
                1.0,
            );
        }
        assert!(seen.iter().all(|count| *count > 1), "{seen:?}");
    }
}
