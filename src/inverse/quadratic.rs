//! The sum of squares around a run as a quadratic: what its derivatives say, and what runs beside it add.
//!
//! Gauss and Newton take the residuals as linear. Along a direction the curve hardly tells, the second derivatives times the
//! noise that is left in the residuals are the larger part of the curvature: the steps go to and fro across the minimum,
//! and their length says nothing of the way to it. The difference of the derivatives of two runs shows that part
//! (Dennis, Gay and Welsch, ACM Trans. Math. Softw. 7, 1981, 348-368; here with the symmetric update of Powell).

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use super::search::Fit;
use super::statistics::{Statistics, dot};

/// Directions that the curve tells less than this share of the best one count as told by it: their squares have to be above rounding.
const ROUNDING: f64 = 1e-7;
/// How far the other run may be, in standard errors.
const REACH: f64 = 2.0;
/// Bounds that a step may meet or leave.
const MOST_CHANGES: usize = 50;

/// Half the sum of squares near a run.
pub(super) struct Quadratic {
    /// A step times this is its length in standard errors.
    errors: DMatrix<f64>,
    /// This and `errors` one below the other, times its transpose from the left, are the curvature.
    beyond: DMatrix<f64>,
    /// The step to the least value in the unit box.
    step: DVector<f64>,
    /// For each parameter that is at a bound and stays there the largest singular value, for the others zero.
    held: DVector<f64>,
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
        let beyond = root(curvature(n, &pairs)) * &errors;
        let hessian = errors.tr_mul(&errors) + beyond.tr_mul(&beyond);
        let step = bounded_step(&hessian, &DVector::from_vec(here.gradient()), &here.at);
        let stays = |k: usize| step[k] == 0.0 && (here.at[k] <= 0.0 || here.at[k] >= 1.0);
        Self {
            held: DVector::from_fn(n, |k, _| if stays(k) { best } else { 0.0 }),
            errors,
            beyond,
            step,
        }
    }

    /// Rows below the derivatives that bring the curvature in, without any residual: two for each parameter. Those of a held
    /// parameter are stiff; a step cut off at its bound would leave the valley by what the others do with it.
    pub fn rows(&self) -> Vec<f64> {
        let mut rows = self.beyond.transpose().as_slice().to_vec();
        rows.extend_from_slice(DMatrix::from_diagonal(&self.held).as_slice());
        rows
    }

    /// How far the least value within the unit box is, in standard errors.
    pub fn way(&self) -> f64 {
        (&self.errors * &self.step).norm()
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
        match first {
            Some((k, bound, share)) if share < 1.0 => {
                (step[k], held[k]) = (bound, true);
                continue;
            }
            _ => {}
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A run with these residuals and derivatives.
    fn fit(at: &[f64], residual: Vec<f64>, columns: Vec<Vec<f64>>) -> Fit {
        let (values, folder, records) = (Vec::new(), String::new(), Vec::new());
        Fit {
            at: at.to_vec(),
            values,
            folder,
            records,
            residual,
            columns,
        }
    }

    /// A line of slope 10 and, apart from it, what the model cannot meet: its bend times the rest of 3 is a curvature of 6b.
    fn bent(bend: f64, x: f64) -> Fit {
        let residual = vec![10.0 * x - 5.0, 3.0 + bend * (x - 0.5).powi(2)];
        fit(&[x], residual, vec![vec![10.0, 2.0 * bend * (x - 0.5)]])
    }

    #[test]
    fn a_run_beside_shows_the_curvature_that_the_derivatives_do_not() {
        let (here, beside) = (bent(50.0, 0.52), bent(50.0, 0.54));
        let alone = Quadratic::around(&here, [].into_iter()).way();
        let both = Quadratic::around(&here, [&beside].into_iter()).way();
        let error = (100.0 + 2.0_f64.powi(2)).sqrt();
        // The minimum is at 0.5: Gauss and Newton go four times as far. The difference is the curvature between the runs.
        assert!((both / (0.02 * error) - 1.0).abs() < 0.02, "{both}");
        assert!(alone > 0.075 * error, "{alone}");
    }

    #[test]
    fn what_bends_downwards_or_is_far_away_adds_nothing() {
        let here = bent(-5.0, 0.52);
        let alone = Quadratic::around(&here, [].into_iter()).way();
        for beside in [bent(-5.0, 0.54), bent(-5.0, 0.9)] {
            let both = Quadratic::around(&here, [&beside].into_iter());
            assert_eq!(both.way(), alone);
            assert!(both.rows().iter().all(|entry| *entry == 0.0));
        }
    }

    #[test]
    fn steps_along_each_axis_show_a_whole_matrix() {
        let wanted = DMatrix::from_row_slice(2, 2, &[3.0, -1.0, -1.0, 2.0]);
        let steps = [[0.5, 0.1], [-0.2, 0.3]].map(|s| DVector::from_row_slice(&s));
        let in_turn = steps.iter().cycle().take(80);
        let pairs: Vec<_> = in_turn.map(|s| (s.clone(), &wanted * s)).collect();
        assert!((curvature(2, &pairs) - &wanted).norm() < 1e-9);
        // After one round the last step is exact.
        let once = curvature(2, &pairs[..2]);
        assert!((&once * &steps[1] - &wanted * &steps[1]).norm() < 1e-14);
        assert_eq!(once, once.transpose());
    }

    #[test]
    fn a_bound_in_the_way_changes_the_others_along_the_valley() {
        // A valley along x = y, and the least value beyond both bounds.
        let hessian = DMatrix::from_row_slice(2, 2, &[101.0, -100.0, -100.0, 101.0]);
        let gradient = DVector::from_row_slice(&[-1.0, -1.0]);
        let step = bounded_step(&hessian, &gradient, &[1.0, 0.4]);
        // The first stays, the second goes to where its own slope ends, and not to its bound.
        assert_eq!(step[0], 0.0);
        assert!((step[1] - 1.0 / 101.0).abs() < 1e-14, "{step}");
        // A parameter at its bound is let go where that is the way down.
        let inwards = bounded_step(&hessian, &-gradient, &[1.0, 0.4]);
        assert!(
            inwards[0] < 0.0 && (inwards[1] + 0.4).abs() < 1e-14,
            "{inwards}"
        );
    }

    #[test]
    fn where_every_parameter_stays_at_its_bound_no_way_is_left() {
        let here = fit(&[1.0], vec![-2.0, 0.0], vec![vec![4.0, 3.0]]);
        let around = Quadratic::around(&here, [].into_iter());
        assert_eq!(around.way(), 0.0);
        assert_eq!(around.rows(), [0.0, 5.0]);
    }

    #[test]
    fn a_parameter_that_stays_at_its_bound_has_a_stiff_row() {
        let columns = vec![vec![10.0, -10.0, 1.0], vec![-10.0, 10.0, 1.0]];
        let here = fit(&[1.0, 0.4], vec![0.0, 0.0, -1.0], columns);
        let rows = Quadratic::around(&here, [].into_iter()).rows();
        assert_eq!(rows[..4], [0.0; 4]);
        // As stiff as the best told direction: across the valley the derivative is 20 of each difference, over √2.
        assert!((rows[4] - 20.0).abs() < 1e-12, "{rows:?}");
        assert_eq!(rows[5..], [0.0; 3]);
    }

    #[test]
    fn a_parameter_without_influence_is_nowhere_to_go() {
        let here = fit(
            &[0.5, 0.5],
            vec![1.0, 0.0],
            vec![vec![4.0, 3.0], vec![0.0, 0.0]],
        );
        let way = Quadratic::around(&here, [].into_iter()).way();
        // The other one: gradient 4, curvature 25, standard error 1/5.
        assert!((way - 0.8).abs() < 1e-12, "{way}");
        // Two with one effect.
        let here = fit(
            &[0.5, 0.5],
            vec![1.0, 0.0],
            vec![vec![4.0, 3.0], vec![8.0, 6.0]],
        );
        let way = Quadratic::around(&here, [].into_iter()).way();
        assert!((way - 0.8).abs() < 1e-6, "{way}");
    }
}
