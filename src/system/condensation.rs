//! Static condensation: contact unknowns and prescribed displacements leave the linear system.
//!
//! A Newton step solves `J Δ = r`. With n the closure's slope and ε its compliance, each contact point has
//!
//! ```text
//! closure          n·Δu + ε Δλ - Δg = r_λ
//! complementarity  m·Δu + b Δλ + c Δg = r_g        inactive points only: Δg = 0 where g is at its bound
//! ```
//!
//! from which always `Δλ = λ_0 - s·Δu`, because ε > 0. What is left is `(J_uu - J_uλ s) Δu = r_u -
//! J_uλ λ_0`: the pattern of the elements, whatever the active set. An open point has s = 0, and
//! without friction the condensed matrix is symmetric.

use super::numbering::Numbering;
use super::subdomain::Subdomain;
use super::tangent::{CONTACT_LAYOUT as AT, ELEMENT_ENTRIES, JacobianEntries};

/// Entries of one contact point in the condensed matrix.
const CONDENSED_ENTRIES: usize = 36;

/// The condensation on one rank, for one Jacobian and active set at a time.
pub(super) struct Condensation {
    points: Vec<EliminatedPoint>,
    /// First global row of this rank.
    first_row: i32,
    /// Entries of contact points and supports.
    others: Vec<f64>,
    known: Vec<KnownColumn>,
}

/// The entries of a condensed matrix, in the order of its pattern: first those of the elements, which condensation leaves
/// as they are, then those of contact points and supports.
#[derive(Clone, Copy)]
pub(super) struct CondensedEntries<'a> {
    pub elements: &'a [f64],
    pub others: &'a [f64],
}

impl CondensedEntries<'_> {
    /// The one with this number in the pattern.
    pub(super) fn get(&self, number: usize) -> f64 {
        match number.checked_sub(self.elements.len()) {
            None => self.elements[number],
            Some(number) => self.others[number],
        }
    }

    /// All of them side by side.
    pub(super) fn copy_to(&self, all: &mut Vec<f64>) {
        all.clear();
        all.extend_from_slice(self.elements);
        all.extend_from_slice(self.others);
    }
}

/// Rows and columns of the condensed matrix's entries as local displacements; a negative row or column
/// is left out.
#[derive(Default)]
pub(super) struct CondensedPattern {
    pub rows: Vec<i32>,
    pub columns: Vec<i32>,
    /// How many entries are of elements; they come first.
    pub elements: usize,
    /// Which of the mesh's columns of elements, from one end of the sheet to the other, each entry belongs to.
    pub slices: Vec<usize>,
}

/// An entry whose column is a prescribed displacement: it goes to the right-hand side.
struct KnownColumn {
    entry: usize,
    value: f64,
    row: usize,
    column: usize,
}

/// A contact point expressed by the displacements of its edge: Δλ = λ_0 - s·Δu.
#[derive(Clone, Debug, Default)]
struct EliminatedPoint {
    /// Local displacements of its edge, and which of them are prescribed.
    unknowns: [usize; 6],
    prescribed: [bool; 6],
    /// Global row of the multiplier; the gap follows.
    row: i32,
    /// Position of the multiplier among this rank's reduced unknowns; the gap follows if it is free.
    position: usize,
    active: bool,
    /// Equilibrium by multiplier, J_uλ.
    force_multiplier: [f64; 6],
    /// s.
    slope: [f64; 6],
    /// λ_0 = `by_closure` r_λ + `by_complementarity` r_g.
    by_closure: f64,
    by_complementarity: f64,
    /// The closure row, from which the gap follows.
    closure_u: [f64; 6],
    closure_multiplier: f64,
    closure_gap: f64,
}

impl Condensation {
    /// For one rank's subdomain, with the pattern of its condensed entries.
    pub fn new(local: &Subdomain, numbering: &Numbering, rank: usize) -> (Self, CondensedPattern) {
        let mut prescribed = vec![false; 2 * local.nodes.len()];
        local
            .supports
            .iter()
            .for_each(|s| prescribed[s.unknown] = true);
        let (mut rows, mut columns, mut known) = (Vec::new(), Vec::new(), Vec::new());
        let mut slices = Vec::new();
        let slice_of_node = slices_of_nodes(local);
        let mut block = |unknowns: &[usize], slice| {
            for &row in unknowns {
                for &column in unknowns {
                    let free = !prescribed[row] && !prescribed[column];
                    if prescribed[column] && !prescribed[row] {
                        let entry = rows.len();
                        known.push(KnownColumn {
                            entry,
                            value: 0.0,
                            row,
                            column,
                        });
                    }
                    rows.push(if free { row as i32 } else { -1 });
                    columns.push(if free { column as i32 } else { -1 });
                    slices.push(slice);
                }
            }
        };
        for nodes in &local.connectivity {
            let unknowns: [usize; 16] = std::array::from_fn(|i| 2 * nodes[i / 2] + i % 2);
            block(&unknowns, slice_of_node[nodes[BOTTOM]]);
        }
        let mut points = Vec::with_capacity(local.contacts.len());
        for (point, contact) in local.contacts.iter().enumerate() {
            let unknowns: [usize; 6] = std::array::from_fn(|i| 2 * contact.nodes[i / 2] + i % 2);
            block(&unknowns, slice_of_node[contact.nodes[2]]);
            points.push(EliminatedPoint {
                unknowns,
                prescribed: unknowns.map(|i| prescribed[i]),
                row: local.rows[local.multiplier(point)],
                ..EliminatedPoint::default()
            });
        }
        // The owner keeps a one on the diagonal of a prescribed displacement.
        for support in local.supports.iter().filter(|s| local.owned[s.unknown / 2]) {
            rows.push(support.unknown as i32);
            columns.push(support.unknown as i32);
            slices.push(slice_of_node[support.unknown / 2]);
        }
        let elements = ELEMENT_ENTRIES * local.connectivity.len();
        let this = Self {
            points,
            first_row: numbering.rank_rows[rank] as i32,
            others: vec![1.0; rows.len() - elements],
            known,
        };
        let pattern = CondensedPattern {
            rows,
            columns,
            elements,
            slices,
        };
        (this, pattern)
    }

    /// Takes over a Jacobian and this rank's active set (ascending global rows). Returns the condensed entries.
    pub fn condense<'a>(
        &'a mut self,
        jacobian: &'a JacobianEntries,
        active: &[i32],
    ) -> CondensedEntries<'a> {
        let elements = jacobian.of_elements();
        let mut active = active.iter().peekable();
        let mut active_before = 0;
        let blocks = jacobian
            .of_contacts()
            .zip(self.others.chunks_exact_mut(CONDENSED_ENTRIES));
        for (point, (entries, out)) in self.points.iter_mut().zip(blocks) {
            let gap = point.row + 1;
            while active.next_if(|&&row| row < gap).is_some() {
                active_before += 1;
            }
            point.position = (point.row - self.first_row) as usize - active_before;
            point.eliminate(entries, active.next_if_eq(&&gap).is_some());
            active_before += usize::from(point.active);
            for (i, out) in out.chunks_exact_mut(6).enumerate() {
                for (j, value) in out.iter_mut().enumerate() {
                    let direct = entries[AT.force_u.start + 6 * i + j];
                    *value = direct - point.force_multiplier[i] * point.slope[j];
                }
            }
        }
        for known in &mut self.known {
            known.value = match known.entry.checked_sub(elements.len()) {
                None => elements[known.entry],
                Some(entry) => self.others[entry],
            };
        }
        CondensedEntries {
            elements,
            others: &self.others,
        }
    }

    /// What elimination adds to the right-hand side of the local displacements' rows, from this rank's
    /// reduced right-hand side `r` and the prescribed displacements' steps in `known`.
    pub fn forward(&self, r: &[f64], known: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for column in &self.known {
            out[column.row] -= column.value * known[column.column];
        }
        for point in &self.points {
            let start = point.start(r);
            for i in (0..6).filter(|&i| !point.prescribed[i]) {
                out[point.unknowns[i]] -= point.force_multiplier[i] * start;
            }
        }
    }

    /// Steps of this rank's contact unknowns in the reduced solution `out`, from the reduced
    /// right-hand side `r` and the steps `u` of the local displacements.
    pub fn backward(&self, r: &[f64], u: &[f64], out: &mut [f64]) {
        for point in &self.points {
            let u = point.unknowns.map(|i| u[i]);
            let multiplier = point.start(r) - dot(&point.slope, &u);
            out[point.position] = multiplier;
            if !point.active {
                let closed = dot(&point.closure_u, &u) + point.closure_multiplier * multiplier;
                out[point.position + 1] = (r[point.position] - closed) / point.closure_gap;
            }
        }
    }
}

impl EliminatedPoint {
    fn eliminate(&mut self, entries: &[f64], active: bool) {
        let six = |range: std::ops::Range<usize>| -> [f64; 6] {
            std::array::from_fn(|i| entries[range.start + i])
        };
        self.active = active;
        self.force_multiplier = six(AT.force_multiplier);
        self.closure_u = six(AT.closure_u);
        self.closure_multiplier = entries[AT.closure_multiplier];
        self.closure_gap = entries[AT.closure_gap];
        if active {
            self.by_closure = 1.0 / self.closure_multiplier;
            self.by_complementarity = 0.0;
        } else {
            let multiplier = entries[AT.complementarity_multiplier];
            let gap = entries[AT.complementarity_gap];
            let determinant = self.closure_multiplier * gap - self.closure_gap * multiplier;
            self.by_closure = gap / determinant;
            self.by_complementarity = -self.closure_gap / determinant;
        }
        let complementarity_u = six(AT.complementarity_u);
        self.slope = std::array::from_fn(|i| {
            self.by_closure * self.closure_u[i] + self.by_complementarity * complementarity_u[i]
        });
    }

    /// λ_0 for this rank's reduced right-hand side.
    fn start(&self, r: &[f64]) -> f64 {
        let closure = self.by_closure * r[self.position];
        if self.active {
            closure
        } else {
            closure + self.by_complementarity * r[self.position + 1]
        }
    }
}

/// An element's middle node below, which belongs to one column of elements only.
const BOTTOM: usize = 4;

/// For each local node a column of elements that it belongs to.
fn slices_of_nodes(local: &Subdomain) -> Vec<usize> {
    let mut slices = vec![0; local.nodes.len()];
    for (nodes, element) in local.connectivity.iter().zip(&local.elements) {
        for &node in nodes {
            slices[node] = local.problem.mesh.column(*element);
        }
    }
    slices
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
