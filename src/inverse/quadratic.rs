//! The sum of squares around a run as a quadratic: what its derivatives say, and what runs beside it add.
//!
//! Gauss and Newton take the residuals as linear. Along a direction the curve hardly tells, the second derivatives times the
//! noise that is left in the residuals are the larger part of the curvature: the steps go to and fro across the minimum,
//! and their length says nothing of the way to it. The difference of the derivatives of two runs shows that part
//! (Dennis, Gay and Welsch, ACM Trans. Math. Softw. 7, 1981, 348-368; here with the symmetric update of Powell).

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use super::search::Fit;
use super::statistics::{Statistics, dot};

/// A direction counts as told by at least this share of the best one.
const ROUNDING: f64 = 1e-10;
/// How far the other run may be, in standard errors.
const REACH: f64 = 2.0;
/// Bounds that a step may meet or leave.
const MOST_CHANGES: usize = 50;

/// Half the sum of squares near a run.
pub(super) struct Quadratic {
    at: Vec<f64>,
    gradient: DVector<f64>,
    /// A step times this is its length in standard errors.
    errors: DMatrix<f64>,
    /// This and `errors` one below the other, times its transpose from the left, are the curvature.
    beyond: DMatrix<f64>,
}

impl Quadratic {
    /// Around `here`, with the curvature that the `others` within reach show.
    pub fn around<'a>(here: &Fit, others: impl Iterator<Item = &'a Fit>) -> Self {
        let n = here.at.len();
        let Statistics {
            singular_values,
            directions,
            ..
        } = Statistics::of(&here.columns);
        let best = singular_values.first().copied().unwrap_or_default();
        let floor = if best > 0.0 { ROUNDING * best } else { 1.0 };
        let told = |i: usize| singular_values[i].max(floor);
        let errors = DMatrix::from_fn(n, n, |i, k| told(i) * directions[i][k]);
        let back = DMatrix::from_fn(n, n, |i, k| directions[k][i] / told(k));
        let mut pairs: Vec<_> = others
            .map(|other| {
                let step = here.at.iter().zip(&other.at).map(|(a, b)| a - b);
                let change = here.columns.iter().zip(&other.columns);
                let change = change.map(|(a, b)| dot(a, &here.residual) - dot(b, &here.residual));
                let step = &errors * DVector::from_iterator(n, step);
                (step, back.transpose() * DVector::from_iterator(n, change))
            })
            .filter(|(step, _)| step.norm() > 0.0 && step.norm() <= REACH)
            .collect();
        // The nearest one has the last word.
        pairs.sort_by(|one, other| other.0.norm().total_cmp(&one.0.norm()));
        Self {
            at: here.at.clone(),
            gradient: DVector::from_vec(here.gradient()),
            beyond: root(curvature(n, &pairs)) * &errors,
            errors,
        }
    }

    /// Rows below the derivatives that bring the curvature in, without any residual.
    pub fn rows(&self) -> Vec<f64> {
        self.beyond.transpose().as_slice().to_vec()
    }

    /// How far the least value within the unit box is, in standard errors.
    pub fn way(&self) -> f64 {
        let hessian = self.errors.tr_mul(&self.errors) + self.beyond.tr_mul(&self.beyond);
        (&self.errors * bounded_step(&hessian, &self.gradient, &self.at)).norm()
    }
}

/// The least symmetric matrix that turns each step into its change, the last one exactly.
fn curvature(n: usize, pairs: &[(DVector<f64>, DVector<f64>)]) -> DMatrix<f64> {
    let mut found = DMatrix::zeros(n, n);
    for (step, change) in pairs {
        let square = step.norm_squared();
        let missing = change - &found * step;
        let crossed = &missing * step.transpose() / square;
        let share = missing.dot(step) / (square * square);
        found += &crossed + crossed.transpose() - step * step.transpose() * share;
    }
    found
}

/// A square root of the positive part: least squares have no place for a negative one.
fn root(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let SymmetricEigen {
        eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(matrix);
    DMatrix::from_diagonal(&eigenvalues.map(|value| value.max(0.0).sqrt()))
        * eigenvectors.transpose()
}

/// The step from `at` to the least value of `gradient·d + d·hessian d/2` in the unit box, by active sets.
fn bounded_step(hessian: &DMatrix<f64>, gradient: &DVector<f64>, at: &[f64]) -> DVector<f64> {
    let n = at.len();
    let mut step = DVector::zeros(n);
    let mut held: Vec<bool> = vec![false; n];
    for _ in 0..MOST_CHANGES {
        let free: Vec<usize> = (0..n).filter(|&k| !held[k]).collect();
        let slope = gradient + hessian * &step;
        let among = hessian.select_rows(&free).select_columns(&free);
        let Some(factor) = Cholesky::new(among) else {
            return step * f64::NAN;
        };
        let further = factor.solve(&-slope.select_rows(&free));
        let share = |(i, &k): (usize, &usize)| {
            let bound = if further[i] < 0.0 { 0.0 } else { 1.0 };
            (
                k,
                bound - at[k],
                ((bound - at[k] - step[k]) / further[i]).max(0.0),
            )
        };
        let shares = free
            .iter()
            .enumerate()
            .filter(|(i, _)| further[*i] != 0.0)
            .map(share);
        let first = shares.min_by(|one, other| one.2.total_cmp(&other.2));
        let way = first.map_or(1.0, |(.., share)| share.min(1.0));
        for (i, &k) in free.iter().enumerate() {
            step[k] += way * further[i];
        }
        if let Some((k, bound, share)) = first
            && share < 1.0
        {
            (step[k], held[k]) = (bound, true);
            continue;
        }
        let slope = gradient + hessian * &step;
        let inwards = |k: &usize| held[*k] && (slope[*k] < 0.0) == (step[*k] + at[*k] <= 0.5);
        let Some(released) = (0..n)
            .filter(inwards)
            .max_by(|&i, &k| slope[i].abs().total_cmp(&slope[k].abs()))
        else {
            break;
        };
        held[released] = false;
    }
    step
}
