//! The Jacobian of one rank's subdomain: its entries, and their rows and columns.

use std::ops::Range;

use super::error::ElementFailure;
use super::history::History;
use super::subdomain::{LocalValue, Subdomain};
use crate::contact::ContactTangent;
use crate::element::{ElementForce, NodeBlock};

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

/// The order in which [`Subdomain::jacobian_pattern`] lists them.
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

/// One rank's contributions to the Jacobian, entry by entry in the order of [`Subdomain::jacobian_pattern`]. Whoever
/// solves with a Jacobian owns them.
#[derive(Clone, Debug)]
pub struct JacobianEntries {
    values: Vec<f64>,
    element_count: usize,
    contact_count: usize,
    /// What a unit of [`crate::element::Quad8::mass`] adds to them, 1/mm.
    inertia: f64,
    kept: Kept,
}

/// What a residual has left: everything but inertia.
#[derive(Clone, Debug, Default)]
struct Kept {
    /// The time (ms) and local unknowns it is for; none if there is nothing.
    t: Option<f64>,
    u: Vec<f64>,
}

impl JacobianEntries {
    /// Not yet evaluated.
    pub fn new(of: &Subdomain) -> Self {
        let (element_count, contact_count) = (of.elements.len(), of.contacts.len());
        let count = ELEMENT_ENTRIES * element_count + CONTACT_ENTRIES * contact_count;
        Self {
            values: vec![0.0; count + of.supports.len()],
            element_count,
            contact_count,
            inertia: 0.0,
            kept: Kept::default(),
        }
    }

    /// Of elements and of contact points, to be put anew: nothing is kept until [`JacobianEntries::keep`] says so.
    pub(super) fn begin(&mut self) -> (&mut [f64], &mut [f64]) {
        self.forget();
        let (elements, contacts, _) = self.parts();
        (elements, contacts)
    }

    /// Elements and contact points have theirs at time `t` (ms) and these local unknowns.
    pub(super) fn keep(&mut self, t: f64, u: &[f64]) {
        self.kept.t = Some(t);
        self.kept.u.clear();
        self.kept.u.extend_from_slice(u);
    }

    /// Drops what a residual has left for the next Jacobian: the history has changed, or it is elsewhere.
    pub fn forget(&mut self) {
        self.kept.t = None;
    }

    fn are_kept_for(&self, t: f64, u: &[f64]) -> bool {
        self.kept.t == Some(t) && self.kept.u == u
    }

    /// All of them.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Those of all elements, element by element.
    pub(super) fn of_elements(&self) -> &[f64] {
        &self.values[..ELEMENT_ENTRIES * self.element_count]
    }

    /// Those of each contact point, see [`CONTACT_LAYOUT`].
    pub(super) fn of_contacts(&self) -> impl Iterator<Item = &[f64]> {
        let first = ELEMENT_ENTRIES * self.element_count;
        self.values[first..first + CONTACT_ENTRIES * self.contact_count]
            .chunks_exact(CONTACT_ENTRIES)
    }

    /// Adds the products with each of `u` to the rows of that of `out` (all local); rows of prescribed displacements take no
    /// part. The entries are read once for all.
    pub fn add_products(&self, of: &Subdomain, u: &[Vec<f64>], out: &mut [Vec<f64>]) {
        let elements = self.of_elements().chunks_exact(ELEMENT_ENTRIES);
        for (element, entries) in elements.enumerate() {
            let masses = of.kernels[element].mass();
            let masses = masses.map(|row| self.inertia * row.iter().sum::<f64>());
            for (u, out) in u.iter().zip(&mut *out) {
                let values = of.element_values(element, u);
                let product = element_product(entries, &masses, values);
                for (&n, sum) in of.connectivity[element].iter().zip(product) {
                    out[2 * n] += sum[0];
                    out[2 * n + 1] += sum[1];
                }
            }
        }
        for (point, entries) in self.of_contacts().enumerate() {
            for (u, out) in u.iter().zip(&mut *out) {
                add_contact_product(of, point, entries, u, out);
            }
        }
        for out in out {
            for support in &of.supports {
                out[support.unknown] = 0.0;
            }
        }
    }

    fn parts(&mut self) -> (&mut [f64], &mut [f64], &mut [f64]) {
        let (elements, rest) = self
            .values
            .split_at_mut(ELEMENT_ENTRIES * self.element_count);
        let (contacts, supports) = rest.split_at_mut(CONTACT_ENTRIES * self.contact_count);
        (elements, contacts, supports)
    }
}

/// Of an element, whose nodes have these shares of its inertia (1/mm).
fn element_product(entries: &[f64], masses: &[f64; 8], values: [[f64; 2]; 8]) -> [[f64; 2]; 8] {
    // A translation strains nothing, but for the entries' rounding.
    let [first, ..] = values;
    let mut sum = [[0.0; 2]; 8];
    for (sum, mass) in sum.iter_mut().zip(masses) {
        *sum = [mass * first[0], mass * first[1]];
    }
    let moved = values.map(|u| [u[0] - first[0], u[1] - first[1]]);
    // The entries are symmetric.
    let rows = entries.chunks_exact(16).filter_map(<[f64]>::first_chunk);
    for (row, value) in rows.zip(moved.as_flattened()) {
        let row: &[f64; 16] = row;
        for (sum, entry) in sum.as_flattened_mut().iter_mut().zip(row) {
            *sum += entry * value;
        }
    }
    sum
}

/// Puts an element's stiffness times `scale` into its entries.
pub(super) fn put_element(element: &ElementForce, scale: f64, entries: &mut [f64]) {
    for (a, blocks) in element.stiffness.iter().enumerate() {
        for (b, block) in blocks.iter().enumerate().skip(a) {
            let [x, y] = block.map(|row| row.map(|k| scale * k));
            put(entries, [b, a], [[x[0], y[0]], [x[1], y[1]]]);
            // Of a node's own block, too, the upper triangle counts.
            let left = if a == b { x[1] } else { y[0] };
            put(entries, [a, b], [x, [left, y[1]]]);
        }
    }
}

/// Puts the entries between two nodes into those of an element.
fn put(entries: &mut [f64], [a, b]: [usize; 2], block: NodeBlock) {
    for (row, values) in entries[32 * a..].chunks_exact_mut(16).zip(block) {
        row[2 * b..2 * b + 2].copy_from_slice(&values);
    }
}

/// Puts a contact point's tangent into its entries.
pub(super) fn put_contact(tangent: &ContactTangent, out: &mut [f64]) {
    use CONTACT_LAYOUT as AT;
    out[AT.force_u].copy_from_slice(tangent.force_u.as_flattened());
    out[AT.force_multiplier].copy_from_slice(&tangent.force_multiplier);
    out[AT.closure_u].copy_from_slice(&tangent.closure_u);
    out[AT.closure_multiplier] = tangent.compliance;
    out[AT.closure_gap] = tangent.closure_gap;
    out[AT.complementarity_u].copy_from_slice(&tangent.complementarity_u);
    out[AT.complementarity_multiplier] = tangent.complementarity_multiplier;
    out[AT.complementarity_gap] = tangent.complementarity_gap;
}

/// Of a contact point; `u` and `out` are local.
fn add_contact_product(of: &Subdomain, point: usize, entries: &[f64], u: &[f64], out: &mut [f64]) {
    use CONTACT_LAYOUT as AT;
    let (nodes, m) = (of.contacts[point].nodes, of.multiplier(point));
    let (multiplier, gap) = (u[m], u[m + 1]);
    let at: [usize; 6] = std::array::from_fn(|i| 2 * nodes[i / 2] + i % 2);
    let values: [f64; 6] = std::array::from_fn(|i| u[at[i]]);
    let product = |row: &[f64]| -> f64 { (0..6).map(|i| row[i] * values[i]).sum() };
    let by_multiplier = &entries[AT.force_multiplier];
    let rows = entries[AT.force_u].chunks_exact(6).zip(by_multiplier);
    for (&i, (row, by_multiplier)) in at.iter().zip(rows) {
        out[i] += product(row) + by_multiplier * multiplier;
    }
    out[m] += product(&entries[AT.closure_u])
        + entries[AT.closure_multiplier] * multiplier
        + entries[AT.closure_gap] * gap;
    out[m + 1] += product(&entries[AT.complementarity_u])
        + entries[AT.complementarity_multiplier] * multiplier
        + entries[AT.complementarity_gap] * gap;
}

impl Subdomain {
    /// Global rows and columns of all entries this rank contributes. Entries with a negative row are ignored by the
    /// matrix: those of the fixed displacements.
    pub fn jacobian_pattern(&self) -> (Vec<i32>, Vec<i32>) {
        let mut free_rows = self.rows.clone();
        for support in &self.supports {
            free_rows[support.unknown] = -1;
        }
        let (mut rows, mut columns) = (Vec::new(), Vec::new());
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

    /// Evaluates the entries at time `t` and unknowns `u`, with `shift` the derivative of the acceleration by the
    /// unknown (1/ms²); what a residual there has left in them is not evaluated again.
    pub fn jacobian(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        shift: f64,
        entries: &mut JacobianEntries,
    ) -> Result<(), ElementFailure> {
        if !entries.are_kept_for(t, u) {
            self.stiffness(history, t, u, entries)?;
        }
        self.put_inertia(shift, entries);
        Ok(())
    }

    fn stiffness(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        entries: &mut JacobianEntries,
    ) -> Result<(), ElementFailure> {
        let scale = 1.0 / self.problem.young_modulus;
        let (elements, contacts) = entries.begin();
        let mut local = ElementForce::ZERO;
        for (element, out) in elements.chunks_exact_mut(ELEMENT_ENTRIES).enumerate() {
            self.element_force(history, element, u, true, &mut local)?;
            put_element(&local, scale, out);
        }
        for (point, out) in contacts.chunks_exact_mut(CONTACT_ENTRIES).enumerate() {
            let (position, traction) = self.contact_answer(history, t, u, point);
            let (law, multiplier) = (&self.contacts[point].law, u[self.multiplier(point)]);
            put_contact(&law.tangent(&position, multiplier, &traction), out);
        }
        Ok(())
    }

    /// Adds the inertia to entries that have everything else, and the rows of prescribed displacements. What was kept has
    /// been used up.
    fn put_inertia(&self, shift: f64, entries: &mut JacobianEntries) {
        entries.forget();
        let inertia = 1.0 / self.problem.young_modulus * shift * self.problem.density;
        entries.inertia = inertia;
        let (elements, _, supports) = entries.parts();
        supports.fill(1.0);
        if inertia == 0.0 {
            return;
        }
        for (kernel, out) in self
            .kernels
            .iter()
            .zip(elements.chunks_exact_mut(ELEMENT_ENTRIES))
        {
            for (a, masses) in kernel.mass().iter().enumerate() {
                for (b, mass) in masses.iter().enumerate() {
                    out[32 * a + 2 * b] += inertia * mass;
                    out[32 * a + 16 + 2 * b + 1] += inertia * mass;
                }
            }
        }
    }
}
