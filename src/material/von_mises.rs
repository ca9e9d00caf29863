//! Finite-strain von Mises plasticity in logarithmic strains, plane strain.
//!
//! Multiplicative split with the exponential map: the return in principal logarithmic strains has
//! the form of the small-strain one (Simo 1992, Comput. Methods Appl. Mech. Engrg. 99, 61-112; de
//! Souza Neto, Perić, Owen 2008, boxes 14.3 and 14.4).

use super::Hardening;

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
    /// Inverse of the plastic right Cauchy-Green tensor: xx, xy, yy, zz.
    pub cp_inverse: [f64; 4],
    /// Equivalent plastic strain.
    pub equivalent_plastic_strain: f64,
}

impl PointState {
    /// A point that never yielded.
    pub const VIRGIN: Self = Self {
        cp_inverse: [1.0, 0.0, 1.0, 1.0],
        equivalent_plastic_strain: 0.0,
    };
}

/// The determinant of the deformation gradient is not positive: the material is turned inside out.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the deformation gradient has determinant {determinant:.3e}: the material is turned over")]
pub struct TurnedOver {
    /// The determinant.
    pub determinant: f64,
}

/// What a material point answers: the stress at once, tangent, state and energy when they are asked for,
/// because a residual needs none of them.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Kirchhoff stress, MPa: xx, xy, yy, zz.
    pub kirchhoff: [f64; 4],
    /// Bulk and shear modulus, MPa.
    moduli: [f64; 2],
    deformation_gradient: [[f64; 2]; 2],
    determinant: f64,
    before: PointState,
    trial: PrincipalStrains,
    /// Mean and deviators of the trial strains, and the deviators' squared norm.
    mean: f64,
    deviator: [f64; 3],
    norm_squared: f64,
    /// Principal stresses, MPa.
    stress: [f64; 3],
    /// Radial return: the deviator shrinks by this factor.
    shrink: f64,
    /// The tangent's loss along the flow.
    softening: f64,
    equivalent_plastic_strain: f64,
}

impl VonMises {
    /// From Young's modulus (MPa), Poisson's ratio and the hardening curve.
    pub fn new(young_modulus: f64, poisson_ratio: f64, hardening: Hardening) -> Self {
        Self {
            bulk: young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)),
            shear: young_modulus / (2.0 * (1.0 + poisson_ratio)),
            hardening,
        }
    }

    /// The hardening curve.
    pub fn hardening(&self) -> &Hardening {
        &self.hardening
    }

    /// The response to the deformation gradient `f` (rows x, y), starting from `state`, which is left
    /// alone.
    pub fn respond(&self, f: &[[f64; 2]; 2], state: &PointState) -> Result<Response, TurnedOver> {
        let determinant = f[0][0] * f[1][1] - f[0][1] * f[1][0];
        if determinant.is_nan() || determinant <= 0.0 {
            return Err(TurnedOver { determinant });
        }
        let trial = PrincipalStrains::of(push_forward(f, &state.cp_inverse), state.cp_inverse[3]);
        let mean = (trial.strain[0] + trial.strain[1] + trial.strain[2]) / 3.0;
        let deviator = trial.strain.map(|e| e - mean);
        let norm_squared: f64 = deviator.iter().map(|e| e * e).sum();
        let q_trial = self.shear * (6.0 * norm_squared).sqrt();

        let p_old = state.equivalent_plastic_strain;
        let (yield_old, _) = self.hardening.yield_stress(p_old);
        let (shrink, softening, equivalent_plastic_strain) = if q_trial <= yield_old {
            (1.0, 0.0, p_old)
        } else {
            let three_g = 3.0 * self.shear;
            let step = self.hardening.return_map(q_trial, p_old, three_g);
            let shrink = step.yield_stress / q_trial;
            let softening = shrink - step.slope / (three_g + step.slope);
            (shrink, softening, p_old + step.dp)
        };
        let pressure = 3.0 * self.bulk * mean;
        let stress = deviator.map(|e| pressure + 2.0 * self.shear * shrink * e);

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
            shrink,
            softening,
            equivalent_plastic_strain,
        })
    }
}

impl Response {
    /// Spatial tangent of the Kirchhoff stress, MPa, in the order xx, yy, xy (engineering shear): the Lie
    /// derivative of the stress is this matrix times the rate of deformation.
    pub fn tangent(&self) -> [[f64; 3]; 3] {
        let ([bulk, shear], stress) = (self.moduli, &self.stress);
        let flow = if self.norm_squared > 0.0 {
            self.deviator.map(|e| e / self.norm_squared.sqrt())
        } else {
            [0.0; 3]
        };
        let modulus = |a: usize, b: usize| {
            let same = if a == b { 1.0 } else { 0.0 };
            bulk + 2.0 * shear * self.shrink * (same - 1.0 / 3.0)
                - 2.0 * shear * self.softening * flow[a] * flow[b]
        };
        let normal = [
            [modulus(0, 0) - 2.0 * stress[0], modulus(0, 1)],
            [modulus(1, 0), modulus(1, 1) - 2.0 * stress[1]],
        ];
        let twist = shear * self.shrink * self.trial.spin_factor - 0.5 * (stress[0] + stress[1]);
        self.trial.rotate_tangent(normal, twist)
    }

    /// The state if this step is accepted.
    pub fn state(&self) -> PointState {
        let elastic_strain = self.deviator.map(|e| self.mean + self.shrink * e);
        PointState {
            cp_inverse: if self.shrink < 1.0 {
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
        4.5 * bulk * self.mean * self.mean + shear * self.shrink * self.shrink * self.norm_squared
    }
}

/// Logarithmic strains of a left Cauchy-Green tensor in its principal axes.
#[derive(Clone, Copy, Debug)]
struct PrincipalStrains {
    /// Two in-plane values and the one normal to the plane.
    strain: [f64; 3],
    /// Cosine and sine of twice the angle from x to the first principal axis.
    axis: [f64; 2],
    /// (λ1 + λ2) (ε1 - ε2) / (λ1 - λ2) with λ the squared stretches; 1 where they coincide.
    spin_factor: f64,
}

impl PrincipalStrains {
    /// `b` as xx, xy, yy in the plane and `b_zz` normal to it.
    fn of(b: [f64; 3], b_zz: f64) -> Self {
        let half_sum = 0.5 * (b[0] + b[2]);
        let half_difference = 0.5 * (b[0] - b[2]);
        let radius = (half_difference * half_difference + b[1] * b[1]).sqrt();
        let axis = if radius > 0.0 {
            [half_difference / radius, b[1] / radius]
        } else {
            [1.0, 0.0]
        };
        // ε1 - ε2 = atanh(radius / half_sum), ε1 + ε2 = ln(det b) / 2: both without cancellation.
        let ratio = radius / half_sum;
        let half_gap = 0.5 * ratio.atanh();
        let mean = 0.25 * ((half_sum - radius) * (half_sum + radius)).ln();
        Self {
            strain: [mean + half_gap, mean - half_gap, 0.5 * b_zz.ln()],
            axis,
            spin_factor: if ratio > 1e-4 {
                2.0 * half_gap / ratio
            } else {
                1.0 + ratio * ratio / 3.0
            },
        }
    }

    /// The tensor with these principal values: xx, xy, yy, zz.
    fn tensor(&self, values: [f64; 3]) -> [f64; 4] {
        let centre = 0.5 * (values[0] + values[1]);
        let half = 0.5 * (values[0] - values[1]);
        [
            centre + half * self.axis[0],
            half * self.axis[1],
            centre - half * self.axis[0],
            values[2],
        ]
    }

    /// The tangent given by `normal` and `shear` moduli in the principal axes, in x and y.
    fn rotate_tangent(&self, normal: [[f64; 2]; 2], shear: f64) -> [[f64; 3]; 3] {
        let [cos, sin] = self.axis;
        // Strains in the principal axes from xx, yy, xy (engineering).
        let first = [0.5 * (1.0 + cos), 0.5 * (1.0 - cos), 0.5 * sin];
        let second = [first[1], first[0], -0.5 * sin];
        let twist = [-sin, sin, cos];
        let mut tangent = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                tangent[i][j] = first[i] * (normal[0][0] * first[j] + normal[0][1] * second[j])
                    + second[i] * (normal[1][0] * first[j] + normal[1][1] * second[j])
                    + shear * twist[i] * twist[j];
            }
        }
        tangent
    }
}

/// F C F^T in the plane.
fn push_forward(f: &[[f64; 2]; 2], c: &[f64; 4]) -> [f64; 3] {
    let fc = [
        [
            f[0][0] * c[0] + f[0][1] * c[1],
            f[0][0] * c[1] + f[0][1] * c[2],
        ],
        [
            f[1][0] * c[0] + f[1][1] * c[1],
            f[1][0] * c[1] + f[1][1] * c[2],
        ],
    ];
    [
        fc[0][0] * f[0][0] + fc[0][1] * f[0][1],
        fc[0][0] * f[1][0] + fc[0][1] * f[1][1],
        fc[1][0] * f[1][0] + fc[1][1] * f[1][1],
    ]
}

/// F^-1 b F^-T with the component zz kept.
fn pull_back(f: &[[f64; 2]; 2], determinant: f64, b: &[f64; 4]) -> [f64; 4] {
    let inverse = [
        [f[1][1] / determinant, -f[0][1] / determinant],
        [-f[1][0] / determinant, f[0][0] / determinant],
    ];
    let [xx, xy, yy] = push_forward(&inverse, b);
    [xx, xy, yy, b[3]]
}
