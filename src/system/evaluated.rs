//! An accepted step as its derivatives need it: what every Gauss point and contact point answered, for all parameters at once.

use super::error::ElementFailure;
use super::history::History;
use super::subdomain::Subdomain;
use crate::contact::{PointPosition, Traction};
use crate::element::EvaluatedPoint;

/// An accepted step on one rank.
pub struct EvaluatedStep<'a> {
    /// The subdomain.
    pub(super) of: &'a Subdomain,
    /// What the step started from.
    pub(super) before: &'a History,
    /// Unknowns at its end, mm.
    pub(super) u: &'a [f64],
    /// Accelerations in its equations, mm/ms².
    pub(super) a: &'a [f64],
    gauss_points: Vec<EvaluatedPoint>,
    /// Where each contact point is, and its friction.
    pub(super) contacts: Vec<(PointPosition, Traction)>,
}

impl Subdomain {
    /// The step from the history `before` to time `t` (ms) and unknowns `u`, with accelerations `a` (local).
    ///
    /// # Errors
    /// If an element cannot be evaluated, which an accepted step rules out.
    pub fn evaluated<'a>(
        &'a self,
        before: &'a History,
        t: f64,
        u: &'a [f64],
        a: &'a [f64],
    ) -> Result<EvaluatedStep<'a>, ElementFailure> {
        let material = &self.problem.material;
        let mut gauss_points = Vec::with_capacity(before.gauss_points.len());
        for (element, kernel) in self.kernels.iter().enumerate() {
            let values = self.element_values(element, u);
            for (point, state) in before.element(element).iter().enumerate() {
                let (response, f, _) = kernel
                    .point_response(point, &values, material, state)
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                let excess = material.excess(&response);
                gauss_points.push(kernel.evaluated(point, response, f, excess));
            }
        }
        let points = 0..self.contacts.len();
        let contacts = points.map(|point| self.contact_answer(before, t, u, point));
        Ok(EvaluatedStep {
            of: self,
            before,
            u,
            a,
            gauss_points,
            contacts: contacts.collect(),
        })
    }
}

impl EvaluatedStep<'_> {
    /// Gauss points of a local element.
    pub(super) fn points(&self, element: usize) -> &[EvaluatedPoint] {
        let size = self.before.per_element;
        &self.gauss_points[size * element..size * (element + 1)]
    }
}
