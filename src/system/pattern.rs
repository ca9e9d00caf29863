//! Rows and columns of the Jacobian's entries, in the order [`LocalSystem::jacobian`] fills them.
//!
//! Entries with a negative row are ignored by the matrix: those of the fixed displacements.

use std::ops::Range;

use super::LocalSystem;
use super::local::LocalValue;

/// Entries of one element.
pub(super) const ELEMENT_ENTRIES: usize = 256;
/// Entries of one contact point: 6 x 6 and 6 in the equilibrium rows, 8 in each of its own.
pub(super) const CONTACT_ENTRIES: usize = 58;

/// Where the entries of a contact point are among its [`CONTACT_ENTRIES`].
pub(super) struct ContactLayout {
    pub force_u: Range<usize>,
    pub force_multiplier: Range<usize>,
    pub closure_u: Range<usize>,
    pub closure_multiplier: usize,
    pub closure_gap: usize,
    pub complementarity_u: Range<usize>,
    pub complementarity_multiplier: usize,
    pub complementarity_gap: usize,
}

/// The order in which [`LocalSystem::jacobian_pattern`] lists them.
pub(super) const CONTACT_LAYOUT: ContactLayout = ContactLayout {
    force_u: 0..36,
    force_multiplier: 36..42,
    closure_u: 42..48,
    closure_multiplier: 48,
    closure_gap: 49,
    complementarity_u: 50..56,
    complementarity_multiplier: 56,
    complementarity_gap: 57,
};

impl LocalSystem {
    /// Global rows and columns of all entries this rank contributes.
    pub fn jacobian_pattern(&self) -> (Vec<i32>, Vec<i32>) {
        let mut free_rows = self.rows.clone();
        for support in &self.supports {
            free_rows[support.unknown] = -1;
        }
        let mut rows = Vec::with_capacity(self.jacobian_entries());
        let mut columns = Vec::with_capacity(rows.capacity());
        let mut block = |row: &[i32], column: &[i32]| {
            for &r in row {
                for &c in column {
                    rows.push(r);
                    columns.push(c);
                }
            }
        };
        for nodes in &self.connectivity {
            let local: [usize; 16] = std::array::from_fn(|i| 2 * nodes[i / 2] + i % 2);
            block(&local.map(|i| free_rows[i]), &local.map(|i| self.rows[i]));
        }
        for (point, contact) in self.contacts.iter().enumerate() {
            let local: [usize; 6] = std::array::from_fn(|i| 2 * contact.nodes[i / 2] + i % 2);
            let u = local.map(|i| self.rows[i]);
            let free_u = local.map(|i| free_rows[i]);
            let multiplier = [self.rows[self.multiplier(point)]];
            let gap = [self.rows[self.multiplier(point) + 1]];
            block(&free_u, &u);
            block(&free_u, &multiplier);
            for own in [multiplier, gap] {
                block(&own, &u);
                block(&own, &multiplier);
                block(&own, &gap);
            }
        }
        for &LocalValue { unknown, .. } in &self.supports {
            // The owner keeps a one on the diagonal; the others add nothing.
            let row = if self.owned[unknown / 2] {
                self.rows[unknown]
            } else {
                -1
            };
            rows.push(row);
            columns.push(row);
        }
        (rows, columns)
    }

    /// Number of entries this rank contributes.
    pub fn jacobian_entries(&self) -> usize {
        ELEMENT_ENTRIES * self.elements.len()
            + CONTACT_ENTRIES * self.contacts.len()
            + self.supports.len()
    }
}
