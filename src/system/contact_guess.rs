//! Contact in the first guess of a step, and when a new part of the sheet will touch down.

use petsc::VectorRef;

use super::System;
use super::contact_profile::{ContactProfile, NEAR, NearPoint};
use super::subdomain::LocalContact;
use crate::contact::{ContactRule, FrictionState};
use crate::mesh::SurfaceSide;
use crate::ranks;
use crate::tool::Distance;

/// A new part of the sheet touches down if it would enter the tool by more than this within the step, mm.
const TOUCHDOWN: f64 = 0.05;
/// So deep it would enter by the end of a step that is shortened for it, mm: deep enough to touch for certain.
const TOUCHED: f64 = 0.02;

/// Unknowns at a time (ms).
#[derive(Clone, Copy)]
pub struct StateAt<'a> {
    /// Time, ms.
    pub t: f64,
    /// Unknowns.
    pub u: &'a VectorRef,
}

/// Distances of the sheet along both tools.
pub struct ContactProfiles {
    bottom: ContactProfile,
    top: ContactProfile,
}

impl ContactProfiles {
    fn of(&self, side: SurfaceSide) -> &ContactProfile {
        match side {
            SurfaceSide::Bottom => &self.bottom,
            SurfaceSide::Top => &self.top,
        }
    }
}

impl System {
    /// Distances along the tools of an accepted state, the same on every rank; none where contact is not looked for at
    /// points that are dense on the sheet and fixed to it. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn contact_profiles(&self, state: StateAt<'_>) -> petsc::Result<Option<ContactProfiles>> {
        let ContactRule::Points(_) = &self.problem().contact_rule else {
            return Ok(None);
        };
        let values = self.local_values(state.u)?;
        let profile = |side| {
            let contacts = self.local.contacts.iter().filter(|c| c.side == side);
            let near: Vec<f64> = contacts
                .map(|contact| self.distance(contact, state.t, &values))
                .filter(|distance| distance.value < NEAR)
                .flat_map(|distance| [distance.arc_length(), distance.value])
                .collect();
            let all = ranks::gather_lists(&self.comm, &near);
            let point = |pair: &[f64]| NearPoint {
                along: pair[0],
                distance: pair[1],
            };
            ContactProfile::new(all.chunks_exact(2).map(point).collect())
        };
        Ok(Some(ContactProfiles {
            bottom: profile(SurfaceSide::Bottom),
            top: profile(SurfaceSide::Top),
        }))
    }

    /// Sets multipliers and gaps of a first guess at time `t` (ms), whose displacements are there, to what the profiles
    /// of the last step and of the one before lead to expect; `ratio` is this step's length by that of the last one. A
    /// tool whose profile shows too little keeps what is there. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn guess_contact(
        &self,
        [now, before]: [&ContactProfiles; 2],
        ratio: f64,
        t: f64,
        guess: &mut VectorRef,
    ) -> petsc::Result<()> {
        let values = self.local_values(guess)?;
        let mut guess = guess.write()?;
        for (gap, contact) in self.owned_gaps().zip(&self.local.contacts) {
            let (now, before) = (now.of(contact.side), before.of(contact.side));
            if !now.is_resolved() {
                continue;
            }
            let distance = self.distance(contact, t, &values);
            let expected = now.expected(distance.arc_length(), before, ratio);
            (guess[gap - 1], guess[gap]) = match expected {
                Some(expected) if expected < 0.0 => (-expected / contact.law.compliance, 0.0),
                _ => (0.0, distance.value.max(0.0)),
            };
        }
        Ok(())
    }

    /// After what share of the way between two states a part of the sheet touches a tool that is nowhere near a zone of
    /// contact now; none if that does not happen. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn touchdown(
        &self,
        now: &ContactProfiles,
        [from, to]: [StateAt<'_>; 2],
    ) -> petsc::Result<Option<f64>> {
        let (start, end) = (self.local_values(from.u)?, self.local_values(to.u)?);
        let mut mine = f64::INFINITY;
        for contact in &self.local.contacts {
            let there = self.distance(contact, to.t, &end);
            if there.value > -TOUCHDOWN || now.of(contact.side).reaches(there.arc_length()) {
                continue;
            }
            let here = self.distance(contact, from.t, &start).value;
            if here > 0.0 {
                mine = mine.min((here + TOUCHED) / (here - there.value));
            }
        }
        let share = ranks::smallest(&self.comm, mine);
        Ok((share < 1.0).then_some(share))
    }

    /// Of a fixed contact point, whose place does not depend on what it remembers.
    fn distance(&self, contact: &LocalContact, t: f64, values: &[f64]) -> Distance {
        let nothing = FrictionState::default();
        let position = self.local.contact_position(contact, &nothing, t, values);
        position.distance
    }
}
