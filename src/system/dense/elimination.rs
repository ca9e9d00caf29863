//! The elimination itself, panel by panel.

use std::array;
use std::ops::Range;

use petsc::FactorKind;
use pulp::{Simd, WithSimd};

use super::rows::{add_multiples, add_products};
use super::{PANEL, panels, rows_of};

/// Pivots that pass together over the rows below, which are loaded and stored once for all of them, in a matrix of more than
/// [`SMALL`] rows. A smaller one stays in the cache nearest to the processor.
const BLOCK: usize = 8 * PANEL;
const SMALL: usize = 64;

/// Eliminates the first unknowns of a matrix, as many as there is room for rows `swapped`.
pub(super) struct Elimination<'a> {
    pub kind: FactorKind,
    pub swapped: &'a mut [usize],
    pub matrix: &'a mut [f64],
    pub stride: usize,
}

impl WithSimd for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (matrix, n, pivots) = (self.matrix, self.stride, self.swapped.len());
        let size = if n > SMALL { BLOCK } else { pivots.max(1) };
        for start in (0..pivots).step_by(size) {
            let block = start..pivots.min(start + size);
            // How far the panels of the block reach by themselves.
            let reach = if n > SMALL { block.end } else { n };
            for panel in panels(&block) {
                match self.kind {
                    FactorKind::Symmetric => {
                        let rows = matrix.len().min(reach * n);
                        symmetric_panel(simd, &mut matrix[..rows], n, panel);
                    }
                    FactorKind::General => {
                        general_panel(simd, matrix, n, panel, reach, self.swapped);
                    }
                }
            }
            if reach < n {
                if self.kind == FactorKind::General {
                    complete_rows(simd, matrix, n, &block);
                }
                add_block(simd, matrix, n, block, self.kind);
            }
        }
    }
}

/// Eliminates the pivots of a panel from the rows below, upper triangle only.
#[inline(always)]
fn symmetric_panel<S: Simd>(simd: S, matrix: &mut [f64], n: usize, panel: Range<usize>) {
    let Range { start, end } = panel;
    for i in start..end {
        let (above, below) = matrix.split_at_mut((i + 1) * n);
        let pivot = &above[i * n..];
        for (j, row) in (i + 1..end).zip(below.chunks_exact_mut(n)) {
            let multiple = -pivot[j] / pivot[i];
            add_multiples(simd, [&mut row[start..]], [&pivot[start..]], [[multiple]]);
        }
    }
    let (above, below) = matrix.split_at_mut(end * n);
    let rows = rows_of(above, n, panel);
    let negative_inverse: [f64; PANEL] = array::from_fn(|q| match start + q {
        k if k < end => -1.0 / rows[q][k],
        _ => 0.0,
    });
    add_panel(simd, below, n, rows, |row, _| {
        let column = end + row;
        let multiples = array::from_fn(|q| rows[q][column] * negative_inverse[q]);
        (from(column)..n, multiples)
    });
}

/// Eliminates the pivots of a panel from all rows below, each the largest of its column among the unknowns to be eliminated, in
/// the columns before `reach`.
#[inline(always)]
fn general_panel<S: Simd>(
    simd: S,
    matrix: &mut [f64],
    n: usize,
    panel: Range<usize>,
    reach: usize,
    swapped: &mut [usize],
) {
    let Range { start, end } = panel;
    for c in start..end {
        let size = |row: usize| matrix[row * n + c].abs();
        let best = (c..swapped.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)));
        let best = best.unwrap_or(c);
        swapped[c] = best;
        let (above, below) = matrix.split_at_mut((c + 1) * n);
        let pivot = &mut above[c * n..];
        if best > c {
            pivot.swap_with_slice(&mut below[(best - c - 1) * n..][..n]);
        }
        let inverse = 1.0 / pivot[c];
        for row in below.chunks_exact_mut(n) {
            row[c] *= inverse;
            let multiple = row[c];
            (c + 1..end).for_each(|e| row[e] -= multiple * pivot[e]);
        }
    }
    pass_on(simd, matrix, n, panel, end..reach);
}

/// Eliminates the pivots of a block from its own rows in the columns behind it.
#[inline(always)]
fn complete_rows<S: Simd>(simd: S, matrix: &mut [f64], n: usize, block: &Range<usize>) {
    let rows = &mut matrix[..block.end * n];
    for panel in panels(block) {
        pass_on(simd, rows, n, panel, block.end..n);
    }
}

/// Eliminates the pivots of a panel, whose multiples stand in the rows below, from these rows in some columns.
#[inline(always)]
fn pass_on<S: Simd>(
    simd: S,
    matrix: &mut [f64],
    n: usize,
    panel: Range<usize>,
    columns: Range<usize>,
) {
    let Range { start, end } = panel;
    for c in start + 1..end {
        let (above, below) = matrix.split_at_mut(c * n);
        let row = &mut below[..n];
        for e in start..c {
            let (pivot, multiple) = (&above[e * n..][columns.clone()], -row[e]);
            add_multiples(simd, [&mut row[columns.clone()]], [pivot], [[multiple]]);
        }
    }
    let (above, below) = matrix.split_at_mut(end * n);
    let rows = rows_of(above, n, panel);
    add_panel(simd, below, n, rows, |_, row| {
        let multiple = |k: usize| if k < end { -row[k] } else { 0.0 };
        (columns.clone(), array::from_fn(|q| multiple(start + q)))
    });
}

/// Eliminates the pivots of a block from all rows below it.
#[inline(always)]
fn add_block<S: Simd>(
    simd: S,
    matrix: &mut [f64],
    n: usize,
    block: Range<usize>,
    kind: FactorKind,
) {
    let Range { start, end } = block;
    let (above, below) = matrix.split_at_mut(end * n);
    let rows = &above[start * n..];
    let mut negative_inverse = [0.0; BLOCK];
    for (k, row) in rows.chunks_exact(n).enumerate() {
        negative_inverse[k] = -1.0 / row[start + k];
    }
    let mut first = end;
    for group in below.chunks_mut(PANEL * n) {
        let count = group.len() / n;
        let mut multiples = [[0.0; PANEL]; BLOCK];
        for (k, row) in rows.chunks_exact(n).enumerate() {
            for q in 0..count {
                multiples[k][q] = match kind {
                    FactorKind::Symmetric => row[first + q] * negative_inverse[k],
                    FactorKind::General => -group[q * n + start + k],
                };
            }
        }
        let column = match kind {
            FactorKind::Symmetric => from(first),
            FactorKind::General => end,
        };
        let rows = rows.chunks_exact(n).map(|row| &row[column..]);
        if count == PANEL {
            let (a, b) = group.split_at_mut(2 * n);
            let ((a, b), (c, d)) = (a.split_at_mut(n), b.split_at_mut(n));
            let targets = [a, b, c, d].map(|row| &mut row[column..]);
            add_products(simd, targets, rows, &multiples);
        } else {
            for (q, target) in group.chunks_exact_mut(n).enumerate() {
                let own = multiples.map(|multiples| [multiples[q], 0.0, 0.0, 0.0]);
                add_products(simd, [&mut target[column..]], rows.clone(), &own);
            }
        }
        first += count;
    }
}

/// Where a row of a symmetric matrix begins, a whole vector before its diagonal at most: what stands left of that is never
/// read.
#[inline(always)]
fn from(diagonal: usize) -> usize {
    diagonal / PANEL * PANEL
}

/// Adds multiples of a panel's rows to each row below in some columns; both are told by `of`, for the number of the row and
/// its entries.
#[inline(always)]
fn add_panel<S: Simd>(
    simd: S,
    below: &mut [f64],
    n: usize,
    panel: [&[f64]; PANEL],
    of: impl Fn(usize, &[f64]) -> (Range<usize>, [f64; PANEL]),
) {
    // Two at a time, so that what is loaded of the panel serves twice.
    let mut pairs = below.chunks_exact_mut(2 * n);
    let mut row = 0;
    for pair in &mut pairs {
        let (x, y) = pair.split_at_mut(n);
        let ((columns, f), (_, g)) = (of(row, x), of(row + 1, y));
        let panel = panel.map(|row| &row[columns.clone()]);
        let targets = [&mut x[columns.clone()], &mut y[columns]];
        add_multiples(simd, targets, panel, [f, g]);
        row += 2;
    }
    let last = pairs.into_remainder();
    if !last.is_empty() {
        let (columns, f) = of(row, last);
        let panel = panel.map(|row| &row[columns.clone()]);
        add_multiples(simd, [&mut last[columns]], panel, [f]);
    }
}
