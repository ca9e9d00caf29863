//! Global rows of the unknowns: rank by rank, first the displacements of the nodes a rank owns, then
//! multiplier and gap of each of its contact points.

use super::problem::Problem;
use crate::mesh::Partition;

/// Unknowns of a contact point: multiplier and gap.
pub(super) const UNKNOWNS_PER_POINT: usize = 2;

/// Owners and rows of all unknowns, the same on every rank.
#[derive(Clone, Debug)]
pub struct Numbering {
    /// Owning rank of each node.
    pub node_owner: Vec<usize>,
    /// Row of the x displacement of each node; y follows.
    pub node_row: Vec<usize>,
    /// Row of the multiplier of the first contact point of each surface edge; the gap follows, then
    /// the edge's next point.
    pub edge_row: Vec<usize>,
    /// First row of each rank, and the number of rows at the end.
    pub rank_rows: Vec<usize>,
    /// The same if displacements alone are numbered.
    pub rank_displacements: Vec<usize>,
}

impl Numbering {
    /// Numbers the unknowns of `problem`. A node belongs to the lowest rank among its elements, a
    /// contact point to the rank of its element; faces without a tool have no contact points.
    pub fn new(problem: &Problem, partition: &Partition, ranks: usize) -> Self {
        let mesh = &problem.mesh;
        let mut node_owner = vec![usize::MAX; mesh.nodes.len()];
        for (element, nodes) in mesh.elements.iter().enumerate() {
            for &node in nodes {
                node_owner[node] = node_owner[node].min(partition[element]);
            }
        }
        let edge_unknowns = |edge: usize| match problem.tool(mesh.surface[edge].side) {
            Some(_) => UNKNOWNS_PER_POINT * problem.contact_samples(edge).len(),
            None => 0,
        };
        let edge_owner = |edge: usize| partition[mesh.surface[edge].element];
        let mut sizes = vec![0; ranks];
        for &owner in &node_owner {
            sizes[owner] += 2;
        }
        let node_unknowns = sizes.clone();
        for edge in 0..mesh.surface.len() {
            sizes[edge_owner(edge)] += edge_unknowns(edge);
        }
        let (rank_rows, rank_displacements) = (running_sum(&sizes), running_sum(&node_unknowns));
        let mut next = rank_rows.clone();
        let node_row = node_owner
            .iter()
            .map(|&owner| {
                let row = next[owner];
                next[owner] += 2;
                row
            })
            .collect();
        let mut next: Vec<usize> = (0..ranks)
            .map(|r| rank_rows[r] + node_unknowns[r])
            .collect();
        let edge_row = (0..mesh.surface.len())
            .map(|edge| {
                let row = next[edge_owner(edge)];
                next[edge_owner(edge)] += edge_unknowns(edge);
                row
            })
            .collect();
        Self {
            node_owner,
            node_row,
            edge_row,
            rank_rows,
            rank_displacements,
        }
    }

    /// Rows owned by `rank`.
    pub fn row_count(&self, rank: usize) -> usize {
        self.rank_rows[rank + 1] - self.rank_rows[rank]
    }

    /// Displacements owned by `rank`; they come first among its rows.
    pub fn displacement_count(&self, rank: usize) -> usize {
        self.rank_displacements[rank + 1] - self.rank_displacements[rank]
    }

    /// Row of the x displacement of `node` if displacements alone are numbered; y follows.
    pub fn displacement_row(&self, node: usize) -> usize {
        let owner = self.node_owner[node];
        self.node_row[node] - self.rank_rows[owner] + self.rank_displacements[owner]
    }
}

/// Sums of the first 0, 1, 2, … sizes.
fn running_sum(sizes: &[usize]) -> Vec<usize> {
    let mut sums = vec![0];
    for size in sizes {
        sums.push(sums[sums.len() - 1] + size);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::mesh::{SurfaceSide, partition};

    /// Every row of the problem is used once, on the rank that owns it.
    fn covered(problem: &Problem, ranks: usize) {
        let parts = partition(&problem.mesh, ranks).unwrap();
        let numbering = Numbering::new(problem, &parts, ranks);
        let mut seen = vec![false; numbering.rank_rows[ranks]];
        let mut mark = |row: usize| assert!(!std::mem::replace(&mut seen[row], true));
        for (node, &row) in numbering.node_row.iter().enumerate() {
            mark(row);
            mark(row + 1);
            let owner = numbering.node_owner[node];
            assert!((numbering.rank_rows[owner]..numbering.rank_rows[owner + 1]).contains(&row));
        }
        for (index, &row) in numbering.edge_row.iter().enumerate() {
            if problem.tool(problem.mesh.surface[index].side).is_some() {
                let unknowns = UNKNOWNS_PER_POINT * problem.contact_samples(index).len();
                (row..row + unknowns).for_each(&mut mark);
            }
        }
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn every_row_is_used_once() {
        let mut case = Case::reference().unwrap();
        (case.discretisation.nx, case.discretisation.ny) = (20, 2);
        let mut problem = Problem::new(&case);
        covered(&problem, 3);
        problem.upper_tool = None;
        assert!(problem.tool(SurfaceSide::Bottom).is_some());
        covered(&problem, 3);
        problem.lower_tool = None;
        covered(&problem, 2);
    }
}
