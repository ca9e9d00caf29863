//! Residual of one rank's subdomain.
//!
//! Forces are divided by Young's modulus, so that every row is in millimetres. With the multiplier λ and the scaled
//! friction force λ_t of each contact point, ∇φ and ∇s the gradients of the distance to its tool and of the arc length
//! along it, and p the dead loads,
//!
//! ```text
//! F_u = (R_int(u) + M a - p(t)) / E - Σ (λ ∇φ + λ_t ∇s) N     and the two rows of each contact point
//! F_u = u - u_given(t)                                         where a displacement is prescribed
//! ```

use super::error::ElementFailure;
use super::history::History;
use super::subdomain::{LocalContact, Subdomain};
use crate::contact::{FrictionState, PointPosition};
use crate::element::ElementForce;

impl Subdomain {
    /// This rank's contributions to the residual at time `t` (ms), unknowns `u` and their second time derivatives `a`
    /// (all local; mm, mm/ms²).
    pub fn residual(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        a: &[f64],
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        out.fill(0.0);
        self.add_internal_forces(history, u, out)?;
        self.add_inertia(a, out);
        self.add_contact(history, t, u, out);
        let scale = 1.0 / self.problem.young_modulus;
        for load in &self.loads {
            out[load.unknown] -= scale * load.value * load.factor.at(t);
        }
        for support in &self.supports {
            let unknown = support.unknown;
            out[unknown] = if self.owned[unknown / 2] {
                u[unknown] - support.value * support.factor.at(t)
            } else {
                0.0
            };
        }
        Ok(())
    }

    /// Adds the internal forces of this rank's elements at unknowns `u` (local), divided by Young's
    /// modulus (mm), to the displacement rows of `out`.
    pub fn add_internal_forces(
        &self,
        history: &History,
        u: &[f64],
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        let scale = 1.0 / self.problem.young_modulus;
        let mut local = ElementForce::ZERO;
        for element in 0..self.elements.len() {
            self.element_force(history, element, u, false, &mut local)?;
            for (a, &n) in self.connectivity[element].iter().enumerate() {
                out[2 * n] += scale * local.force[2 * a];
                out[2 * n + 1] += scale * local.force[2 * a + 1];
            }
        }
        Ok(())
    }

    /// Adds the inertia forces of accelerations `a` divided by Young's modulus.
    pub(super) fn add_inertia(&self, a: &[f64], out: &mut [f64]) {
        let scale = self.problem.density / self.problem.young_modulus;
        if scale == 0.0 {
            return;
        }
        for (element, nodes) in self.connectivity.iter().enumerate() {
            let acceleration = self.element_values(element, a);
            for (row, &n) in self.kernels[element].mass().iter().zip(nodes) {
                let mut sum = [0.0; 2];
                for (m, a) in row.iter().zip(&acceleration) {
                    sum = [sum[0] + m * a[0], sum[1] + m * a[1]];
                }
                out[2 * n] += scale * sum[0];
                out[2 * n + 1] += scale * sum[1];
            }
        }
    }

    fn add_contact(&self, history: &History, t: f64, u: &[f64], out: &mut [f64]) {
        for point in 0..self.contacts.len() {
            self.add_contact_point(history, t, u, point, out);
        }
    }

    pub(super) fn add_contact_point(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        point: usize,
        out: &mut [f64],
    ) {
        let (contact, committed) = (&self.contacts[point], &history.friction[point]);
        let m = self.multiplier(point);
        let position = self.contact_position(contact, committed, t, u);
        let traction = contact.law.traction(&position, u[m], committed);
        let rows = contact.law.rows(&position, u[m], u[m + 1], &traction);
        for (i, force) in rows.force.iter().enumerate() {
            out[2 * contact.nodes[i / 2] + i % 2] += force;
        }
        out[m] = rows.closure;
        out[m + 1] = rows.complementarity;
    }

    /// Internal force of a local element, and its stiffness if it is wanted.
    pub(super) fn element_force(
        &self,
        history: &History,
        element: usize,
        u: &[f64],
        with_stiffness: bool,
        out: &mut ElementForce,
    ) -> Result<(), ElementFailure> {
        self.kernels[element]
            .internal_force(
                &self.element_values(element, u),
                &self.problem.material,
                history.element(element),
                with_stiffness,
                out,
            )
            .map_err(|cause| self.element_failure(element, u, cause))
    }

    /// Where a contact point is at time `t`, and how far from its tool.
    pub(super) fn contact_position(
        &self,
        contact: &LocalContact,
        committed: &FrictionState,
        t: f64,
        u: &[f64],
    ) -> PointPosition {
        contact.position(&self.edge_positions(contact, u), t, committed)
    }
}
