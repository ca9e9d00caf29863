//! Deformed elements as the figure needs them, from one rank or from all.

use mpi::traits::Communicator;

use crate::output::SheetPart;
use crate::ranks::gather_lists;
use crate::system::NodeSample;

/// Numbers of an element: two for each node, and its strain.
const SIZE: usize = 17;

/// One 8-node element in its deformed position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeformedElement {
    /// Deformed positions [x, y] of the nodes, mm: corners counter-clockwise, then mid-sides.
    pub nodes: [[f64; 2]; 8],
    /// Equivalent plastic strain, one value for the element.
    pub plastic_strain: f64,
}

impl DeformedElement {
    /// The elements of a part, each with the mean plastic strain of its nodes.
    pub fn of(part: &SheetPart, samples: &[NodeSample]) -> Vec<Self> {
        let element = |quad: &[usize; 8]| Self {
            nodes: quad.map(|node| {
                let ([x, y], [ux, uy]) = (part.coordinates[node], samples[node].displacement);
                [x + ux, y + uy]
            }),
            plastic_strain: quad
                .map(|node| samples[node].equivalent_plastic_strain)
                .iter()
                .sum::<f64>()
                / 8.0,
        };
        part.quads.iter().map(element).collect()
    }
}

/// Brings the elements of all ranks to rank 0, in the order of the ranks; the other ranks get none. Collective.
pub fn gather_elements(comm: &impl Communicator, mine: &[DeformedElement]) -> Vec<DeformedElement> {
    let flat: Vec<f64> = mine
        .iter()
        .flat_map(|e| e.nodes.into_iter().flatten().chain([e.plastic_strain]))
        .collect();
    let all = gather_lists(comm, &flat);
    if comm.rank() != 0 {
        return Vec::new();
    }
    let element = |values: &[f64]| DeformedElement {
        nodes: std::array::from_fn(|node| [values[2 * node], values[2 * node + 1]]),
        plastic_strain: values[SIZE - 1],
    };
    all.chunks_exact(SIZE).map(element).collect()
}
