//! Slices of the sheet eliminated by dense matrices, before a sparse solver sees what is left.
//!
//! A sheet is long and thin: neighbouring columns of elements share one line of nodes across it and nothing else. What lies
//! inside each column is eliminated at once, then the line between two columns, then the one between two pairs of columns,
//! and so on (nested dissection; George 1973, SIAM J. Numer. Anal. 10, 345-363). With I the unknowns inside a slice and O
//! those on its ends, a slice leaves for the next layer
//!
//! ```text
//! A_OO - A_OI A_II⁻¹ A_IO   and   b_O - A_OI A_II⁻¹ b_I,   and then   x_I = A_II⁻¹ (b_I - A_IO x_O)
//! ```
//!
//! A sparse solver finds the same pieces by itself, but in fronts of some six pivots each, and sorts the entries into them
//! anew in every factorisation.

use petsc::FactorKind;

use super::condensation::{CondensedEntries, CondensedPattern};
use super::dense::PartialFactors;
use super::elimination_order::EliminationOrder;
use super::front::{Below, Front};

/// The elimination on one rank, layer by layer.
pub(super) struct Fronts {
    kind: FactorKind,
    layers: Vec<Layer>,
    /// The entries themselves, where there is no layer.
    untouched: Vec<f64>,
    /// Unknowns that no layer eliminates.
    left: Vec<usize>,
    /// Rows of one front, and its part of a right-hand side.
    rows: Vec<f64>,
    vector: Vec<f64>,
}

struct Layer {
    fronts: Vec<Front>,
    /// The entries it leaves, front by front and row by row.
    values: Vec<f64>,
}

impl Fronts {
    /// For the pattern of one rank's entries, of whose unknowns those `kept` are not eliminated. Returns the pattern of what
    /// is left, its unknowns numbered as in [`Fronts::left`].
    pub(super) fn new(
        pattern: CondensedPattern,
        kept: &[bool],
        kind: FactorKind,
    ) -> (Self, CondensedPattern) {
        let order = EliminationOrder::new(&pattern, kept);
        let mut layers = Vec::with_capacity(order.layers);
        if order.layers > 0 {
            layers.push(Layer::new(Front::of_entries(&pattern, &order, kind)));
        }
        while let Some(below) = layers.last().filter(|_| layers.len() < order.layers) {
            let pairs = below.fronts.chunks(2);
            let layer = layers.len();
            let fronts = pairs.map(|pair| Front::of_parts(pair, &order, layer, kind));
            layers.push(Layer::new(fronts.collect()));
        }
        let fronts = layers.iter().flat_map(|layer| &layer.fronts);
        let largest = fronts
            .map(|front| front.unknowns().len())
            .max()
            .unwrap_or(0);
        let left = order.left;
        let mut place = vec![-1; kept.len()];
        for (new, &old) in left.iter().enumerate() {
            place[old] = new as i32;
        }
        let mut rest = pattern;
        if let Some(last) = layers.last() {
            rest = CondensedPattern::default();
            for front in &last.fronts {
                for &row in front.outer() {
                    rest.rows.extend(front.outer().iter().map(|_| row as i32));
                    let columns = front.outer().iter().map(|&column| column as i32);
                    rest.columns.extend(columns);
                }
            }
        }
        for index in rest.rows.iter_mut().chain(&mut rest.columns) {
            *index = usize::try_from(*index).map_or(-1, |old| place[old]);
        }
        let untouched = if layers.is_empty() {
            rest.rows.len()
        } else {
            0
        };
        let this = Self {
            kind,
            rows: vec![0.0; largest * largest],
            vector: vec![0.0; largest],
            untouched: vec![0.0; untouched],
            layers,
            left,
        };
        (this, rest)
    }

    /// The unknowns that are left.
    pub(super) fn left(&self) -> &[usize] {
        &self.left
    }

    /// Eliminates for entries in the order of the pattern. Returns those that are left, none if a front is singular.
    pub(super) fn eliminate(&mut self, entries: CondensedEntries<'_>) -> Option<&[f64]> {
        let last = self.layers.len();
        if last == 0 {
            entries.copy_to(&mut self.untouched);
            return Some(&self.untouched);
        }
        let mut below = Below::Entries(entries);
        for (number, Layer { fronts, values }) in self.layers.iter_mut().enumerate() {
            let mirrored = self.kind == FactorKind::Symmetric && number + 1 == last;
            for front in fronts {
                if !front.eliminate(below, &mut self.rows, values) {
                    return None;
                }
                if mirrored {
                    front.mirror(values);
                }
            }
            below = Below::Layer(values);
        }
        self.layers.last().map(|layer| &layer.values[..])
    }

    /// Takes the right-hand side `b` to that of the unknowns left; in the others' places it keeps what
    /// [`Fronts::backward`] needs.
    pub(super) fn forward(&mut self, b: &mut [f64]) {
        for front in self.layers.iter().flat_map(|layer| &layer.fronts) {
            front.visit(b, &mut self.vector, PartialFactors::forward);
        }
    }

    /// Completes the solution `x` of the unknowns left.
    pub(super) fn backward(&mut self, x: &mut [f64]) {
        for front in self.layers.iter().rev().flat_map(|layer| &layer.fronts) {
            front.visit(x, &mut self.vector, PartialFactors::backward);
        }
    }
}

impl Layer {
    fn new(mut fronts: Vec<Front>) -> Self {
        let mut size = 0;
        for front in &mut fronts {
            size = front.leave_from(size);
        }
        let values = vec![0.0; size];
        Self { fronts, values }
    }
}
