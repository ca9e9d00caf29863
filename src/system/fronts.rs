//! Slices of the sheet eliminated by dense matrices, before a sparse solver sees what is left.
//!
//! A sheet is long and thin: neighbouring columns of elements share one line of nodes across it and nothing else. So the
//! matrix is block tridiagonal, and one column after the other is eliminated, with the line to those before it (the frontal
//! method; Irons 1970, Int. J. Numer. Methods Eng. 2, 5-32). With I the unknowns that no later slice touches and O the others
//! of a front, it leaves for the next one
//!
//! ```text
//! A_OO - A_OI A_II⁻¹ A_IO   and   b_O - A_OI A_II⁻¹ b_I,   and then   x_I = A_II⁻¹ (b_I - A_IO x_O)
//! ```
//!
//! A sparse solver, which does not know of the columns, works in fronts of some six pivots each, and sorts the entries into
//! them anew in every factorisation.

use petsc::FactorKind;

use super::condensation::{CondensedEntries, CondensedPattern};
use super::dense::PartialFactors;
use super::elimination_order::EliminationOrder;
use super::front::Front;

/// The elimination on one rank, slice after slice.
pub(super) struct Fronts {
    kind: FactorKind,
    fronts: Vec<Front>,
    /// Numbers of the entries that no front takes.
    passed: Vec<usize>,
    /// The entries that are left: these, then those of the last front row by row.
    rest: Vec<f64>,
    /// Unknowns that no front eliminates.
    left: Vec<usize>,
    /// Of one front at a time: its matrix, what it leaves, and its part of a vector.
    matrix: Vec<f64>,
    left_over: Vec<f64>,
    vector: Vec<f64>,
}

impl Fronts {
    /// For the pattern of one rank's entries, of whose unknowns those `kept` are not eliminated. Returns the pattern of what
    /// is left, its unknowns numbered as in [`Fronts::left`].
    pub(super) fn new(
        pattern: &CondensedPattern,
        kept: &[bool],
        kind: FactorKind,
    ) -> (Self, CondensedPattern) {
        let order = EliminationOrder::new(pattern, kept);
        let (fronts, passed) = Front::all(pattern, &order, kind);
        let outer = fronts.last().map_or(&[][..], Front::outer);
        let place = |unknown: usize| match order.step[unknown] {
            None => (order.place[unknown] + order.left.len() - kept.len()) as i32,
            Some(_) => -1,
        };
        let passed_on = |indices: &[i32]| -> Vec<i32> {
            let indices = passed.iter().map(|&number| indices[number]);
            let places = indices.map(|index| usize::try_from(index).map_or(-1, place));
            places.collect()
        };
        let mut rest = CondensedPattern {
            rows: passed_on(&pattern.rows),
            columns: passed_on(&pattern.columns),
            ..CondensedPattern::default()
        };
        for &row in outer {
            rest.rows.extend(outer.iter().map(|_| place(row)));
            rest.columns
                .extend(outer.iter().map(|&column| place(column)));
        }
        let room = |size: fn(&Front) -> usize| fronts.iter().map(size).max().unwrap_or(0);
        let (matrix, vector) = (room(Front::room), room(Front::stride));
        let outer = room(|front| front.outer().len());
        let this = Self {
            kind,
            passed,
            rest: vec![0.0; rest.rows.len()],
            matrix: vec![0.0; matrix],
            left_over: vec![0.0; outer * outer],
            vector: vec![0.0; vector],
            left: order.left,
            fronts,
        };
        (this, rest)
    }

    /// The unknowns that are left.
    pub(super) fn left(&self) -> &[usize] {
        &self.left
    }

    /// Eliminates for entries in the order of the pattern. Returns those that are left, none if a front is singular.
    pub(super) fn eliminate(&mut self, entries: CondensedEntries<'_>) -> Option<&[f64]> {
        for front in &mut self.fronts {
            if !front.eliminate(entries, &mut self.left_over, &mut self.matrix) {
                return None;
            }
        }
        let (passed, last) = self.rest.split_at_mut(self.passed.len());
        for (value, &number) in passed.iter_mut().zip(&self.passed) {
            *value = entries.get(number);
        }
        let size = self.fronts.last().map_or(0, |front| front.outer().len());
        for (at, value) in last.iter_mut().enumerate() {
            let [i, j] = [at / size, at % size];
            let upper = match self.kind {
                FactorKind::Symmetric => i.min(j) * size + i.max(j),
                FactorKind::General => at,
            };
            *value = self.left_over[upper];
        }
        Some(&self.rest)
    }

    /// Takes the right-hand side `b` to that of the unknowns left; in the others' places it keeps what
    /// [`Fronts::backward`] needs.
    pub(super) fn forward(&mut self, b: &mut [f64]) {
        for front in &self.fronts {
            front.visit(b, &mut self.vector, PartialFactors::forward);
        }
    }

    /// Completes the solution `x` of the unknowns left.
    pub(super) fn backward(&mut self, x: &mut [f64]) {
        for front in self.fronts.iter().rev() {
            front.visit(x, &mut self.vector, PartialFactors::backward);
        }
    }
}
