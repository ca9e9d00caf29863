//! Contact points that every rank has to know.

use super::System;
use crate::mesh::SurfaceSide;
use crate::ranks::{gather_lists, rows};

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
    /// The places of some of this rank's contact points (number and mark) and those of all other ranks, from the middle
    /// outwards. Collective.
    pub fn share_places(&self, mine: &[(usize, u8)]) -> Vec<ContactPlace> {
        let local = self.local();
        let flat: Vec<f64> = mine
            .iter()
            .flat_map(|&(point, mark)| {
                let contact = &local.contacts[point];
                let along = local.contact_reference(contact)[0];
                let upper = f64::from(u8::from(contact.side == SurfaceSide::Top));
                [along, upper, f64::from(mark)]
            })
            .collect();
        let all = gather_lists(self.comm(), &flat);
        let mut places: Vec<_> = rows(&all)
            .into_iter()
            .map(|[along, upper, mark]| ContactPlace {
                along,
                side: if upper > 0.0 {
                    SurfaceSide::Top
                } else {
                    SurfaceSide::Bottom
                },
                mark: mark as u8,
            })
            .collect();
        places.sort_by(|a, b| a.along.total_cmp(&b.along));
        places
    }
}
