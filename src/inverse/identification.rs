//! The identification of parameters from a measured curve: the search, what it found, and how well the curve tells it.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Session;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::fit::{Ended, fit, read_options};
use super::report;
use super::runs::Runs;
use super::search::{Fit, LEAST_SINGULAR_VALUE, Search, stretch};
use super::{InverseError, Statistics};
use crate::case::{Case, MeasuredPoint, Sought, read_measured};
use crate::output::{Tolerance, VerdictRow, VerdictTable};
use crate::ranks::agree_in_words;
use crate::run::{Ending, refuse_bad_options};

/// How far the search may stop from the least sum of squares, in standard errors.
const FARTHEST: f64 = 0.1;
/// How often chance may exceed the limit of the misfit.
const UNLIKELY: f64 = 1e-3;

/// What is known of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Estimate {
    pub name: &'static str,
    pub unit: &'static str,
    pub lower: f64,
    pub upper: f64,
    pub start: f64,
    pub estimate: f64,
    pub standard_error: f64,
    /// The standard error from which on it does not count as identified.
    pub longest_error: f64,
    pub identified: bool,
    pub at_bound: bool,
}

/// A point of the curve, N.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "the names hold the units")]
pub(super) struct Compared {
    pub stroke_mm: f64,
    pub measured_N: f64,
    pub uncertainty_N: f64,
    pub computed_N: f64,
}

/// The content of `identification.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Identification {
    pub measured_curve: String,
    pub ended: String,
    /// Whether the least sum of squares is near enough.
    pub converged: bool,
    pub runs: usize,
    pub seconds: f64,
    pub best_run: String,
    pub parameters: Vec<Estimate>,
    /// In the units of the parameters.
    pub covariance: Vec<Vec<f64>>,
    pub correlation: Vec<Vec<f64>>,
    /// Of the derivatives of the weighted residuals by the parameters, each parameter as a share of its bounds.
    pub singular_values: Vec<f64>,
    pub directions: Vec<Vec<f64>>,
    pub least_singular_value: f64,
    pub chi_squared: f64,
    pub degrees_of_freedom: usize,
    /// From the least sum of squares, in standard errors.
    pub distance: f64,
    pub verdicts: VerdictTable,
    pub curve: Vec<Compared>,
}

/// Identifies the parameters of a case from the curve at `path`. Collective.
///
/// # Errors
/// If the curve or a run is refused, or PETSc or a file fails; the same on every rank.
pub(super) fn identify(
    case: &Case,
    path: &str,
    session: &Rc<Session>,
    comm: &SimpleCommunicator,
) -> Result<Ending, InverseError> {
    let parameters = case.inverse.parameters.len();
    let measured = read_measured(path, case.loading.stroke, parameters);
    let measured = agree_in_words(comm, measured).map_err(InverseError::Agreed)?;
    read_options()?;
    refuse_bad_options(case, comm)?;
    let runs = Runs::new(&loading_only(case, &measured)?, session, comm)?;
    let search = Rc::new(RefCell::new(Search::new(runs, measured)));
    let outcome = look(&search);
    let search = Rc::into_inner(search).map(RefCell::into_inner);
    match (outcome, search) {
        (Ok(ended), Some(mut search)) => conclude(path, &ended, &mut search),
        (Err(InverseError::Interrupted), Some(mut search)) => {
            search.runs.tell(&report::interrupted(search.runs.made()));
            Ok(Ending::Interrupted)
        }
        (Err(error), _) => Err(error),
        (Ok(_), None) => Err(InverseError::Agreed(
            "the optimiser still holds the search".to_owned(),
        )),
    }
}

/// The way down as far as it was measured, at the same speed, with a step that ends at each measured stroke.
fn loading_only(case: &Case, measured: &[MeasuredPoint]) -> Result<Case, InverseError> {
    let last = measured
        .last()
        .map_or(case.loading.stroke, |point| point.stroke);
    let time = case.loading.motion().time_at_depth(last);
    let mut case = case.with(&[
        ("stroke", last),
        ("time_load", time),
        ("unload_fraction", 0.0),
    ])?;
    case.stepping.report_strokes = measured.iter().map(|point| point.stroke).collect();
    case.output.every = 0;
    Ok(case)
}

fn look(search: &Rc<RefCell<Search>>) -> Result<Ended, InverseError> {
    let start = search.borrow().start();
    if search.borrow_mut().at(&start)?.is_none() {
        let folder = search
            .borrow()
            .runs
            .folder()
            .file("run-001")
            .display()
            .to_string();
        return Err(InverseError::NoStart { folder });
    }
    fit(search, FARTHEST)
}

fn conclude(path: &str, ended: &Ended, search: &mut Search) -> Result<Ending, InverseError> {
    let best = match ended {
        Ended::Near => search.last(),
        _ => search.best(),
    };
    let Some(best) = best else {
        return Err(InverseError::Agreed(
            "no run was solved to its end".to_owned(),
        ));
    };
    let found = Identification::new(path, ended, search, best);
    let start = search.first().map_or(&best.records, |fit| &fit.records);
    let figure = report::Figure {
        best: &best.records,
        start,
        measured: search.measured(),
    };
    let mine = match search.runs.comm().rank() {
        0 => report::write(search.runs.folder(), &found, &figure),
        _ => Ok(()),
    };
    agree_in_words(search.runs.comm(), mine).map_err(InverseError::Agreed)?;
    let text = report::text(&found, search.runs.folder());
    search.runs.tell(&text);
    Ok(if found.verdicts.all_hold() {
        Ending::Holds
    } else {
        Ending::DoesNotHold
    })
}

impl Identification {
    fn new(path: &str, ended: &Ended, search: &Search, best: &Fit) -> Self {
        let sought = search.runs.parameters();
        let statistics = Statistics::of(&best.columns);
        let errors = statistics.standard_errors();
        let with_value = sought.iter().zip(&best.values);
        let stretches: Vec<f64> = with_value.map(|(s, value)| stretch(s, *value)).collect();
        let estimate = |k: usize, s: &Sought| Estimate {
            name: s.name,
            unit: s.unit,
            lower: s.lower,
            upper: s.upper,
            start: search.runs.start()[k],
            estimate: best.values[k],
            standard_error: errors[k] * stretches[k],
            longest_error: stretches[k] / LEAST_SINGULAR_VALUE,
            identified: errors[k] * LEAST_SINGULAR_VALUE <= 1.0,
            at_bound: best.at[k] <= 0.0 || best.at[k] >= 1.0,
        };
        let parameters: Vec<Estimate> = (0..).zip(sought).map(|(k, s)| estimate(k, s)).collect();
        let pairs = |value: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            let row = |i| (0..sought.len()).map(|k| value(i, k)).collect();
            (0..sought.len()).map(row).collect()
        };
        let covariance =
            |i: usize, k: usize| statistics.covariance[i][k] * stretches[i] * stretches[k];
        let points = search.measured();
        let compared = |(point, residual): (&MeasuredPoint, &f64)| Compared {
            stroke_mm: point.stroke,
            measured_N: point.force,
            uncertainty_N: point.uncertainty,
            computed_N: point.force + residual * point.uncertainty,
        };
        let distance = search.way_left(best);
        let degrees_of_freedom = points.len() - sought.len();
        Self {
            measured_curve: path.to_owned(),
            ended: ended.sentence(),
            converged: distance <= FARTHEST,
            runs: search.runs.made(),
            seconds: search.runs.seconds(),
            best_run: best.folder.clone(),
            verdicts: verdicts(
                distance,
                best.chi_squared(),
                degrees_of_freedom,
                &parameters,
            ),
            parameters,
            covariance: pairs(&covariance),
            correlation: pairs(&|i, k| statistics.correlation(i, k)),
            singular_values: statistics.singular_values.clone(),
            directions: statistics.directions.clone(),
            least_singular_value: LEAST_SINGULAR_VALUE,
            chi_squared: best.chi_squared(),
            degrees_of_freedom,
            distance,
            curve: points.iter().zip(&best.residual).map(compared).collect(),
        }
    }
}

fn verdicts(
    distance: f64,
    chi_squared: f64,
    freedom: usize,
    parameters: &[Estimate],
) -> VerdictTable {
    let at_most = |quantity: String, computed, limit, unit: &str, source: &str| {
        VerdictRow::new(quantity, computed, limit, Tolerance::AtMost, unit, source)
    };
    let mut rows = vec![
        at_most(
            "way left to the best fit".to_owned(),
            distance,
            FARTHEST,
            "standard errors",
            "search",
        ),
        at_most(
            "square of the misfit".to_owned(),
            chi_squared / freedom as f64,
            largest_chi_squared(freedom) / freedom as f64,
            "",
            "uncertainty: exceeded by chance once in 1000",
        ),
    ];
    rows.extend(parameters.iter().map(|one| {
        let quantity = format!("standard error of {}", one.name);
        at_most(
            quantity,
            one.standard_error,
            one.longest_error,
            one.unit,
            "a quarter of its bounds",
        )
    }));
    VerdictTable { rows }
}

/// What χ² exceeds by chance once in 1000; nothing to test where no degree of freedom is left.
fn largest_chi_squared(freedom: usize) -> f64 {
    ChiSquared::new(freedom as f64).map_or(f64::NAN, |law| law.inverse_cdf(1.0 - UNLIKELY))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_the_misfit_is_that_of_the_tables() {
        for (freedom, table) in [(1, 10.828), (10, 29.588), (40, 73.402), (100, 149.449)] {
            assert!((largest_chi_squared(freedom) - table).abs() < 5.1e-4);
        }
    }
}
