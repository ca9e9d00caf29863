//! Histories as points of a space of numbers: how a history moves along its derivative by a parameter, and the derivative
//! as a difference of two. A derivative is kept as a [`History`], too, number for number.

use super::System;
use super::error::{ElementFailure, WrongSize};
use super::history::History;
use super::mesh_order::gather_blocks;
use super::snapshot::{contact_point, friction_state, gauss_point, point_state};
use super::subdomain::Subdomain;
use crate::contact::ContactState;
use crate::material::PointState;

impl History {
    /// Becomes `base` moved by `by` times the derivative `slope`.
    pub(super) fn move_from(&mut self, base: &Self, by: f64, slope: &Self) {
        self.combine(base, slope, |base, slope| base + by * slope);
    }

    /// Becomes the derivative from two histories that are `width` of the parameter apart.
    pub(super) fn slope_between(&mut self, above: &Self, below: &Self, width: f64) {
        self.combine(above, below, |above, below| (above - below) / width);
    }

    fn combine(&mut self, a: &Self, b: &Self, f: impl Fn(f64, f64) -> f64) {
        let both = a.gauss_points.iter().zip(&b.gauss_points);
        for (point, (a, b)) in self.gauss_points.iter_mut().zip(both) {
            *point = point_state(&combined(gauss_point(a), gauss_point(b), &f));
        }
        let both = a.friction.iter().zip(&b.friction);
        for (point, (a, b)) in self.friction.iter_mut().zip(both) {
            *point = friction_state(&combined(contact_point(a), contact_point(b), &f));
        }
        self.friction_work = f(a.friction_work, b.friction_work);
    }

    /// Advances friction to time `t` (ms) and unknowns `u` (local), and the Gauss points that are flowing; the others
    /// remember what they did.
    pub(super) fn advance_flowing(
        &mut self,
        of: &Subdomain,
        t: f64,
        u: &[f64],
        flowing: &[bool],
    ) -> Result<(), ElementFailure> {
        let states = self.gauss_points.chunks_exact_mut(self.per_element);
        let elements = states.zip(flowing.chunks_exact(self.per_element));
        for (element, (states, flowing)) in elements.enumerate() {
            let values = of.element_values(element, u);
            for (point, state) in states.iter_mut().enumerate().filter(|(i, _)| flowing[*i]) {
                let (response, ..) = of.kernels[element]
                    .point_response(point, &values, &of.problem.material, state)
                    .map_err(|cause| of.element_failure(element, u, cause))?;
                *state = response.state();
            }
        }
        if of.problem.friction_coefficient > 0.0 {
            self.advance_friction(of, t, u);
        }
        Ok(())
    }

    /// Where a Gauss point yields on one side only, replaces the state of the side that does not by the mirror image of
    /// the other about the solution's, `after`: the derivative is one-sided there. The sides started `by` times `slope`
    /// above and below `before`. Returns how many there are.
    pub(super) fn mend_one_sided(
        sides: &mut [Self; 2],
        before: &Self,
        by: f64,
        slope: &Self,
        after: &Self,
    ) -> usize {
        let mut count = 0;
        for (i, start) in before.gauss_points.iter().enumerate() {
            let strain = start.equivalent_plastic_strain;
            let moved = slope.gauss_points[i].equivalent_plastic_strain;
            let yields = [(0, by), (1, -by)].map(|(side, by)| {
                let end: &PointState = &sides[side].gauss_points[i];
                end.equivalent_plastic_strain > strain + by * moved
            });
            if yields[0] == yields[1] {
                continue;
            }
            count += 1;
            let (still, other) = if yields[0] { (1, 0) } else { (0, 1) };
            let (centre, image) = (&after.gauss_points[i], &sides[other].gauss_points[i]);
            let mirrored = combined(gauss_point(centre), gauss_point(image), &|c, x| 2.0 * c - x);
            sides[still].gauss_points[i] = point_state(&mirrored);
        }
        count
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

fn combined<const N: usize>(a: [f64; N], b: [f64; N], f: &impl Fn(f64, f64) -> f64) -> [f64; N] {
    std::array::from_fn(|i| f(a[i], b[i]))
}
