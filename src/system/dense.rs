//! Some unknowns of a small dense system eliminated: factors for them, and what they leave for the others.
//!
//! The matrix is n x n, row by row, and its first p unknowns are eliminated, four at a time so that what is loaded is used
//! more than once (right-looking; Golub and Van Loan 2013, Matrix Computations, sections 3.2 and 4.1). These loops stand here
//! because safe Rust does not reach PETSc's BLAS, and for some fifty unknowns they are as fast.

use std::array;
use std::ops::Range;

use petsc::FactorKind;

/// Pivots that are eliminated together.
const PANEL: usize = 4;

/// The factors of the unknowns eliminated.
pub(super) struct PartialFactors {
    kind: FactorKind,
    /// p and n.
    eliminated: usize,
    size: usize,
    /// Their rows of D Lᵀ or U, p x n.
    upper: Vec<f64>,
    /// L in the rows of the others, (n - p) x p; empty for a symmetric matrix, whose upper rows hold it.
    lower: Vec<f64>,
    /// The row that changed places with each; itself for a symmetric matrix.
    swapped: Vec<usize>,
}

impl PartialFactors {
    /// For matrices of `size` rows, of whose unknowns the first ones are to be eliminated. A symmetric matrix, of which
    /// only the upper triangle is read, is taken for one that needs no pivoting.
    pub(super) fn new(kind: FactorKind, eliminated: usize, size: usize) -> Self {
        let below = match kind {
            FactorKind::Symmetric => 0,
            FactorKind::General => size - eliminated,
        };
        Self {
            kind,
            eliminated,
            size,
            upper: vec![0.0; eliminated * size],
            lower: vec![0.0; below * eliminated],
            swapped: (0..eliminated).collect(),
        }
    }

    /// The rows of the unknowns to be eliminated, p x n, to be filled before [`PartialFactors::factor`], which puts the
    /// factors in their place.
    pub(super) fn rows(&mut self) -> &mut [f64] {
        &mut self.upper
    }

    /// Factorises the matrix of these rows and those of the others, (n - p) x n, in whose columns of the others it puts what
    /// is left for them; of a symmetric matrix in the upper triangle only. Says whether every pivot can be used.
    pub(super) fn factor(&mut self, others: &mut [f64]) -> bool {
        let (p, n) = (self.eliminated, self.size);
        if p == 0 {
            return true;
        }
        let upper = &mut self.upper;
        for start in (0..p).step_by(PANEL) {
            let panel = start..p.min(start + PANEL);
            match self.kind {
                FactorKind::Symmetric => symmetric_panel(upper, others, n, panel),
                FactorKind::General => general_panel(upper, others, n, panel, &mut self.swapped),
            }
        }
        let rows = self.lower.chunks_exact_mut(p);
        for (lower, row) in rows.zip(others.chunks_exact(n)) {
            lower.copy_from_slice(&row[..p]);
        }
        let mut pivots = (0..p).map(|k| self.upper[k * n + k]);
        pivots.all(|pivot| pivot != 0.0 && pivot.is_finite())
    }

    /// The forward substitution: takes the right-hand side `b` of the others to that of what is left.
    pub(super) fn forward(&self, b: &mut [f64]) {
        let p = self.eliminated;
        // An empty matrix has no rows of any length.
        let rows = self.upper.chunks_exact(self.size.max(1)).enumerate();
        match self.kind {
            FactorKind::Symmetric => rows.for_each(|(k, row)| {
                let multiple = b[k] / row[k];
                subtract(&mut b[k + 1..], &row[k + 1..], multiple);
            }),
            FactorKind::General => {
                for (k, &other) in self.swapped.iter().enumerate() {
                    b.swap(k, other);
                }
                rows.for_each(|(k, row)| b[k] -= dot(&row[..k], &b[..k]));
                let (inner, others) = b.split_at_mut(p);
                for (value, row) in others.iter_mut().zip(self.lower.chunks_exact(p.max(1))) {
                    *value -= dot(row, inner);
                }
            }
        }
    }

    /// The backward substitution: completes the others' solution in `x`.
    pub(super) fn backward(&self, x: &mut [f64]) {
        let rows = self.upper.chunks_exact(self.size.max(1));
        for (k, row) in rows.enumerate().rev() {
            x[k] = (x[k] - dot(&row[k + 1..], &x[k + 1..])) / row[k];
        }
    }
}

/// Eliminates the pivots of a panel from all rows below, upper triangle only.
fn symmetric_panel(upper: &mut [f64], others: &mut [f64], n: usize, panel: Range<usize>) {
    let eliminated = upper.len() / n;
    for i in panel.clone() {
        let (above, below) = upper.split_at_mut((i + 1) * n);
        let pivot = &above[i * n..];
        for (j, row) in (i + 1..panel.end).zip(below.chunks_exact_mut(n)) {
            subtract(&mut row[j..], &pivot[j..], pivot[j] / pivot[i]);
        }
    }
    let (above, below) = upper.split_at_mut(panel.end * n);
    let rows = rows_of(above, n, &panel);
    let inverse: [f64; PANEL] = array::from_fn(|q| match panel.start + q {
        k if k < panel.end => 1.0 / rows[q][k],
        _ => 0.0,
    });
    let of = |column: usize| {
        let multiples = array::from_fn(|q| rows[q][column] * inverse[q]);
        (column, multiples)
    };
    subtract_panel(below, n, rows, |row, _| of(panel.end + row));
    subtract_panel(others, n, rows, |row, _| of(eliminated + row));
}

/// Eliminates the pivots of a panel from all rows below, each the largest of its column among the unknowns to be eliminated.
fn general_panel(
    upper: &mut [f64],
    others: &mut [f64],
    n: usize,
    panel: Range<usize>,
    swapped: &mut [usize],
) {
    let Range { start, end } = panel;
    for c in start..end {
        let size = |row: usize| upper[row * n + c].abs();
        let best = (c..swapped.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)));
        let best = best.unwrap_or(c);
        swapped[c] = best;
        let (above, below) = upper.split_at_mut((c + 1) * n);
        let pivot = &mut above[c * n..];
        if best > c {
            pivot.swap_with_slice(&mut below[(best - c - 1) * n..][..n]);
        }
        let below = below.chunks_exact_mut(n);
        for row in below.chain(others.chunks_exact_mut(n)) {
            row[c] /= pivot[c];
            let multiple = row[c];
            subtract(&mut row[c + 1..end], &pivot[c + 1..end], multiple);
        }
    }
    for c in start + 1..end {
        let (above, below) = upper.split_at_mut(c * n);
        let row = &mut below[..n];
        for e in start..c {
            let multiple = row[e];
            subtract(&mut row[end..], &above[e * n..][end..n], multiple);
        }
    }
    let (above, below) = upper.split_at_mut(end * n);
    let rows = rows_of(above, n, &panel);
    let of = |_, row: &[f64]| {
        let multiples = array::from_fn(|q| if start + q < end { row[start + q] } else { 0.0 });
        (end, multiples)
    };
    subtract_panel(below, n, rows, of);
    subtract_panel(others, n, rows, of);
}

/// The rows of a panel, the first one again where it has fewer than a full one.
fn rows_of<'a>(matrix: &'a [f64], n: usize, panel: &Range<usize>) -> [&'a [f64]; PANEL] {
    array::from_fn(|q| match panel.start + q {
        row if row < panel.end => &matrix[row * n..][..n],
        _ => &matrix[panel.start * n..][..n],
    })
}

/// Subtracts multiples of a panel's rows from each row below, from a column on; both are told by `of`, for the number of
/// the row and its entries.
fn subtract_panel(
    below: &mut [f64],
    n: usize,
    [a, b, c, d]: [&[f64]; PANEL],
    of: impl Fn(usize, &[f64]) -> (usize, [f64; PANEL]),
) {
    // Two at a time, so that what is loaded of the panel serves twice.
    let mut pairs = below.chunks_exact_mut(2 * n);
    let mut row = 0;
    for pair in &mut pairs {
        let (x, y) = pair.split_at_mut(n);
        let ((from, f), (_, g)) = (of(row, x), of(row + 1, y));
        let panel = a[from..]
            .iter()
            .zip(&b[from..])
            .zip(&c[from..])
            .zip(&d[from..]);
        for ((x, y), (((a, b), c), d)) in x[from..].iter_mut().zip(&mut y[from..]).zip(panel) {
            *x -= f[0] * a + f[1] * b + f[2] * c + f[3] * d;
            *y -= g[0] * a + g[1] * b + g[2] * c + g[3] * d;
        }
        row += 2;
    }
    let last = pairs.into_remainder();
    if !last.is_empty() {
        let (from, f) = of(row, last);
        let panel = a[from..]
            .iter()
            .zip(&b[from..])
            .zip(&c[from..])
            .zip(&d[from..]);
        for (x, (((a, b), c), d)) in last[from..].iter_mut().zip(panel) {
            *x -= f[0] * a + f[1] * b + f[2] * c + f[3] * d;
        }
    }
}

/// `x -= multiple * y`
fn subtract(x: &mut [f64], y: &[f64], multiple: f64) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= multiple * y;
    }
}

/// Four sums side by side, as a single one would wait for itself.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a, b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
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

    /// What is left of matrix and right-hand side, solved by the same elimination to its end, completes to the solution.
    fn solves(kind: FactorKind, eliminated: usize, size: usize) {
        let whole = matrix(size, kind);
        let expected: Vec<f64> = (0..size).map(|i| 1.0 + (i % 5) as f64).collect();
        let rows = whole.chunks_exact(size.max(1));
        let mut x: Vec<f64> = rows.map(|row| dot(row, &expected)).collect();

        let mut factors = PartialFactors::new(kind, eliminated, size);
        let (first, rest) = whole.split_at(eliminated * size);
        factors.rows().copy_from_slice(first);
        let mut rest = rest.to_vec();
        assert!(factors.factor(&mut rest));
        factors.forward(&mut x);
        let others = size - eliminated;
        let rows = rest.chunks_exact(size.max(1));
        let rest: Vec<f64> = rows.flat_map(|row| row[eliminated..].to_vec()).collect();
        let mut last = PartialFactors::new(kind, others, others);
        last.rows().copy_from_slice(&rest);
        if others > 0 {
            assert!(last.factor(&mut []));
            last.forward(&mut x[eliminated..]);
            last.backward(&mut x[eliminated..]);
        }
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
            (22, 66),
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
        factors.rows().copy_from_slice(&[0.0, 1.0, 2.0, 0.0]);
        assert!(factors.factor(&mut []));
        let mut x = [3.0, 8.0];
        factors.forward(&mut x);
        factors.backward(&mut x);
        assert_eq!(x, [4.0, 3.0]);
    }

    #[test]
    fn a_singular_matrix_cannot_be_used() {
        for kind in [FactorKind::Symmetric, FactorKind::General] {
            let mut factors = PartialFactors::new(kind, 2, 2);
            for first in [1.0, f64::NAN] {
                factors.rows().copy_from_slice(&[first, 2.0, 2.0, 4.0]);
                assert!(!factors.factor(&mut []));
            }
        }
    }
}
