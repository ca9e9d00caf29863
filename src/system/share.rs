//! What one rank found and all have to know.

use mpi::traits::{Communicator, Root};

use super::System;
use crate::mesh::SurfaceSide;
use crate::ranks::{gather_lists, lowest_failing};

/// An element that could not be evaluated, as every rank knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedElement {
    /// Mesh number.
    pub element: usize,
    /// Its current position, mm.
    pub position: [f64; 2],
    /// What is wrong.
    pub cause: String,
}

/// A contact point, as every rank knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPlace {
    /// Place along the undeformed sheet from its middle, mm.
    pub along: f64,
    /// Face of the sheet.
    pub side: SurfaceSide,
    /// Any number that goes with it.
    pub mark: u8,
}

impl System {
    /// Takes why the last evaluation failed, from the lowest rank on which it did since this was last asked. Collective.
    pub fn take_shared_failure(&self) -> Option<FailedElement> {
        let comm = self.comm();
        let mine = self.take_failure();
        let lowest = lowest_failing(comm, mine.is_some())?;
        let root = comm.process_at_rank(lowest);
        let (mut numbers, mut words) = ([0.0; 3], Vec::new());
        if let (Some(mine), true) = (mine, comm.rank() == lowest) {
            numbers = [mine.element as f64, mine.position[0], mine.position[1]];
            words = mine.cause.to_string().into_bytes();
        }
        let mut length = words.len() as u64;
        root.broadcast_into(&mut numbers[..]);
        root.broadcast_into(&mut length);
        words.resize(length as usize, 0);
        root.broadcast_into(&mut words[..]);
        Some(FailedElement {
            element: numbers[0] as usize,
            position: [numbers[1], numbers[2]],
            cause: String::from_utf8_lossy(&words).into_owned(),
        })
    }

    /// The places of some of this rank's contact points (number and mark) and those of all other ranks, from the middle
    /// outwards. Collective.
    pub fn share_places(&self, mine: &[(usize, u8)]) -> Vec<ContactPlace> {
        let comm = self.comm();
        let local = self.local();
        let flat: Vec<f64> = mine
            .iter()
            .flat_map(|&(point, mark)| {
                let (place, side) = local.contact_reference(point);
                let upper = f64::from(u8::from(side == SurfaceSide::Top));
                [place[0], upper, f64::from(mark)]
            })
            .collect();
        let all = gather_lists(comm, &flat);
        let mut places: Vec<_> = all
            .chunks_exact(3)
            .map(|values| ContactPlace {
                along: values[0],
                side: if values[1] > 0.0 {
                    SurfaceSide::Top
                } else {
                    SurfaceSide::Bottom
                },
                mark: values[2] as u8,
            })
            .collect();
        places.sort_by(|a, b| a.along.total_cmp(&b.along));
        places
    }
}
