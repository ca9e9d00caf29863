//! How much of the problem each rank has.

use super::{System, UNKNOWNS_PER_POINT};

/// The share of one rank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// Elements.
    pub elements: usize,
    /// Nodes of these elements.
    pub nodes: usize,
    /// Those of them that other ranks have, too.
    pub shared_nodes: usize,
    /// Contact points.
    pub contact_points: usize,
    /// Unknowns it owns.
    pub unknowns: usize,
}

impl System {
    /// The shares of all ranks, known on every rank.
    pub fn shares(&self) -> Vec<Share> {
        let local = self.local();
        let problem = local.problem();
        let (mesh, ranks) = (&problem.mesh, self.numbering.rank_rows.len() - 1);
        let mut shares = vec![Share::default(); ranks];
        let mut users = vec![Vec::new(); mesh.nodes.len()];
        for (element, &rank) in self.parts.iter().enumerate() {
            shares[rank].elements += 1;
            for &node in &mesh.elements[element] {
                if !users[node].contains(&rank) {
                    users[node].push(rank);
                }
            }
        }
        for ranks in &users {
            for &rank in ranks {
                shares[rank].nodes += 1;
                shares[rank].shared_nodes += usize::from(ranks.len() > 1);
            }
        }
        for (rank, share) in shares.iter_mut().enumerate() {
            share.unknowns = self.numbering.row_count(rank);
            let contact = share.unknowns - self.numbering.displacement_count(rank);
            share.contact_points = contact / UNKNOWNS_PER_POINT;
        }
        shares
    }
}
