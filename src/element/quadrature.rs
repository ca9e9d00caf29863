//! Gauss-Legendre rules on the reference square.

/// Gauss points of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// 2 x 2 points: reduced integration of QUAD8, free of volumetric locking.
    Reduced,
    /// 3 x 3 points: full integration.
    Full,
    /// Other numbers along ξ and along η: more of them through the thickness resolve where the stress has kinks.
    Points {
        /// Points along ξ.
        along: usize,
        /// Points along η.
        through: usize,
    },
}

impl Quadrature {
    /// The rule with these numbers of points along ξ and η.
    pub fn of(along: usize, through: usize) -> Self {
        match (along, through) {
            (2, 2) => Self::Reduced,
            (3, 3) => Self::Full,
            (along, through) => Self::Points { along, through },
        }
    }

    /// Gauss points along ξ and along η.
    fn counts(self) -> [usize; 2] {
        match self {
            Self::Reduced => [2, 2],
            Self::Full => [3, 3],
            Self::Points { along, through } => [along, through],
        }
    }

    /// Gauss points of an element.
    pub fn point_count(self) -> usize {
        let [along, through] = self.counts();
        along * through
    }
}

/// Points (ξ, η) and weights on [-1, 1]².
pub fn gauss_points(quadrature: Quadrature) -> Vec<([f64; 2], f64)> {
    let [along, through] = quadrature.counts().map(gauss_line);
    through
        .iter()
        .flat_map(|&(eta, we)| along.iter().map(move |&(xi, wx)| ([xi, eta], wx * we)))
        .collect()
}

/// Points in increasing order and weights of the Gauss-Legendre rule on [-1, 1] that is exact for polynomials of degree
/// 2 `count` - 1.
fn gauss_line(count: usize) -> Vec<(f64, f64)> {
    let (inner, outer) = (1.0 / 3.0_f64.sqrt(), 0.6_f64.sqrt());
    match count {
        2 => vec![(-inner, 1.0), (inner, 1.0)],
        3 => vec![(-outer, 5.0 / 9.0), (0.0, 8.0 / 9.0), (outer, 5.0 / 9.0)],
        _ => (0..count)
            .map(|index| legendre_root(count, index))
            .collect(),
    }
}

/// Root number `index` of the Legendre polynomial of degree `degree` and its weight 2 / ((1 - x²) P'(x)²), by Newton's
/// method from Tricomi's estimate (Abramowitz and Stegun 1964, 22.16.6 and 25.4.29).
fn legendre_root(degree: usize, index: usize) -> (f64, f64) {
    // Quadratic convergence from an estimate that is good to a thousandth: four steps reach rounding, two more do no harm.
    const STEPS: usize = 6;
    let n = degree as f64;
    let mut x = -(std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5)).cos();
    for _ in 0..STEPS {
        let (value, slope) = legendre(degree, x);
        x -= value / slope;
    }
    let (_, slope) = legendre(degree, x);
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// The Legendre polynomial of a degree of at least 1 and its slope inside (-1, 1).
fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 1..degree {
        let k = k as f64;
        (before, value) = (
            value,
            ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0),
        );
    }
    (value, degree as f64 * (before - x * value) / (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_n_points_is_exact_to_degree_2n_minus_1() {
        for count in 2..=32 {
            let line = gauss_line(count);
            for degree in 0..2 * count {
                let sum: f64 = line.iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                let exact = if degree % 2 == 0 {
                    2.0 / (degree as f64 + 1.0)
                } else {
                    0.0
                };
                assert!(
                    (sum - exact).abs() < 1e-14,
                    "{count} points, degree {degree}: {sum} and {exact}"
                );
            }
            // The next even degree is beyond the rule: were it exact, the test would say nothing.
            if count < 8 {
                let next: f64 = line.iter().map(|(x, w)| w * x.powi(2 * count as i32)).sum();
                assert!(
                    (next - 2.0 / (2.0 * count as f64 + 1.0)).abs() > 1e-6,
                    "{count} points"
                );
            }
        }
    }

    #[test]
    fn the_closed_rules_are_roots_of_legendre_polynomials() {
        for count in [2, 3] {
            for (index, (x, weight)) in gauss_line(count).into_iter().enumerate() {
                let (root, found) = legendre_root(count, index);
                assert!((x - root).abs() < 1e-15 && (weight - found).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn points_rise_and_are_symmetric() {
        for count in 2..=32 {
            let line = gauss_line(count);
            assert!(line.is_sorted_by(|a, b| a.0 < b.0));
            for (a, b) in line.iter().zip(line.iter().rev()) {
                assert!((a.0 + b.0).abs() < 1e-15 && (a.1 - b.1).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn counts_go_along_first() {
        let points = gauss_points(Quadrature::of(2, 5));
        assert_eq!(points.len(), Quadrature::of(2, 5).point_count());
        assert!(points[0].0[1] == points[1].0[1] && points[0].0[0] < points[1].0[0]);
        assert_eq!(Quadrature::of(2, 2), Quadrature::Reduced);
        assert_eq!(Quadrature::of(3, 3), Quadrature::Full);
    }
}
