//! Which unknowns of a long thin sheet are eliminated when: column of elements after column, towards what must be kept.

use std::ops::Range;

use super::condensation::CondensedPattern;

/// Unknowns of a slice of one column of elements, beyond which a sparse solver, which finds an order through the thickness,
/// too, is faster: more than 24 elements there.
const MOST_IN_A_SLICE: usize = 250;

/// When each unknown is eliminated, if at all.
pub(super) struct EliminationOrder {
    /// The slices whose unknowns are eliminated, one after the other.
    pub slices: Vec<usize>,
    /// For each unknown the place in this list of the slice that eliminates it, the last one to touch it.
    pub step: Vec<Option<usize>>,
    /// Its place in the order: as it is eliminated, then those that are left. The same in every front, so that what is above
    /// the diagonal stays there.
    pub place: Vec<usize>,
    /// The unknowns that are left, in this order.
    pub left: Vec<usize>,
}

impl EliminationOrder {
    /// For the pattern of one rank's entries, of whose unknowns those `kept` are not eliminated.
    pub(super) fn new(pattern: &CondensedPattern, kept: &[bool]) -> Self {
        let spans = spans(pattern, kept.len());
        let count = pattern.slices.iter().max().map_or(0, |last| last + 1);
        let mut unknowns = vec![0; count];
        let mut clear = vec![true; count];
        for (span, kept) in spans.iter().zip(kept) {
            unknowns[span.clone()].iter_mut().for_each(|n| *n += 1);
            if *kept {
                clear[span.clone()].fill(false);
            }
        }
        let mut run = match unknowns.iter().any(|&n| n > MOST_IN_A_SLICE) {
            true => 0..0,
            false => longest_run(count, |slice| clear[slice] && unknowns[slice] > 0),
        };
        if run == (0..count) {
            // A column remains for the sparse solver.
            run.end = count.saturating_sub(1);
        }
        // From the free end, so that no unknown is carried along from the beginning.
        let backward = run.start > 0 && run.end == count;
        let step = |span: &Range<usize>| {
            let inside = !span.is_empty() && run.start <= span.start && span.end <= run.end;
            inside.then(|| match backward {
                false => span.end - 1 - run.start,
                true => run.end - 1 - span.start,
            })
        };
        let step: Vec<Option<usize>> = spans.iter().map(step).collect();
        let met = |unknown: usize| match backward {
            false => spans[unknown].start,
            true => count - spans[unknown].end,
        };
        let mut order: Vec<usize> = (0..kept.len()).collect();
        order.sort_by_key(|&unknown| (step[unknown].unwrap_or(count), met(unknown)));
        let mut place = vec![0; kept.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let eliminated = step.iter().flatten().count();
        let mut slices: Vec<usize> = run.collect();
        if backward {
            slices.reverse();
        }
        Self {
            slices,
            step,
            place,
            left: order.split_off(eliminated),
        }
    }
}

/// The slices between the first and the last one that touch each unknown.
fn spans(pattern: &CondensedPattern, unknowns: usize) -> Vec<Range<usize>> {
    let mut spans = vec![0_usize..0; unknowns];
    for (&row, &slice) in pattern.rows.iter().zip(&pattern.slices) {
        if let Ok(row) = usize::try_from(row) {
            let Range { start, end } = spans[row];
            spans[row] = match start < end {
                true => start.min(slice)..end.max(slice + 1),
                false => slice..slice + 1,
            };
        }
    }
    spans
}

/// The longest stretch of numbers below `count` of which all have a property.
fn longest_run(count: usize, has: impl Fn(usize) -> bool) -> Range<usize> {
    let (mut longest, mut run) = (0..0, 0..0);
    for number in 0..count {
        run = match has(number) {
            true => run.start..number + 1,
            false => number + 1..number + 1,
        };
        if run.len() > longest.len() {
            longest = run.clone();
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of slices with two unknowns inside each and one between neighbours.
    fn chain(slices: usize) -> (CondensedPattern, usize) {
        let mut pattern = CondensedPattern::default();
        for slice in 0..slices {
            let unknowns = 3 * slice..3 * slice + 4;
            for row in unknowns.clone() {
                for column in unknowns.clone() {
                    pattern.rows.push(row as i32);
                    pattern.columns.push(column as i32);
                    pattern.slices.push(slice);
                }
            }
        }
        (pattern, 3 * slices + 1)
    }

    fn order(slices: usize, kept: &[usize]) -> EliminationOrder {
        let (pattern, unknowns) = chain(slices);
        let kept: Vec<bool> = (0..unknowns).map(|n| kept.contains(&n)).collect();
        EliminationOrder::new(&pattern, &kept)
    }

    #[test]
    fn alone_all_but_the_last_column_is_eliminated() {
        let order = order(4, &[]);
        assert_eq!(order.slices, [0, 1, 2]);
        assert_eq!(order.left, [9, 10, 11, 12]);
        assert_eq!(order.step[..4], [Some(0), Some(0), Some(0), Some(1)]);
    }

    #[test]
    fn it_goes_towards_what_is_kept() {
        let end = order(5, &[14, 15]);
        assert_eq!(end.slices, [0, 1, 2, 3]);
        assert_eq!(end.left, [12, 13, 14, 15]);
        let start = order(5, &[0]);
        assert_eq!(start.slices, [4, 3, 2, 1]);
        assert_eq!(start.left, [3, 0, 1, 2]);
        assert_eq!(start.step[15], Some(0));
        assert_eq!(start.step[12], Some(1));
    }

    #[test]
    fn between_two_kept_ends_what_the_first_slice_shares_is_carried_along() {
        let order = order(6, &[0, 18]);
        assert_eq!(order.slices, [1, 2, 3, 4]);
        assert_eq!(order.step[3], None);
        assert_eq!(order.step[4], Some(0));
        assert_eq!(order.left.len(), 8);
    }

    #[test]
    fn one_slice_and_none_are_left_whole() {
        assert!(order(1, &[]).slices.is_empty());
        assert_eq!(order(1, &[]).left, [0, 1, 2, 3]);
        let nothing = EliminationOrder::new(&CondensedPattern::default(), &[]);
        assert!(nothing.left.is_empty());
    }
}
