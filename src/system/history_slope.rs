//! What derivatives ask of histories. A derivative is kept as a [`History`], too, number for number.

use super::System;
use super::error::WrongSize;
use super::history::History;
use super::mesh_order::gather_blocks;
use super::subdomain::Subdomain;
use crate::contact::{ContactState, FrictionState};
use crate::material::PointState;

impl History {
    /// The derivative of a history whose material stays as it is, with these of the contact points.
    pub(super) fn still(of: &Subdomain, friction: Vec<FrictionState>) -> Self {
        let per_element = of.problem.quadrature.point_count();
        Self {
            gauss_points: vec![PointState::STILL; of.elements.len() * per_element],
            per_element,
            friction,
            friction_work: 0.0,
        }
    }

    /// Which Gauss points have yielded on the step to the history `next`.
    pub fn flowing(&self, next: &Self) -> Vec<bool> {
        let both = self.gauss_points.iter().zip(&next.gauss_points);
        both.map(|(before, after)| {
            after.equivalent_plastic_strain > before.equivalent_plastic_strain
        })
        .collect()
    }

    /// What each contact point of this rank does at the unknowns `u` (local) whose history this is.
    pub fn contact_states_at(&self, of: &Subdomain, u: &[f64]) -> Vec<ContactState> {
        let points = of.contacts.iter().zip(&self.friction).enumerate();
        points
            .map(|(point, (contact, committed))| {
                let m = of.multiplier(point);
                contact.law.committed_state(u[m], u[m + 1], committed)
            })
            .collect()
    }
}

impl System {
    /// A number of each Gauss point in mesh order; complete on rank 0, empty elsewhere. Collective.
    pub fn gauss_points_in_mesh_order(&self, values: &[f64]) -> Vec<f64> {
        let local = self.local();
        let (size, count) = (
            local.problem.quadrature.point_count(),
            local.problem.mesh.elements.len(),
        );
        gather_blocks(self.comm(), &local.elements, size, values, count)
    }

    /// This rank's of such numbers, of which it has all.
    ///
    /// # Errors
    /// If there are too few or too many.
    pub fn own_gauss_points(&self, all: &[f64]) -> Result<Vec<f64>, WrongSize> {
        let local = self.local();
        let size = local.problem.quadrature.point_count();
        let count = size * local.problem.mesh.elements.len();
        WrongSize::check("the Gauss points", all.len(), count)?;
        let blocks = local.elements.iter();
        Ok(blocks
            .flat_map(|element| &all[size * element..size * (element + 1)])
            .copied()
            .collect())
    }
}
