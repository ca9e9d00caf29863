//! One slice of the sheet as a small dense matrix: filled, some unknowns eliminated, what is left handed on.

use petsc::FactorKind;

use super::condensation::{CondensedEntries, CondensedPattern};
use super::dense::PartialFactors;
use super::elimination_order::EliminationOrder;

/// The unknowns that no later slice touches, then the others of the slice and of what was left before it.
pub(super) struct Front {
    unknowns: Vec<usize>,
    factors: PartialFactors,
    /// Where entries of elements are added, and those of contact points and supports.
    elements: Places<8>,
    others: Places<3>,
    /// Where what the slice before left is in the matrix.
    before: Vec<Run>,
}

/// Where entries are added: those between N nodes together, as the places of these in the front are all that it takes, and
/// where some are left out or alone one by one.
struct Places<const N: usize> {
    blocks: Vec<Block<N>>,
    entries: Vec<[u32; 2]>,
}

/// The number of its first entry, and its nodes in the order of the front.
struct Block<const N: usize> {
    first: usize,
    nodes: [PlacedNode; N],
}

/// Which node of its block, and the place of its first unknown, which the second follows.
#[derive(Clone, Copy)]
struct PlacedNode {
    number: u32,
    place: u32,
}

/// Unknowns that follow each other in what was left and in the front.
struct Run {
    from: usize,
    to: usize,
    length: usize,
}

impl Front {
    /// One for each slice, in the order of their elimination, and the numbers of the entries that none of them takes.
    pub(super) fn all(
        pattern: &CondensedPattern,
        order: &EliminationOrder,
        kind: FactorKind,
    ) -> (Vec<Self>, Vec<usize>) {
        let count = pattern.slices.iter().max().map_or(0, |last| last + 1);
        let mut step = vec![None; count];
        for (place, &slice) in order.slices.iter().enumerate() {
            step[slice] = Some(place);
        }
        let mut entries = vec![Vec::new(); order.slices.len()];
        let mut passed = Vec::new();
        let indices = pattern.rows.iter().zip(&pattern.columns);
        for (number, ((&row, &column), &slice)) in indices.zip(&pattern.slices).enumerate() {
            let (Ok(row), Ok(column)) = (usize::try_from(row), usize::try_from(column)) else {
                continue;
            };
            match step[slice] {
                None => passed.push(number),
                Some(step) => entries[step].push((number, row, column)),
            }
        }
        let mut place = vec![0; order.place.len()];
        let mut fronts: Vec<Self> = Vec::with_capacity(entries.len());
        for (step, entries) in entries.into_iter().enumerate() {
            // Each unknown has an entry on the diagonal.
            let unknowns = entries.iter().map(|&(_, row, _)| row);
            let mut front = Self::new(unknowns, fronts.last(), order, step, kind);
            for (new, &old) in front.unknowns.iter().enumerate() {
                place[old] = new;
            }
            let (stride, elements) = (front.stride(), pattern.elements);
            let places = entries
                .iter()
                .map(|&(number, row, column)| (number, place[row], place[column]));
            let (of_elements, of_others): (Vec<_>, Vec<_>) =
                places.partition(|&(number, ..)| number < elements);
            front.elements = Places::new(&of_elements, 0, stride);
            front.others = Places::new(&of_others, elements, stride);
            fronts.push(front);
        }
        (fronts, passed)
    }

    fn new(
        unknowns: impl Iterator<Item = usize>,
        before: Option<&Self>,
        order: &EliminationOrder,
        step: usize,
        kind: FactorKind,
    ) -> Self {
        let carried = before.map_or(&[][..], Self::outer);
        let mut unknowns: Vec<usize> = unknowns.chain(carried.iter().copied()).collect();
        unknowns.sort_unstable_by_key(|&unknown| order.place[unknown]);
        unknowns.dedup();
        let inside = unknowns.partition_point(|&unknown| order.step[unknown] == Some(step));
        Self {
            factors: PartialFactors::new(kind, inside, unknowns.len()),
            before: Run::all(carried, &unknowns, order),
            unknowns,
            elements: Places::default(),
            others: Places::default(),
        }
    }

    /// The unknowns that are left for later slices.
    pub(super) fn outer(&self) -> &[usize] {
        &self.unknowns[self.factors.eliminated()..]
    }

    /// How far rows of its matrix are apart, and the length of its part of a vector.
    pub(super) fn stride(&self) -> usize {
        self.factors.stride()
    }

    /// The length of its matrix.
    pub(super) fn room(&self) -> usize {
        self.unknowns.len() * self.stride()
    }

    /// Eliminates, for the entries of the pattern and what the slice before left, in place of which it puts what it leaves
    /// itself, row by row; of a symmetric matrix only the upper triangle counts. `matrix` is room for its own. Says whether that
    /// could be done.
    pub(super) fn eliminate(
        &mut self,
        entries: CondensedEntries<'_>,
        left: &mut [f64],
        matrix: &mut [f64],
    ) -> bool {
        let matrix = &mut matrix[..self.room()];
        matrix.fill(0.0);
        self.add_before(left, matrix);
        let (kind, stride) = (self.factors.kind(), self.stride());
        self.elements.add(entries.elements, matrix, stride, kind);
        self.others.add(entries.others, matrix, stride, kind);
        let usable = self.factors.factor(matrix);
        let (inside, outer) = (self.factors.eliminated(), self.outer().len());
        let rows = matrix.chunks_exact(self.stride().max(1)).skip(inside);
        for (left, row) in left.chunks_exact_mut(outer.max(1)).zip(rows) {
            left.copy_from_slice(&row[inside..inside + outer]);
        }
        usable
    }

    /// Adds what the slice before left.
    fn add_before(&self, left: &[f64], matrix: &mut [f64]) {
        let size: usize = self.before.iter().map(|run| run.length).sum();
        for rows in &self.before {
            for offset in 0..rows.length {
                let row = rows.from + offset;
                let source = &left[row * size..][..size];
                let target = &mut matrix[(rows.to + offset) * self.stride()..];
                for run in &self.before {
                    let source = &source[run.from..][..run.length];
                    for (sum, value) in target[run.to..].iter_mut().zip(source) {
                        *sum += value;
                    }
                }
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
        let part = &mut part[..self.stride()];
        part[self.unknowns.len()..].fill(0.0);
        for (value, &unknown) in part.iter_mut().zip(&self.unknowns) {
            *value = all[unknown];
        }
        substitute(&self.factors, part);
        for (value, &unknown) in part.iter().zip(&self.unknowns) {
            all[unknown] = *value;
        }
    }
}

impl<const N: usize> Places<N> {
    /// For numbers of entries, ascending, with row and column in the front; the numbers are counted from `first` on, and
    /// 2N x 2N that follow each other from a multiple of it are those between N nodes, row by row.
    fn new(entries: &[(usize, usize, usize)], first: usize, stride: usize) -> Self {
        let mut places = Self::default();
        let size = 4 * N * N;
        for block in entries.chunk_by(|a, b| (a.0 - first) / size == (b.0 - first) / size) {
            match Block::new(block, first) {
                Some(block) => places.blocks.push(block),
                None => places
                    .entries
                    .extend(block.iter().map(|&(number, row, column)| {
                        [(number - first) as u32, (row * stride + column) as u32]
                    })),
            }
        }
        places
    }

    /// Adds entries to a matrix. Of a symmetric one only the upper triangle counts, and below it only what is in a node's own
    /// block is filled.
    fn add(&self, entries: &[f64], matrix: &mut [f64], stride: usize, kind: FactorKind) {
        for Block { first, nodes } in &self.blocks {
            let entries = &entries[*first..][..4 * N * N];
            for (i, row) in nodes.iter().enumerate() {
                let after = match kind {
                    FactorKind::Symmetric => &nodes[i..],
                    FactorKind::General => &nodes[..],
                };
                let values = &entries[4 * N * row.number as usize..][..4 * N];
                let sums = &mut matrix[row.place as usize * stride..][..2 * stride];
                let (x, y) = sums.split_at_mut(stride);
                let (of_x, of_y) = values.split_at(2 * N);
                for column in after {
                    let (to, from) = (column.place as usize, 2 * column.number as usize);
                    let [x, y] = [&mut x[to..to + 2], &mut y[to..to + 2]];
                    let [of_x, of_y] = [&of_x[from..from + 2], &of_y[from..from + 2]];
                    x[0] += of_x[0];
                    x[1] += of_x[1];
                    y[0] += of_y[0];
                    y[1] += of_y[1];
                }
            }
        }
        for &[number, place] in &self.entries {
            matrix[place as usize] += entries[number as usize];
        }
    }
}

impl<const N: usize> Block<N> {
    /// Of some of its entries, if all are there and the two unknowns of each node follow each other.
    fn new(entries: &[(usize, usize, usize)], first: usize) -> Option<Self> {
        let column = |i: usize| entries.get(i).map(|entry| entry.2);
        let mut nodes = [PlacedNode {
            number: 0,
            place: 0,
        }; N];
        for (node, number) in nodes.iter_mut().zip(0..) {
            *node = PlacedNode {
                number,
                place: column(2 * number as usize)? as u32,
            };
        }
        let place = |i: usize| nodes[i / 2].place as usize + i % 2;
        let whole = entries.len() == 4 * N * N
            && entries.iter().enumerate().all(|(at, &(_, row, column))| {
                [row, column] == [place(at / (2 * N)), place(at % (2 * N))]
            });
        nodes.sort_unstable_by_key(|node| node.place);
        whole.then_some(Self {
            first: entries[0].0 - first,
            nodes,
        })
    }
}

impl<const N: usize> Default for Places<N> {
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            entries: Vec::new(),
        }
    }
}

impl Run {
    /// How the unknowns left before lie among those of a front, both in their order.
    fn all(before: &[usize], front: &[usize], order: &EliminationOrder) -> Vec<Self> {
        let mut runs: Vec<Self> = Vec::new();
        for (from, unknown) in before.iter().enumerate() {
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
