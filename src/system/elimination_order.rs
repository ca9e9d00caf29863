//! Which unknowns of a long thin sheet are eliminated when: first those inside one column of elements, then those between two
//! columns, between two pairs of columns, and so on.

use super::condensation::CondensedPattern;

/// Slices that are few enough for the sparse solver.
const ENOUGH: usize = 10;
/// Unknowns of a slice of one column of elements, beyond which a sparse solver, which finds an order through the thickness,
/// too, is faster: more than ten elements there.
const MOST_IN_A_SLICE: usize = 110;

/// In which layer each unknown is eliminated, and in which order.
pub(super) struct EliminationOrder {
    /// Layers, none where there are few slices.
    pub layers: usize,
    /// The layer of each unknown; the number of layers for one that is left.
    pub layer: Vec<usize>,
    /// Its place in the order: by layers, and along the sheet within each, the same in every front, so that what is above
    /// the diagonal stays there.
    pub place: Vec<usize>,
    /// The unknowns that are left, in this order.
    pub left: Vec<usize>,
}

impl EliminationOrder {
    /// For the pattern of one rank's entries, of whose unknowns those `kept` are not eliminated.
    pub(super) fn new(pattern: &CondensedPattern, kept: &[bool]) -> Self {
        let mut first = vec![usize::MAX; kept.len()];
        let mut last = vec![0; kept.len()];
        for (&row, &slice) in pattern.rows.iter().zip(&pattern.slices) {
            if let Ok(row) = usize::try_from(row) {
                first[row] = slice.min(first[row]);
                last[row] = slice.max(last[row]);
            }
        }
        let mut slices = pattern.slices.iter().max().map_or(0, |last| last + 1);
        let mut unknowns = vec![0; slices];
        for (&first, &last) in first.iter().zip(&last) {
            let touched = unknowns
                .iter_mut()
                .skip(first)
                .take((last + 1).saturating_sub(first));
            touched.for_each(|unknowns| *unknowns += 1);
        }
        if unknowns.iter().any(|&unknowns| unknowns > MOST_IN_A_SLICE) {
            slices = 0;
        }
        let mut layers = usize::from(slices > ENOUGH);
        while slices > ENOUGH {
            slices = slices.div_ceil(2);
            layers += 1;
        }
        let layer_of = |unknown: usize| {
            let together = |layer: &usize| first[unknown] >> layer == last[unknown] >> layer;
            match kept[unknown] {
                false => (0..layers).find(together).unwrap_or(layers),
                true => layers,
            }
        };
        let layer: Vec<usize> = (0..kept.len()).map(layer_of).collect();
        let mut order: Vec<usize> = (0..kept.len()).collect();
        order.sort_by_key(|&unknown| (layer[unknown], first[unknown]));
        let mut place = vec![0; kept.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let eliminated = order.partition_point(|&unknown| layer[unknown] < layers);
        Self {
            layers,
            layer,
            place,
            left: order.split_off(eliminated),
        }
    }
}
