//! What a curve says about parameters: singular values of the weighted derivatives, and the covariance that follows.

use nalgebra::{DMatrix, SVD};

/// A singular value below this share of the largest is rounding: the curve says nothing about its direction.
const ROUNDING: f64 = 1e-10;
/// Iterations of the singular values; some for each are usual.
const MOST_ITERATIONS: usize = 1000;

/// Singular values, the largest first, and their right singular vectors, of a matrix given by its columns, which are all of
/// one length; zeros where they cannot be had, as with entries that are not finite.
pub fn singular_values(columns: &[Vec<f64>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let (rows, n) = (columns.first().map_or(0, Vec::len), columns.len());
    let nothing = || (vec![0.0; n], DMatrix::identity(n, n));
    let finite = columns.iter().flatten().all(|entry| entry.is_finite());
    // As many rows as columns at least, so that there is a value for each column.
    let entry = |row: usize, column: usize| columns[column].get(row).copied().unwrap_or(0.0);
    let matrix = DMatrix::from_fn(rows.max(n), n, entry);
    let found = if finite && n > 0 {
        SVD::try_new(matrix, false, true, f64::EPSILON, MOST_ITERATIONS)
    } else {
        None
    };
    let (values, vectors) = found
        .and_then(|svd| Some((svd.singular_values.as_slice().to_vec(), svd.v_t?)))
        .unwrap_or_else(nothing);
    let vectors = vectors.row_iter().map(|row| row.iter().copied().collect());
    (values, vectors.collect())
}

/// The scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// How well parameters are determined; all in the parameters' scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Singular values of the weighted derivatives, the largest first: 1 / s is the standard error along its direction.
    pub singular_values: Vec<f64>,
    /// The directions, of length 1.
    pub directions: Vec<Vec<f64>>,
    /// The inverse of the normal matrix JᵀWJ; infinite where the curve says nothing.
    pub covariance: Vec<Vec<f64>>,
}

impl Statistics {
    /// From the derivatives of all weighted residuals by each parameter.
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let (singular_values, directions) = singular_values(columns);
        let n = columns.len();
        let floor = ROUNDING * singular_values.first().copied().unwrap_or_default();
        let entry = |i: usize, k: usize| {
            let of_direction = |(&s, v): (&f64, &Vec<f64>)| match v[i] * v[k] {
                // A direction without any influence, and rounding in what is not part of it.
                part if s > floor => part / (s * s),
                part if part.abs() < ROUNDING => 0.0,
                part => part.signum() * f64::INFINITY,
            };
            singular_values
                .iter()
                .zip(&directions)
                .map(of_direction)
                .sum()
        };
        let covariance = (0..n)
            .map(|i| (0..n).map(|k| entry(i, k)).collect())
            .collect();
        Self {
            singular_values,
            directions,
            covariance,
        }
    }

    /// Standard error of each parameter.
    pub fn standard_errors(&self) -> Vec<f64> {
        (0..self.covariance.len())
            .map(|i| self.covariance[i][i].sqrt())
            .collect()
    }

    /// Correlation of two parameters; not a number where one of them is not determined at all.
    pub fn correlation(&self, i: usize, k: usize) -> f64 {
        self.covariance[i][k] / (self.covariance[i][i] * self.covariance[k][k]).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_matrix_has_its_singular_values() {
        // (3 0; 4 5): the product is 15, the sum of squares 50.
        let (values, vectors) = singular_values(&[vec![3.0, 4.0], vec![0.0, 5.0]]);
        assert!(
            (values[0] - 45f64.sqrt()).abs() < 1e-14 && (values[1] - 5f64.sqrt()).abs() < 1e-14
        );
        assert!((vectors[0][0].abs() - 0.5f64.sqrt()).abs() < 1e-14);
        assert!(dot(&vectors[0], &vectors[1]).abs() < 1e-15);
    }

    #[test]
    fn a_small_singular_value_keeps_its_digits() {
        let columns = [vec![1.0, 0.0, 0.0], vec![1.0, 1e-9, 0.0]];
        let (values, _) = singular_values(&columns);
        assert!(
            (values[1] * values[0] / 1e-9 - 1.0).abs() < 1e-6,
            "{values:?}"
        );
    }

    #[test]
    fn what_is_not_finite_says_nothing() {
        let statistics = Statistics::of(&[vec![1.0, f64::NAN], vec![0.5, -1.0]]);
        assert!(statistics.standard_errors().iter().all(|e| e.is_infinite()));
        assert!(singular_values(&[]).0.is_empty());
    }

    #[test]
    fn the_covariance_is_the_inverse_of_the_normal_matrix() {
        let columns = [vec![1.0, 2.0, 2.0], vec![0.5, -1.0, 3.0]];
        let statistics = Statistics::of(&columns);
        for i in 0..2 {
            for k in 0..2 {
                let product: f64 = (0..2)
                    .map(|j| statistics.covariance[i][j] * dot(&columns[j], &columns[k]))
                    .sum();
                assert!((product - f64::from(u8::from(i == k))).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn two_parameters_with_one_effect_are_not_determined_and_a_third_one_is() {
        let columns = [
            vec![1.0, 2.0, 0.0],
            vec![2.0, 4.0, 0.0],
            vec![0.0, 0.0, 10.0],
        ];
        let errors = Statistics::of(&columns).standard_errors();
        assert!(errors[0].is_infinite() && errors[1].is_infinite());
        assert!((errors[2] - 0.1).abs() < 1e-14);
    }
}
