//! Some unknowns of a small dense system eliminated: factors for them, and what they leave for the others.
//!
//! The matrix is n x n, row by row, and its first p unknowns are eliminated, four at a time (right-looking; Golub and Van Loan
//! 2013, Matrix Computations, sections 3.2 and 4.1). These loops stand here because safe Rust does not reach PETSc's BLAS, which
//! for some fifty unknowns is no faster. A row is followed by zeros up to a multiple of four, so that whole vectors fit.

mod elimination;
mod rows;

use std::array;
use std::mem::take;
use std::ops::Range;

use petsc::FactorKind;
use pulp::{Arch, Simd, WithSimd};

use self::elimination::Elimination;
use self::rows::{add_multiples, products};

/// Pivots that are eliminated together; vectors divide it.
const PANEL: usize = 4;

/// The factors of the unknowns eliminated.
pub(super) struct PartialFactors {
    kind: FactorKind,
    /// p and n.
    eliminated: usize,
    size: usize,
    /// Panel by panel and row by row: D Lᵀ or U, from the first column of the panel on, where L of a general matrix stands left
    /// of the diagonal.
    upper: Vec<f64>,
    /// L of a general matrix before that column, then that in the rows of the others. Of a symmetric one `upper` holds it.
    lower: Vec<f64>,
    /// The row that changed places with each; itself for a symmetric matrix.
    swapped: Vec<usize>,
}

impl PartialFactors {
    /// For matrices of `size` rows, of whose unknowns the first ones are to be eliminated. A symmetric matrix, of which
    /// only the upper triangle is read, is taken for one that needs no pivoting.
    pub(super) fn new(kind: FactorKind, eliminated: usize, size: usize) -> Self {
        let stride = stride(size);
        let upper = panels(&(0..eliminated)).map(|panel| panel.len() * (stride - panel.start));
        let lower = match kind {
            FactorKind::Symmetric => 0,
            FactorKind::General => before(eliminated) + (size - eliminated) * eliminated,
        };
        Self {
            kind,
            eliminated,
            size,
            upper: vec![0.0; upper.sum()],
            lower: vec![0.0; lower],
            swapped: (0..eliminated).collect(),
        }
    }

    /// Whether the matrix is symmetric.
    pub(super) fn kind(&self) -> FactorKind {
        self.kind
    }

    /// The number of unknowns to be eliminated.
    pub(super) fn eliminated(&self) -> usize {
        self.eliminated
    }

    /// How far rows of the matrix are apart, and the length of a vector with the zeros behind it.
    pub(super) fn stride(&self) -> usize {
        stride(self.size)
    }

    /// Factorises a matrix, in whose rows and columns of the others it puts what is left for them; of a symmetric matrix in the
    /// upper triangle only. Says whether every pivot can be used.
    pub(super) fn factor(&mut self, matrix: &mut [f64]) -> bool {
        let (p, stride) = (self.eliminated, self.stride());
        Arch::new().dispatch(Elimination {
            kind: self.kind,
            swapped: &mut self.swapped,
            matrix,
            stride,
        });
        let (mut upper, mut lower) = (&mut self.upper[..], &mut self.lower[..]);
        for (k, row) in matrix.chunks_exact(stride.max(1)).enumerate() {
            let (left, right) = row.split_at(if k < p { k / PANEL * PANEL } else { p });
            if self.kind == FactorKind::General {
                copy_to_first(&mut lower, left);
            }
            if k < p {
                copy_to_first(&mut upper, right);
            }
        }
        let mut pivots = (0..p).map(|k| matrix[k * stride + k]);
        pivots.all(|pivot| pivot != 0.0 && pivot.is_finite())
    }

    /// The forward substitution: takes the right-hand side `b` of the others to that of what is left.
    pub(super) fn forward(&self, b: &mut [f64]) {
        let factors = self;
        Arch::new().dispatch(Forward { factors, b });
    }

    /// The backward substitution: completes the others' solution in `x`.
    pub(super) fn backward(&self, x: &mut [f64]) {
        let factors = self;
        Arch::new().dispatch(Backward { factors, x });
    }

    /// What `upper` holds of a panel.
    #[inline(always)]
    fn upper_rows(&self, panel: &Range<usize>) -> [&[f64]; PANEL] {
        let start = panel.start * self.stride() - before(panel.start);
        let width = self.stride() - panel.start;
        rows_of(&self.upper[start..], width, 0..panel.len())
    }

    /// What `lower` holds of a panel.
    #[inline(always)]
    fn lower_rows(&self, panel: &Range<usize>) -> [&[f64]; PANEL] {
        let rows = &self.lower[before(panel.start)..];
        rows_of(rows, panel.start, 0..panel.len())
    }
}

/// How far rows of a matrix are apart.
fn stride(size: usize) -> usize {
    size.next_multiple_of(PANEL)
}

/// Pivots, panel by panel.
fn panels(pivots: &Range<usize>) -> impl DoubleEndedIterator<Item = Range<usize>> + use<> {
    let Range { start, end } = *pivots;
    let first = move |n| start + PANEL * n;
    (0..pivots.len().div_ceil(PANEL)).map(move |n| first(n)..end.min(first(n + 1)))
}

/// How many entries stand before the first columns of their panels, in this number of rows.
fn before(rows: usize) -> usize {
    let whole = rows / PANEL * PANEL;
    whole * whole.saturating_sub(PANEL) / 2 + (rows - whole) * whole
}

/// Copies values to the first places, and takes these away from the others.
fn copy_to_first(places: &mut &mut [f64], values: &[f64]) {
    let (first, others) = take(places).split_at_mut(values.len());
    first.copy_from_slice(values);
    *places = others;
}

struct Forward<'a> {
    factors: &'a PartialFactors,
    b: &'a mut [f64],
}

struct Backward<'a> {
    factors: &'a PartialFactors,
    x: &'a mut [f64],
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factors, b } = self;
        match factors.kind {
            FactorKind::Symmetric => symmetric_forward(simd, factors, b),
            FactorKind::General => general_forward(simd, factors, b),
        }
    }
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factors, x } = self;
        for panel in panels(&(0..factors.eliminated)).rev() {
            let rows = factors.upper_rows(&panel);
            let (x, known) = x[panel.start..].split_at_mut(panel.len());
            let sums = products(simd, rows.map(|row| &row[panel.len()..]), known);
            for k in (0..x.len()).rev() {
                let near: f64 = (k + 1..x.len()).map(|j| rows[k][j] * x[j]).sum();
                x[k] = (x[k] - sums[k] - near) / rows[k][k];
            }
        }
    }
}

#[inline(always)]
fn symmetric_forward<S: Simd>(simd: S, factors: &PartialFactors, b: &mut [f64]) {
    for panel in panels(&(0..factors.eliminated)) {
        let rows = factors.upper_rows(&panel);
        let (known, others) = b[panel.start..].split_at_mut(panel.len());
        let mut multiples = [0.0; PANEL];
        for k in 0..known.len() {
            multiples[k] = -known[k] / rows[k][k];
            (k + 1..known.len()).for_each(|j| known[j] += multiples[k] * rows[k][j]);
        }
        let rows = rows.map(|row| &row[panel.len()..]);
        add_multiples(simd, [others], rows, [multiples]);
    }
}

#[inline(always)]
fn general_forward<S: Simd>(simd: S, factors: &PartialFactors, b: &mut [f64]) {
    for (k, &other) in factors.swapped.iter().enumerate() {
        b.swap(k, other);
    }
    for panel in panels(&(0..factors.eliminated)) {
        let (known, b) = b.split_at_mut(panel.start);
        let sums = products(simd, factors.lower_rows(&panel), known);
        let rows = factors.upper_rows(&panel);
        for k in 0..panel.len() {
            let near: f64 = (0..k).map(|j| rows[k][j] * b[j]).sum();
            b[k] -= sums[k] + near;
        }
    }
    let p = factors.eliminated;
    let (known, others) = b.split_at_mut(p);
    let rows = factors.lower[before(p)..].chunks(PANEL * p.max(1));
    for (values, rows) in others.chunks_mut(PANEL).zip(rows) {
        let count = rows.len() / p;
        let sums = products(simd, rows_of(rows, p, 0..count), known);
        for (value, sum) in values.iter_mut().zip(&sums[..count]) {
            *value -= sum;
        }
    }
}

/// The rows of a panel, the first one again where it has fewer than a full one.
#[inline(always)]
fn rows_of(matrix: &[f64], width: usize, panel: Range<usize>) -> [&[f64]; PANEL] {
    array::from_fn(|q| match panel.start + q {
        row if row < panel.end => &matrix[row * width..][..width],
        _ => &matrix[panel.start * width..][..width],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of this size, with a diagonal that makes it definite if asked for.
    fn matrix(n: usize, kind: FactorKind) -> Vec<f64> {
        let entry = |i: usize, j: usize| {
            ((7 * i * i + 13 * j * j + 5 * i * j + 3) % 101) as f64 / 5.0 - 10.0
        };
        let mut out = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                out[i * n + j] = match kind {
                    FactorKind::General => entry(i, j),
                    FactorKind::Symmetric if i == j => 40.0 + 10.0 * n as f64,
                    FactorKind::Symmetric => entry(i.min(j), i.max(j)),
                };
            }
        }
        out
    }

    /// A matrix of this size with zeros behind its rows.
    fn padded(matrix: &[f64], size: usize) -> Vec<f64> {
        let zeros = vec![0.0; stride(size) - size];
        let rows = matrix.chunks_exact(size.max(1));
        rows.flat_map(|row| [row, &zeros].concat()).collect()
    }

    /// What is left of matrix and right-hand side, solved by the same elimination to its end, completes to the solution.
    fn solves(kind: FactorKind, eliminated: usize, size: usize) {
        let whole = matrix(size, kind);
        let expected: Vec<f64> = (0..size).map(|i| 1.0 + (i % 5) as f64).collect();
        let rows = whole.chunks_exact(size.max(1));
        let mut x: Vec<f64> = rows
            .map(|row| row.iter().zip(&expected).map(|(a, x)| a * x).sum())
            .collect();

        let mut factors = PartialFactors::new(kind, eliminated, size);
        let mut matrix = padded(&whole, size);
        x.resize(factors.stride(), 0.0);
        assert!(factors.factor(&mut matrix));
        factors.forward(&mut x);
        let others = size - eliminated;
        let rows = matrix
            .chunks_exact(factors.stride().max(1))
            .skip(eliminated);
        let rest: Vec<f64> = rows
            .flat_map(|row| row[eliminated..size].to_vec())
            .collect();
        let mut last = PartialFactors::new(kind, others, others);
        let mut end = x[eliminated..size].to_vec();
        end.resize(last.stride(), 0.0);
        assert!(last.factor(&mut padded(&rest, others)));
        last.forward(&mut end);
        last.backward(&mut end);
        x[eliminated..size].copy_from_slice(&end[..others]);
        factors.backward(&mut x);
        for (found, expected) in x.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-10,
                "{kind:?}, {eliminated} of {size}: {found} instead of {expected}"
            );
        }
    }

    #[test]
    fn any_number_of_unknowns_can_be_eliminated() {
        for (eliminated, size) in [
            (1, 1),
            (3, 3),
            (4, 9),
            (5, 12),
            (12, 56),
            (34, 56),
            (64, 98),
            (70, 101),
            (22, 22),
            (0, 6),
            (31, 32),
            (0, 0),
        ] {
            solves(FactorKind::Symmetric, eliminated, size);
            solves(FactorKind::General, eliminated, size);
        }
    }

    #[test]
    fn a_general_matrix_is_pivoted() {
        let mut factors = PartialFactors::new(FactorKind::General, 2, 2);
        assert!(factors.factor(&mut padded(&[0.0, 1.0, 2.0, 0.0], 2)));
        let mut x = [3.0, 8.0, 0.0, 0.0];
        factors.forward(&mut x);
        factors.backward(&mut x);
        assert_eq!(x[..2], [4.0, 3.0]);
    }

    #[test]
    fn a_singular_matrix_cannot_be_used() {
        for kind in [FactorKind::Symmetric, FactorKind::General] {
            let mut factors = PartialFactors::new(kind, 2, 2);
            for first in [1.0, f64::NAN] {
                let mut matrix = padded(&[first, 2.0, 2.0, 4.0], 2);
                assert!(!factors.factor(&mut matrix));
            }
        }
    }
}
