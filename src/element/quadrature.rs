//! Gauss-Legendre rules on the reference square.

/// Gauss points per direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// 2 x 2 points: reduced integration of QUAD8, free of volumetric locking.
    Reduced,
    /// 3 x 3 points: full integration.
    Full,
}

impl Quadrature {
    /// Gauss points of an element.
    pub fn point_count(self) -> usize {
        match self {
            Self::Reduced => 4,
            Self::Full => 9,
        }
    }
}

/// Points (ξ, η) and weights on [-1, 1]².
pub fn gauss_points(quadrature: Quadrature) -> Vec<([f64; 2], f64)> {
    let inner = 1.0 / 3.0_f64.sqrt();
    let outer = 0.6_f64.sqrt();
    let line: &[(f64, f64)] = match quadrature {
        Quadrature::Reduced => &[(-inner, 1.0), (inner, 1.0)],
        Quadrature::Full => &[(-outer, 5.0 / 9.0), (0.0, 8.0 / 9.0), (outer, 5.0 / 9.0)],
    };
    line.iter()
        .flat_map(|&(eta, we)| line.iter().map(move |&(xi, wx)| ([xi, eta], wx * we)))
        .collect()
}
