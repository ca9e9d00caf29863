//! Logarithmic strains in their principal axes, and back.

use crate::plane::{PlaneTensor, SymmetricMatrix};

/// Below this ratio of difference to sum of the squared stretches the spin factor is taken from its series: the quotient
/// would be 0/0 at equal stretches. The first term left out is 4e-18 of the factor.
const NEARLY_EQUAL: f64 = 1e-4;

/// Logarithmic strains of a left Cauchy-Green tensor in its principal axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrincipalStrains {
    /// Two in-plane values and the one normal to the plane.
    pub strain: [f64; 3],
    /// Cosine and sine of twice the angle from x to the first principal axis.
    axis: [f64; 2],
    /// (λ1 + λ2) (ε1 - ε2) / (λ1 - λ2) with λ the squared stretches; 1 where they coincide.
    pub spin_factor: f64,
}

/// How logarithmic strains and their axes move with the tensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrincipalSlope {
    pub strain: [f64; 3],
    /// Component off the diagonal in the principal axes, as a share of the sum of the squared stretches in the plane.
    pub shear: f64,
}

impl PrincipalStrains {
    /// The squared stretches.
    pub fn squared(&self) -> [f64; 3] {
        self.strain.map(|e| (2.0 * e).exp())
    }

    /// Derivatives from that of the tensor, with the [`PrincipalStrains::squared`] stretches.
    pub fn slope(&self, tensor: &PlaneTensor, squared: &[f64; 3]) -> PrincipalSlope {
        let [cos, sin] = self.axis;
        let centre = 0.5 * (tensor.xx + tensor.yy);
        let difference = 0.5 * (tensor.xx - tensor.yy);
        let half = difference * cos + tensor.xy * sin;
        let values = [centre + half, centre - half, tensor.zz];
        PrincipalSlope {
            strain: std::array::from_fn(|a| 0.5 * values[a] / squared[a]),
            shear: (tensor.xy * cos - difference * sin) / (squared[0] + squared[1]),
        }
    }

    /// The tensor with these principal values and this component off the diagonal in the same axes.
    pub fn sheared_tensor(&self, values: [f64; 3], shear: f64) -> PlaneTensor {
        let [cos, sin] = self.axis;
        let diagonal = self.tensor(values);
        PlaneTensor {
            xx: diagonal.xx - shear * sin,
            yy: diagonal.yy + shear * sin,
            zz: diagonal.zz,
            xy: diagonal.xy + shear * cos,
        }
    }

    /// Of the tensor `b` in the plane and `b_zz` normal to it. Where `b` is not positive definite to rounding, strains
    /// are infinite or not a number.
    #[inline]
    pub fn of(b: SymmetricMatrix, b_zz: f64) -> Self {
        let half_sum = 0.5 * (b.xx + b.yy);
        let half_difference = 0.5 * (b.xx - b.yy);
        let radius = (half_difference * half_difference + b.xy * b.xy).sqrt();
        let axis = if radius > 0.0 {
            [half_difference / radius, b.xy / radius]
        } else {
            [1.0, 0.0]
        };
        // ε1 - ε2 = atanh(radius / half_sum), ε1 + ε2 = ln(det b) / 2: both without cancellation.
        let ratio = radius / half_sum;
        let half_difference_of_strains = 0.5 * ratio.atanh();
        let mean = 0.25 * ((half_sum - radius) * (half_sum + radius)).ln();
        Self {
            strain: [
                mean + half_difference_of_strains,
                mean - half_difference_of_strains,
                0.5 * b_zz.ln(),
            ],
            axis,
            spin_factor: if ratio > NEARLY_EQUAL {
                2.0 * half_difference_of_strains / ratio
            } else {
                1.0 + ratio * ratio / 3.0
            },
        }
    }

    /// The tensor with these principal values in the same axes.
    #[inline]
    pub fn tensor(&self, values: [f64; 3]) -> PlaneTensor {
        let centre = 0.5 * (values[0] + values[1]);
        let half = 0.5 * (values[0] - values[1]);
        PlaneTensor {
            xx: centre + half * self.axis[0],
            yy: centre - half * self.axis[0],
            zz: values[2],
            xy: half * self.axis[1],
        }
    }

    /// The tangent given by `normal` and `shear` moduli in the principal axes, in x and y (order xx, yy, xy).
    #[inline]
    pub fn rotate_tangent(&self, normal: [[f64; 2]; 2], shear: f64) -> [[f64; 3]; 3] {
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
