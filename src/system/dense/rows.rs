//! Multiples of rows added to other rows, and products of rows with a vector: the loops of dense matrices.
//!
//! Several rows at a time, so that what is loaded is used more than once, and in vectors as wide as the processor has them:
//! the callers run within [`pulp::Arch::dispatch`], into which these functions are inlined. Loops over indices, as iterators and
//! closures are not inlined there without optimisation at link time, and then know nothing of the processor.

#![allow(clippy::needless_range_loop)]

use std::mem::take;

use pulp::Simd;

/// `targets[r] += Σ multiples[r][k] rows[k]`, as far as the first of the rows.
#[inline(always)]
pub(super) fn add_multiples<S: Simd, const R: usize, const K: usize>(
    simd: S,
    mut targets: [&mut [f64]; R],
    mut rows: [&[f64]; K],
    multiples: [[f64; K]; R],
) {
    let length = rows[0].len();
    for k in 0..K {
        rows[k] = &rows[k][..length];
    }
    for r in 0..R {
        targets[r] = &mut take(&mut targets[r])[..length];
    }
    let mut factors = [[simd.splat_f64s(0.0); K]; R];
    for r in 0..R {
        for k in 0..K {
            factors[r][k] = simd.splat_f64s(multiples[r][k]);
        }
    }
    let whole = length / S::F64_LANES;
    for column in 0..whole {
        for r in 0..R {
            let target = &mut S::as_mut_simd_f64s(targets[r]).0[column];
            let mut sum = *target;
            for k in 0..K {
                sum = simd.mul_add_e_f64s(factors[r][k], S::as_simd_f64s(rows[k]).0[column], sum);
            }
            *target = sum;
        }
    }
    for column in whole * S::F64_LANES..length {
        for r in 0..R {
            for k in 0..K {
                targets[r][column] += multiples[r][k] * rows[k][column];
            }
        }
    }
}

/// `targets[r] += Σ multiples[k][r] rows[k]`, of any number of rows and R targets of four, whose lengths are that of the first.
/// Two vectors of each are kept while all rows pass.
#[inline(always)]
pub(super) fn add_products<'a, S: Simd, const R: usize>(
    simd: S,
    mut targets: [&mut [f64]; R],
    rows: impl Iterator<Item = &'a [f64]> + Clone,
    multiples: &[[f64; 4]],
) {
    let length = targets[0].len();
    for r in 0..R {
        targets[r] = &mut take(&mut targets[r])[..length];
    }
    let whole = length / S::F64_LANES;
    for column in (0..whole).step_by(2) {
        // Of an odd number the last is taken twice.
        let next = (column + 1).min(whole - 1);
        let mut sums = [[simd.splat_f64s(0.0); 2]; R];
        for r in 0..R {
            let target = S::as_simd_f64s(targets[r]).0;
            sums[r] = [target[column], target[next]];
        }
        for (row, multiples) in rows.clone().zip(multiples) {
            let row = S::as_simd_f64s(row).0;
            let values = [row[column], row[next]];
            for r in 0..R {
                let factor = simd.splat_f64s(multiples[r]);
                for c in 0..2 {
                    sums[r][c] = simd.mul_add_e_f64s(factor, values[c], sums[r][c]);
                }
            }
        }
        for r in 0..R {
            let target = S::as_mut_simd_f64s(targets[r]).0;
            [target[column], target[next]] = sums[r];
        }
    }
    for column in whole * S::F64_LANES..length {
        for (row, multiples) in rows.clone().zip(multiples) {
            for r in 0..R {
                targets[r][column] += multiples[r] * row[column];
            }
        }
    }
}

/// The scalar products of rows with `x`, as far as it goes.
#[inline(always)]
pub(super) fn products<S: Simd, const K: usize>(
    simd: S,
    mut rows: [&[f64]; K],
    x: &[f64],
) -> [f64; K] {
    for k in 0..K {
        rows[k] = &rows[k][..x.len()];
    }
    let mut sums = [simd.splat_f64s(0.0); K];
    let (whole, _) = S::as_simd_f64s(x);
    for column in 0..whole.len() {
        for k in 0..K {
            let value = S::as_simd_f64s(rows[k]).0[column];
            sums[k] = simd.mul_add_e_f64s(value, whole[column], sums[k]);
        }
    }
    let mut out = [0.0; K];
    for k in 0..K {
        out[k] = simd.reduce_sum_f64s(sums[k]);
        for column in whole.len() * S::F64_LANES..x.len() {
            out[k] += rows[k][column] * x[column];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Simd, WithSimd};

    use super::*;

    /// All functions on rows of this length.
    struct All(usize);

    impl WithSimd for All {
        type Output = ([Vec<f64>; 2], [Vec<f64>; 2], [f64; 2]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let row = |start: usize| (start..start + self.0).map(|n| n as f64).collect();
            let [a, b, mut x, mut y]: [Vec<f64>; 4] = [row(1), row(3), row(2), row(5)];
            let (mut v, mut w) = (x.clone(), y.clone());
            let products = products(simd, [&a, &b], &x);
            add_multiples(simd, [&mut x, &mut y], [&a, &b], [[2.0, 3.0], [-1.0, 4.0]]);
            let multiples = [[2.0, -1.0, 0.0, 0.0], [3.0, 4.0, 0.0, 0.0]];
            let rows = [&a[..], &b].into_iter();
            add_products(simd, [&mut v, &mut w], rows, &multiples);
            ([x, y], [v, w], products)
        }
    }

    #[test]
    fn rows_of_any_length_are_added_and_multiplied() {
        for length in 0..27 {
            let ([x, y], same, products) = Arch::new().dispatch(All(length));
            let mut expected = [0.0; 2];
            for n in 0..length {
                let [a, b, c, d] = [1, 3, 2, 5].map(|start| (start + n) as f64);
                assert_eq!([x[n], y[n]], [c + 2.0 * a + 3.0 * b, d - a + 4.0 * b]);
                expected[0] += a * c;
                expected[1] += b * c;
            }
            assert_eq!(products, expected);
            assert_eq!(same, [x, y]);
        }
    }
}
