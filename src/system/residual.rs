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
use super::tangent::{CONTACT_ENTRIES, ELEMENT_ENTRIES, JacobianEntries, put_contact, put_element};
use crate::contact::{FrictionState, PointPosition, Traction};
use crate::element::ElementForce;

impl Subdomain {
    /// This rank's contributions to the residual at time `t` (ms), unknowns `u` and their second time derivatives `a`
    /// (all local; mm, mm/ms²), and where it is wanted all of the Jacobian there but its inertia.
    pub fn residual(
        &self,
        history: &History,
        t: f64,
        (u, a): (&[f64], &[f64]),
        mut stiffness: Option<&mut JacobianEntries>,
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        out.fill(0.0);
        let (elements, contacts) = stiffness.as_deref_mut().map(JacobianEntries::begin).unzip();
        self.add_internal_forces(history, u, elements, out)?;
        self.add_inertia(a, out);
        self.add_contact(history, t, u, contacts, out);
        if let Some(entries) = stiffness {
            entries.keep(t, u);
        }
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
    /// modulus (mm), to the displacement rows of `out`, and puts their stiffness where it is wanted.
    pub fn add_internal_forces(
        &self,
        history: &History,
        u: &[f64],
        mut stiffness: Option<&mut [f64]>,
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        let scale = 1.0 / self.problem.young_modulus;
        let mut local = ElementForce::ZERO;
        for element in 0..self.elements.len() {
            self.element_force(history, element, u, stiffness.is_some(), &mut local)?;
            for (a, &n) in self.connectivity[element].iter().enumerate() {
                out[2 * n] += scale * local.force[2 * a];
                out[2 * n + 1] += scale * local.force[2 * a + 1];
            }
            if let Some(entries) = &mut stiffness {
                put_element(&local, scale, &mut entries[ELEMENT_ENTRIES * element..]);
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

    /// Adds the forces of contact points, sets their own rows, and puts the slopes of both where they are wanted.
    fn add_contact(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        mut slopes: Option<&mut [f64]>,
        out: &mut [f64],
    ) {
        for (point, contact) in self.contacts.iter().enumerate() {
            let (position, traction) = self.contact_answer(history, t, u, point);
            let m = self.multiplier(point);
            let rows = contact.law.rows(&position, u[m], u[m + 1], &traction);
            for (i, force) in rows.force.iter().enumerate() {
                out[2 * contact.nodes[i / 2] + i % 2] += force;
            }
            out[m] = rows.closure;
            out[m + 1] = rows.complementarity;
            if let Some(entries) = &mut slopes {
                let tangent = contact.law.tangent(&position, u[m], &traction);
                put_contact(&tangent, &mut entries[CONTACT_ENTRIES * point..]);
            }
        }
    }

    /// Where a contact point is at time `t` and unknowns `u`, and its friction.
    pub(super) fn contact_answer(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        point: usize,
    ) -> (PointPosition, Traction) {
        let (contact, committed) = (&self.contacts[point], &history.friction[point]);
        let position = self.contact_position(contact, committed, t, u);
        let multiplier = u[self.multiplier(point)];
        let traction = contact.law.traction(&position, multiplier, committed);
        (position, traction)
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
