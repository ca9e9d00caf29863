//! Vectors, matrices and tensors in the plane: the arithmetic that elements, contact, material and tools share.
//! Never: units, meshes, laws of mechanics.
//!
//! A symmetric tensor has named components, so their order matters in arrays only. There it is xx, yy, zz, xy everywhere
//! ([`PlaneTensor::components`]), as in field files; a tangent matrix has xx, yy, xy (engineering shear).

/// A vector.
pub type Vector = [f64; 2];

/// A matrix by rows.
pub type Matrix = [[f64; 2]; 2];

/// A symmetric matrix, such as a Hessian.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SymmetricMatrix {
    /// First diagonal component.
    pub xx: f64,
    /// Second diagonal component.
    pub yy: f64,
    /// Off-diagonal component.
    pub xy: f64,
}

/// A symmetric tensor in plane strain: as [`SymmetricMatrix`], with the component normal to the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneTensor {
    /// First diagonal component in the plane.
    pub xx: f64,
    /// Second diagonal component in the plane.
    pub yy: f64,
    /// Component normal to the plane.
    pub zz: f64,
    /// Shear component (of the tensor, not the engineering shear).
    pub xy: f64,
}

impl SymmetricMatrix {
    /// As a matrix by rows.
    #[inline]
    pub fn rows(&self) -> Matrix {
        [[self.xx, self.xy], [self.xy, self.yy]]
    }

    /// The product with a vector.
    #[inline]
    pub fn times(&self, v: Vector) -> Vector {
        [
            self.xx * v[0] + self.xy * v[1],
            self.xy * v[0] + self.yy * v[1],
        ]
    }
}

impl PlaneTensor {
    /// All zeros.
    pub const ZERO: Self = Self {
        xx: 0.0,
        yy: 0.0,
        zz: 0.0,
        xy: 0.0,
    };

    /// Ones on the diagonal.
    pub const IDENTITY: Self = Self {
        xx: 1.0,
        yy: 1.0,
        zz: 1.0,
        xy: 0.0,
    };

    /// The components in the one order of arrays and files: xx, yy, zz, xy.
    #[inline]
    pub fn components(&self) -> [f64; 4] {
        [self.xx, self.yy, self.zz, self.xy]
    }

    /// The in-plane part.
    #[inline]
    pub fn in_plane(&self) -> SymmetricMatrix {
        SymmetricMatrix {
            xx: self.xx,
            yy: self.yy,
            xy: self.xy,
        }
    }

    /// The same operation on every component.
    #[inline]
    #[must_use]
    pub fn map(self, operation: impl Fn(f64) -> f64) -> Self {
        Self {
            xx: operation(self.xx),
            yy: operation(self.yy),
            zz: operation(self.zz),
            xy: operation(self.xy),
        }
    }
}

/// Scalar product.
#[inline]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Determinant of a matrix.
#[inline]
pub fn determinant(m: &Matrix) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

/// Product of two matrices.
#[inline]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| [0, 1].map(|k| row[0] * b[0][k] + row[1] * b[1][k]))
}

/// The inverse of a matrix with this determinant.
#[inline]
pub fn inverse(m: &Matrix, determinant: f64) -> Matrix {
    [
        [m[1][1] / determinant, -m[0][1] / determinant],
        [-m[1][0] / determinant, m[0][0] / determinant],
    ]
}

/// m + mᵀ.
#[inline]
pub fn with_transpose(m: &Matrix) -> SymmetricMatrix {
    SymmetricMatrix {
        xx: 2.0 * m[0][0],
        yy: 2.0 * m[1][1],
        xy: m[0][1] + m[1][0],
    }
}

/// Σ weight · vector over the three nodes of an edge.
#[inline]
pub fn interpolate(weights: [f64; 3], nodes: &[Vector; 3]) -> Vector {
    [0, 1].map(|k| (0..3).map(|a| weights[a] * nodes[a][k]).sum())
}

/// m s mᵀ of a symmetric matrix s.
#[inline]
pub fn congruence(m: &Matrix, s: &SymmetricMatrix) -> SymmetricMatrix {
    let [first, second] = m.map(|row| s.times(row));
    SymmetricMatrix {
        xx: dot(first, m[0]),
        xy: dot(first, m[1]),
        yy: dot(second, m[1]),
    }
}
