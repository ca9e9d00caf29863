//! What a sheet remembers of its accepted steps.

use super::Subdomain;
use super::error::ElementFailure;
use crate::contact::FrictionState;
use crate::material::PointState;

/// The committed history of one rank's material and contact points. Evaluations read it; a step that is accepted makes
/// a new one ([`History::advanced`]).
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Gauss point by Gauss point, element by element.
    pub(super) gauss_points: Vec<PointState>,
    /// Gauss points of an element.
    pub(super) per_element: usize,
    /// Contact point by contact point.
    pub(super) friction: Vec<FrictionState>,
    /// Work of friction that this rank has added up, mJ per mm of width.
    pub(super) friction_work: f64,
}

impl History {
    /// Of a sheet that has not moved: no plastic strain, and every contact point at the foot point of its first position.
    pub fn virgin(of: &Subdomain) -> Self {
        let per_element = of.problem.quadrature.point_count();
        let friction = of.contacts.iter().map(|contact| {
            let nodes = contact.nodes.map(|n| of.coordinates[n]);
            let x = contact.reference(&nodes);
            FrictionState {
                traction: 0.0,
                arc_length: contact.tool.profile.distance(x).arc_length(),
                nodes,
            }
        });
        Self {
            gauss_points: vec![PointState::VIRGIN; of.elements.len() * per_element],
            per_element,
            friction: friction.collect(),
            friction_work: 0.0,
        }
    }

    /// The same material without contact.
    pub fn without_contact(&self) -> Self {
        Self {
            gauss_points: self.gauss_points.clone(),
            per_element: self.per_element,
            friction: Vec::new(),
            friction_work: 0.0,
        }
    }

    /// States of the Gauss points of a local element.
    pub(super) fn element(&self, element: usize) -> &[PointState] {
        &self.gauss_points[self.per_element * element..self.per_element * (element + 1)]
    }

    /// The history after an accepted step to time `t` (ms) and unknowns `u` (local).
    pub fn advanced(&self, of: &Subdomain, t: f64, u: &[f64]) -> Result<Self, ElementFailure> {
        let mut next = self.clone();
        let states = next.gauss_points.chunks_exact_mut(self.per_element);
        for (element, states) in states.enumerate() {
            let values = of.element_values(element, u);
            for (point, state) in states.iter_mut().enumerate() {
                let (response, ..) = of.kernels[element]
                    .point_response(point, &values, &of.problem.material, state)
                    .map_err(|cause| of.element_failure(element, u, cause))?;
                *state = response.state();
            }
        }
        next.advance_friction(of, t, u);
        Ok(next)
    }

    pub(super) fn advance_friction(&mut self, of: &Subdomain, t: f64, u: &[f64]) {
        let young = of.problem.young_modulus;
        for (point, (contact, state)) in of.contacts.iter().zip(&mut self.friction).enumerate() {
            let multiplier = u[of.multiplier(point)];
            let nodes = of.edge_positions(contact, u);
            let position = contact.position(&nodes, t, state);
            let traction = contact.law.traction(&position, multiplier, state).value;
            let mean_force = 0.5 * young * (state.traction + traction);
            self.friction_work -= mean_force * position.slip;
            let shift = contact.tool.motion.shift(t);
            *state = FrictionState {
                traction,
                arc_length: position.distance.arc_length(),
                nodes: nodes.map(|x| [x[0] - shift[0], x[1] - shift[1]]),
            };
        }
    }
}
