//! What is known at the contact points.

use super::history::History;
use super::subdomain::Subdomain;
use crate::contact::ContactState;

/// What is known at a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointSample {
    /// Position in the reference configuration, mm; of a moving point the middle of its edge.
    pub reference: [f64; 2],
    /// From there to where it is now, mm.
    pub displacement: [f64; 2],
    /// Contact pressure, MPa.
    pub pressure: f64,
    /// Signed distance to the tool, mm.
    pub gap: f64,
    /// Friction traction on the sheet along the tool, committed, MPa.
    pub friction: f64,
    /// Whether it carries a force and slips.
    pub state: ContactState,
}

impl Subdomain {
    /// All contact points of this rank at time `t` (ms) and unknowns `u` (local), whose history this is.
    pub fn contact_points(&self, history: &History, t: f64, u: &[f64]) -> Vec<ContactPointSample> {
        let young = self.problem.young_modulus;
        let points = self.contacts.iter().zip(&history.friction).enumerate();
        points
            .map(|(point, (contact, committed))| {
                let m = self.multiplier(point);
                let position = self.contact_position(contact, committed, t, u);
                let reference = self.contact_reference(contact);
                ContactPointSample {
                    reference,
                    displacement: [position.x[0] - reference[0], position.x[1] - reference[1]],
                    pressure: young * u[m] / contact.length,
                    gap: position.distance.value,
                    friction: young * committed.traction / contact.length,
                    state: contact.law.committed_state(u[m], u[m + 1], committed),
                }
            })
            .collect()
    }

    /// States of this rank's contact points at an iterate: time `t` (ms) and local unknowns `u`, which start from the
    /// history.
    pub fn contact_states(&self, history: &History, t: f64, u: &[f64]) -> Vec<ContactState> {
        let points = self.contacts.iter().zip(&history.friction).enumerate();
        points
            .map(|(point, (contact, committed))| {
                let m = self.multiplier(point);
                let position = self.contact_position(contact, committed, t, u);
                let traction = contact.law.traction(&position, u[m], committed);
                traction.state_at(u[m + 1])
            })
            .collect()
    }
}
