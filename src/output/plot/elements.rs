//! Deformed elements as the figure needs them, from one rank or from all.

use mpi::datatype::PartitionMut;
use mpi::traits::{Communicator, CommunicatorCollectives, Root};

use super::super::{FieldSample, SheetPart};

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
    pub fn of(part: &SheetPart, samples: &[FieldSample]) -> Vec<Self> {
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
    const SIZE: usize = 17;
    let flat: Vec<f64> = mine
        .iter()
        .flat_map(|e| e.nodes.into_iter().flatten().chain([e.plastic_strain]))
        .collect();
    let mut counts = vec![0_i32; comm.size() as usize];
    comm.all_gather_into(&(flat.len() as i32), &mut counts[..]);
    let root = comm.process_at_rank(0);
    if comm.rank() != 0 {
        root.gather_varcount_into(&flat[..]);
        return Vec::new();
    }
    let starts: Vec<i32> = counts
        .iter()
        .scan(0, |end, count| Some(std::mem::replace(end, *end + count)))
        .collect();
    let mut all = vec![0.0; counts.iter().sum::<i32>() as usize];
    root.gather_varcount_into_root(
        &flat[..],
        &mut PartitionMut::new(&mut all[..], counts, starts),
    );
    let element = |values: &[f64]| DeformedElement {
        nodes: std::array::from_fn(|node| [values[2 * node], values[2 * node + 1]]),
        plastic_strain: values[SIZE - 1],
    };
    all.chunks_exact(SIZE).map(element).collect()
}
