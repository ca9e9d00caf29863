//! One slice of the sheet as a small dense matrix: filled, its inside eliminated, what is left handed on.

use std::ops::Range;

use petsc::FactorKind;

use super::condensation::{CondensedEntries, CondensedPattern};
use super::dense::PartialFactors;
use super::elimination_order::EliminationOrder;

/// A slice: the unknowns inside it, then those on its ends.
pub(super) struct Front {
    kind: FactorKind,
    unknowns: Vec<usize>,
    inside: usize,
    factors: PartialFactors,
    /// In the first layer: number of an entry of an element or of another one, and where in the matrix it is added.
    elements: Vec<[u32; 2]>,
    others: Vec<[u32; 2]>,
    /// In the others: what slices of the layer below left.
    parts: Vec<Part>,
    /// Where what it leaves itself lies among the values of its layer.
    left: Range<usize>,
}

/// Where a front finds its entries.
#[derive(Clone, Copy)]
pub(super) enum Below<'a> {
    /// Those of the pattern, for the first layer.
    Entries(CondensedEntries<'a>),
    /// The values of the layer below.
    Layer(&'a [f64]),
}

/// What a slice of the layer below left.
struct Part {
    values: Range<usize>,
    runs: Vec<Run>,
}

/// Unknowns that follow each other in the part and in the front.
struct Run {
    from: usize,
    to: usize,
    length: usize,
}

impl Front {
    /// The slices of the first layer.
    pub(super) fn of_entries(
        pattern: &CondensedPattern,
        order: &EliminationOrder,
        kind: FactorKind,
    ) -> Vec<Self> {
        let count = pattern.slices.iter().max().map_or(0, |last| last + 1);
        let mut slices = vec![Vec::new(); count];
        let indices = pattern.rows.iter().zip(&pattern.columns);
        for (number, ((&row, &column), &slice)) in indices.zip(&pattern.slices).enumerate() {
            if let (Ok(row), Ok(column)) = (usize::try_from(row), usize::try_from(column)) {
                let upper = order.place[row] <= order.place[column];
                if upper || kind == FactorKind::General {
                    slices[slice].push((number, row, column));
                }
            }
        }
        let mut place = vec![0; order.place.len()];
        let fronts = slices.into_iter().map(|entries| {
            // Each unknown has an entry on the diagonal.
            let unknowns = entries.iter().map(|&(_, row, _)| row).collect();
            let mut front = Self::of(unknowns, order, 0, kind);
            for (new, &old) in front.unknowns.iter().enumerate() {
                place[old] = new;
            }
            let size = front.unknowns.len();
            for (number, row, column) in entries {
                let place = (place[row] * size + place[column]) as u32;
                match number.checked_sub(pattern.elements) {
                    None => front.elements.push([number as u32, place]),
                    Some(number) => front.others.push([number as u32, place]),
                }
            }
            front
        });
        fronts.collect()
    }

    /// A slice of a layer, made of these neighbours in the layer below.
    pub(super) fn of_parts(
        parts: &[Self],
        order: &EliminationOrder,
        layer: usize,
        kind: FactorKind,
    ) -> Self {
        let unknowns = parts.iter().flat_map(Self::outer).copied().collect();
        let mut front = Self::of(unknowns, order, layer, kind);
        let parts = parts.iter().map(|part| Part {
            values: part.left.clone(),
            runs: Run::all(part.outer(), &front.unknowns, order),
        });
        front.parts = parts.collect();
        front
    }

    fn of(
        mut unknowns: Vec<usize>,
        order: &EliminationOrder,
        layer: usize,
        kind: FactorKind,
    ) -> Self {
        unknowns.sort_unstable_by_key(|&unknown| order.place[unknown]);
        unknowns.dedup();
        let inside = unknowns.partition_point(|&unknown| order.layer[unknown] <= layer);
        Self {
            kind,
            factors: PartialFactors::new(kind, inside, unknowns.len()),
            unknowns,
            inside,
            elements: Vec::new(),
            others: Vec::new(),
            parts: Vec::new(),
            left: 0..0,
        }
    }

    pub(super) fn unknowns(&self) -> &[usize] {
        &self.unknowns
    }

    /// The unknowns on its ends.
    pub(super) fn outer(&self) -> &[usize] {
        &self.unknowns[self.inside..]
    }

    /// Puts what it leaves at this place among the values of its layer, and returns the next one.
    pub(super) fn leave_from(&mut self, start: usize) -> usize {
        self.left = start..start + self.outer().len().pow(2);
        self.left.end
    }

    /// From the entries of the pattern or the values of the layer below to those of its own layer; of a symmetric matrix
    /// the upper triangle only. `rows` is room for the rows of the unknowns on the ends. Says whether that could be done.
    pub(super) fn eliminate(
        &mut self,
        below: Below<'_>,
        rows: &mut [f64],
        values: &mut [f64],
    ) -> bool {
        let (size, outer) = (self.unknowns.len(), self.outer().len());
        let rows = &mut rows[..outer * size];
        let inside = self.factors.rows();
        inside.fill(0.0);
        rows.fill(0.0);
        match below {
            Below::Entries(entries) => {
                add(&self.elements, entries.elements, inside, rows);
                add(&self.others, entries.others, inside, rows);
            }
            Below::Layer(below) => {
                for part in &self.parts {
                    part.add(&below[part.values.clone()], [inside, rows], size, self.kind);
                }
            }
        }
        let usable = self.factors.factor(rows);
        let left = values[self.left.clone()].chunks_exact_mut(outer.max(1));
        for (i, (left, row)) in left.zip(rows.chunks_exact(size.max(1))).enumerate() {
            let first = first_column(self.kind, i);
            left[first..].copy_from_slice(&row[self.inside + first..]);
        }
        usable
    }

    /// Completes what it left of a symmetric matrix below the diagonal.
    pub(super) fn mirror(&self, values: &mut [f64]) {
        let outer = self.outer().len();
        let left = &mut values[self.left.clone()];
        for i in 0..outer {
            for j in 0..i {
                left[i * outer + j] = left[j * outer + i];
            }
        }
    }

    /// One substitution with its part of a vector.
    pub(super) fn visit(
        &self,
        all: &mut [f64],
        part: &mut [f64],
        substitute: impl Fn(&PartialFactors, &mut [f64]),
    ) {
        let part = &mut part[..self.unknowns.len()];
        for (value, &unknown) in part.iter_mut().zip(&self.unknowns) {
            *value = all[unknown];
        }
        substitute(&self.factors, part);
        for (value, &unknown) in part.iter().zip(&self.unknowns) {
            all[unknown] = *value;
        }
    }
}

/// Adds entries to a front: to rows inside it or on its ends.
fn add(places: &[[u32; 2]], entries: &[f64], inside: &mut [f64], ends: &mut [f64]) {
    for &[number, place] in places {
        let (value, place) = (entries[number as usize], place as usize);
        match place.checked_sub(inside.len()) {
            None => inside[place] += value,
            Some(place) => ends[place] += value,
        }
    }
}

impl Part {
    /// Adds it to a front: rows inside it and on its ends.
    fn add(&self, values: &[f64], [inside, ends]: [&mut [f64]; 2], size: usize, kind: FactorKind) {
        let width = self.runs.iter().map(|run| run.length).sum();
        for rows in &self.runs {
            for offset in 0..rows.length {
                let row = rows.from + offset;
                let source = &values[row * width..][..width];
                let target = (rows.to + offset) * size;
                let target = match target.checked_sub(inside.len()) {
                    None => &mut inside[target..][..size],
                    Some(target) => &mut ends[target..][..size],
                };
                let first = first_column(kind, row);
                for run in self.runs.iter().filter(|run| run.from + run.length > first) {
                    let skip = first.saturating_sub(run.from);
                    let source = &source[run.from + skip..run.from + run.length];
                    let target = &mut target[run.to + skip..run.to + run.length];
                    for (sum, value) in target.iter_mut().zip(source) {
                        *sum += value;
                    }
                }
            }
        }
    }
}

impl Run {
    /// How the unknowns of a part lie among those of a front, both in their order.
    fn all(part: &[usize], front: &[usize], order: &EliminationOrder) -> Vec<Self> {
        let mut runs: Vec<Self> = Vec::new();
        for (from, unknown) in part.iter().enumerate() {
            let place = order.place[*unknown];
            let to = front.partition_point(|&other| order.place[other] < place);
            match runs.last_mut().filter(|run| run.to + run.length == to) {
                Some(run) => run.length += 1,
                None => runs.push(Self {
                    from,
                    to,
                    length: 1,
                }),
            }
        }
        runs
    }
}

/// The first column of a row that counts.
fn first_column(kind: FactorKind, row: usize) -> usize {
    match kind {
        FactorKind::General => 0,
        FactorKind::Symmetric => row,
    }
}
