//! The weighted residuals of a measured curve and their derivatives, each from whole runs.

use super::InverseError;
use super::quadratic::Quadratic;
use super::runs::{Ran, Runs};
use super::statistics::dot;
use crate::case::{MeasuredPoint, Sought};
use crate::output::StepRecord;
use crate::ranks::from_first;
use crate::sensitivity::Slopes;
use crate::text::{number, rounded};

/// Step of a difference between two runs, as a share of the width of the bounds: far above what Newton's tolerance leaves
/// in the forces, and short against any curvature.
const DIFFERENCE: f64 = 1e-3;
/// Digits of a value that is tried; what lies beyond comes from scaling forth and back.
const DIGITS: usize = 12;

/// A parameter counts as identified from this ratio of the width of its bounds to its standard error on, and a direction
/// from this singular value on: bounds alone, every value between them equally likely, are worth √12 = 3.5.
pub(super) const LEAST_SINGULAR_VALUE: f64 = 4.0;

/// A point of the search, in the unit box of the bounds.
#[derive(Clone)]
pub(super) struct Tried {
    at: Vec<f64>,
    /// None where the run was not solved to its end.
    fit: Option<Fit>,
}

/// How a run meets the measured curve.
#[derive(Clone)]
pub(super) struct Fit {
    /// Where it is in the unit box.
    pub at: Vec<f64>,
    pub values: Vec<f64>,
    pub folder: String,
    pub records: Vec<StepRecord>,
    /// Computed less measured force, divided by the uncertainty.
    pub residual: Vec<f64>,
    /// Derivatives of that by the scaled parameters, one list for each.
    pub columns: Vec<Vec<f64>>,
}

impl Fit {
    /// Sum of the squares of the residuals.
    pub fn chi_squared(&self) -> f64 {
        dot(&self.residual, &self.residual)
    }

    /// The derivatives, row by row.
    pub fn entries(&self) -> Vec<f64> {
        let row = |row: usize| self.columns.iter().map(move |column| column[row]);
        (0..self.residual.len()).flat_map(row).collect()
    }

    /// Gradient of half of it by the scaled parameters.
    pub fn gradient(&self) -> Vec<f64> {
        let columns = self.columns.iter();
        columns.map(|column| dot(column, &self.residual)).collect()
    }
}

/// The search: what is compared, and all that was tried.
pub(super) struct Search {
    pub runs: Runs,
    measured: Vec<MeasuredPoint>,
    tried: Vec<Tried>,
}

impl Search {
    pub fn new(runs: Runs, measured: Vec<MeasuredPoint>) -> Self {
        Self {
            runs,
            measured,
            tried: Vec::new(),
        }
    }

    pub fn measured(&self) -> &[MeasuredPoint] {
        &self.measured
    }

    /// The start in the unit box.
    pub fn start(&self) -> Vec<f64> {
        let scaled = |(sought, value): (&Sought, f64)| to_unit(sought, value);
        let parameters = self.runs.parameters().iter();
        parameters.zip(self.runs.start()).map(scaled).collect()
    }

    fn fits(&self) -> impl Iterator<Item = &Fit> {
        self.tried.iter().filter_map(|tried| tried.fit.as_ref())
    }

    /// The sum of squares around a fit, by all that was tried.
    pub fn around(&self, fit: &Fit) -> Quadratic {
        Quadratic::around(fit, self.fits())
    }

    /// How far the least sum of squares is from a fit, in standard errors: by the quadratic around it, and at least as far as a run with a
    /// smaller sum of squares shows.
    pub fn way_left(&self, fit: &Fit) -> f64 {
        let least = self.best().map_or(f64::INFINITY, Fit::chi_squared);
        let excess = (fit.chi_squared() - least).max(0.0);
        self.around(fit).way().max(excess.sqrt())
    }

    /// The point tried with the least sum of squares.
    pub fn best(&self) -> Option<&Fit> {
        self.fits()
            .min_by(|one, other| one.chi_squared().total_cmp(&other.chi_squared()))
    }

    /// The last point tried.
    pub fn last(&self) -> Option<&Fit> {
        self.tried.last()?.fit.as_ref()
    }

    /// The first point tried.
    pub fn first(&self) -> Option<&Fit> {
        self.tried.first()?.fit.as_ref()
    }

    /// The fit at a point of the unit box, by a run unless it was tried before. Collective.
    ///
    /// # Errors
    /// As [`Runs::next`].
    pub fn at(&mut self, at: &[f64]) -> Result<Option<&Fit>, InverseError> {
        if !self.tried.iter().any(|tried| tried.at == at) {
            let fit = self.run(at)?;
            self.tried.push(Tried {
                at: at.to_vec(),
                fit,
            });
            let said = match self.last() {
                Some(fit) => {
                    let mean = fit.chi_squared() / self.measured.len() as f64;
                    let way = self.way_left(fit);
                    format!(
                        "  misfit {}, way left {}\n",
                        number(mean.sqrt()),
                        number(way)
                    )
                }
                None => "  not solved to its end\n".to_owned(),
            };
            self.runs.show(&said);
        }
        Ok(self.known(at))
    }

    /// The fit at a point that was tried.
    pub fn known(&self, at: &[f64]) -> Option<&Fit> {
        let tried = self.tried.iter().find(|tried| tried.at == at)?;
        tried.fit.as_ref()
    }

    fn run(&mut self, at: &[f64]) -> Result<Option<Fit>, InverseError> {
        let values = self.values(at);
        let Some(ran) = self.runs.next(&values, 1, true)? else {
            return Ok(None);
        };
        let forces = self.forces(&ran);
        let mut columns = Vec::new();
        for (parameter, value) in values.iter().enumerate() {
            let column = match self.derivative(&ran, parameter, *value) {
                Some(column) => Some(column),
                None => self.difference(at, parameter, &forces)?,
            };
            match column {
                Some(column) => columns.push(column),
                None => return Ok(None),
            }
        }
        let weighted = forces
            .iter()
            .zip(&self.measured)
            .map(|(force, m)| (force - m.force) / m.uncertainty);
        Ok(Some(Fit {
            at: at.to_vec(),
            residual: weighted.collect(),
            values,
            columns,
            folder: ran.folder,
            records: ran.records,
        }))
    }

    /// Weighted derivative of the forces by a scaled parameter, if the run has it. Collective.
    fn derivative(&self, ran: &Ran, parameter: usize, value: f64) -> Option<Vec<f64>> {
        let sought = &self.runs.parameters()[parameter];
        let at = |m: &MeasuredPoint| {
            let slope = slopes_at(ran, sought.name, m.stroke)?.force;
            let slope = slope.is_finite().then_some(slope)?;
            Some(slope * stretch(sought, value) / m.uncertainty)
        };
        let mut column: Vec<f64> = self.measured.iter().map(at).collect::<Option<_>>()?;
        from_first(self.runs.comm(), &mut column);
        Some(column)
    }

    /// The same from one more run.
    fn difference(
        &mut self,
        at: &[f64],
        parameter: usize,
        forces: &[f64],
    ) -> Result<Option<Vec<f64>>, InverseError> {
        let mut beside = at.to_vec();
        let step = if at[parameter] > 0.5 {
            -DIFFERENCE
        } else {
            DIFFERENCE
        };
        beside[parameter] += step;
        self.runs.show("  difference\n");
        let Some(ran) = self.runs.next(&self.values(&beside), 1, false)? else {
            return Ok(None);
        };
        let others = self.forces(&ran);
        let slope = |((other, force), m): ((&f64, &f64), &MeasuredPoint)| {
            (other - force) / (step * m.uncertainty)
        };
        Ok(Some(
            others
                .iter()
                .zip(forces)
                .zip(&self.measured)
                .map(slope)
                .collect(),
        ))
    }

    /// The values of the parameters at a point of the unit box.
    fn values(&self, at: &[f64]) -> Vec<f64> {
        let value = |(sought, at): (&Sought, &f64)| {
            let value = rounded(from_unit(sought, *at), DIGITS);
            value.clamp(sought.lower, sought.upper)
        };
        self.runs.parameters().iter().zip(at).map(value).collect()
    }

    /// Forces at the measured strokes, to the last bit the same on every rank. Collective.
    fn forces(&self, ran: &Ran) -> Vec<f64> {
        let mut forces: Vec<f64> = self
            .measured
            .iter()
            .map(|m| at_stroke(&ran.records, m.stroke))
            .collect();
        from_first(self.runs.comm(), &mut forces);
        forces
    }
}

/// Width of the bounds of a parameter.
pub(super) fn width(sought: &Sought) -> f64 {
    sought.upper - sought.lower
}

/// Whether a parameter is scaled by its logarithm: bounds on one side of zero say that it is a matter of size. An exponent is none:
/// of log K + n log p it is a straight line of log K and n, not of their logarithms, that leaves a stress as it is, and the
/// valley of K and n is bent by many of its widths where n has its logarithm for a scale.
fn is_logarithmic(sought: &Sought) -> bool {
    sought.lower > 0.0 && !sought.is_exponent
}

/// The place of a value in the unit interval of its bounds.
fn to_unit(sought: &Sought, value: f64) -> f64 {
    if is_logarithmic(sought) {
        (value / sought.lower).ln() / (sought.upper / sought.lower).ln()
    } else {
        (value - sought.lower) / width(sought)
    }
}

/// The value at a place in the unit interval.
fn from_unit(sought: &Sought, at: f64) -> f64 {
    if is_logarithmic(sought) {
        sought.lower * (sought.upper / sought.lower).powf(at)
    } else {
        sought.lower + at * width(sought)
    }
}

/// The derivative of a value by its place.
pub(super) fn stretch(sought: &Sought, value: f64) -> f64 {
    if is_logarithmic(sought) {
        value * (sought.upper / sought.lower).ln()
    } else {
        width(sought)
    }
}

/// The force where a step of the way down has ended at this stroke (mm); steps are made to end there.
fn at_stroke(records: &[StepRecord], stroke: f64) -> f64 {
    nearest(records.iter().map(|record| record.stroke_mm), stroke)
        .and_then(|place| records.get(place))
        .map_or(f64::NAN, |record| record.force_N)
}

/// The derivatives there by a parameter, if the run has them.
fn slopes_at<'a>(ran: &'a Ran, name: &str, stroke: f64) -> Option<&'a Slopes> {
    let table = &ran.derivatives;
    let parameter = table
        .parameters
        .iter()
        .position(|known| known.name == name)?;
    let row = nearest(table.rows.iter().map(|row| row.stroke_mm), stroke)?;
    table.rows.get(row)?.by_parameter.get(parameter)
}

fn nearest(strokes: impl Iterator<Item = f64>, wanted: f64) -> Option<usize> {
    let distances = strokes.map(|stroke| (stroke - wanted).abs()).enumerate();
    let (place, _) = distances.min_by(|one, other| one.1.total_cmp(&other.1))?;
    Some(place)
}
