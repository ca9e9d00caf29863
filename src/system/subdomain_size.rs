//! How much of the problem each rank has.

use super::System;
use super::numbering::UNKNOWNS_PER_POINT;

/// The size of one rank's subdomain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SubdomainSize {
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

impl SubdomainSize {
    /// Of all ranks, known on every rank.
    pub fn of_all(system: &System) -> Vec<Self> {
        let (mesh, numbering) = (&system.local().problem.mesh, system.numbering());
        let mut sizes = vec![Self::default(); numbering.rank_rows.len() - 1];
        let mut users = vec![Vec::new(); mesh.nodes.len()];
        for (element, &rank) in system.partition().iter().enumerate() {
            sizes[rank].elements += 1;
            for &node in &mesh.elements[element] {
                if !users[node].contains(&rank) {
                    users[node].push(rank);
                }
            }
        }
        for ranks in &users {
            for &rank in ranks {
                sizes[rank].nodes += 1;
                sizes[rank].shared_nodes += usize::from(ranks.len() > 1);
            }
        }
        for (rank, size) in sizes.iter_mut().enumerate() {
            size.unknowns = numbering.row_count(rank);
            let contact = size.unknowns - numbering.displacement_count(rank);
            size.contact_points = contact / UNKNOWNS_PER_POINT;
        }
        sizes
    }
}
