//! Residual and Jacobian of one rank's share.
//!
//! Forces are divided by Young's modulus, so that every row is in millimetres:
//!
//! ```text
//! F_u = (R_int(u) + M a) / E - Σ λ ∇φ N        and the two rows of each contact point
//! ```

use super::LocalSystem;
use super::local::LocalContact;
use super::pattern::{CONTACT_ENTRIES, CONTACT_LAYOUT as AT, ELEMENT_ENTRIES};
use crate::contact::{FrictionState, PointPosition};
use crate::element::{ElementForce, GaussPointFailure};

/// An element that cannot be evaluated.
#[derive(Clone, Debug, thiserror::Error)]
#[error("element {element} at ({:.3}, {:.3}) mm, {cause}", position[0], position[1])]
pub struct ElementFailure {
    /// Mesh number of the element.
    pub element: usize,
    /// Its current position, mm.
    pub position: [f64; 2],
    /// What is wrong.
    pub cause: GaussPointFailure,
}

impl LocalSystem {
    /// Adds this rank's share of the residual at time `t` (ms), unknowns `u` and their second time
    /// derivatives `a` (all local; mm, mm/ms²) to `out`, which is set to zero first.
    pub fn residual(
        &self,
        t: f64,
        u: &[f64],
        a: &[f64],
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        out.fill(0.0);
        self.add_internal_forces(u, out)?;
        self.add_inertia(a, out);
        self.add_contact(t, u, out);
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
    pub fn add_internal_forces(&self, u: &[f64], out: &mut [f64]) -> Result<(), ElementFailure> {
        let scale = 1.0 / self.problem.young_modulus;
        let mut local = ElementForce::ZERO;
        for element in 0..self.elements.len() {
            self.element_force(element, u, false, &mut local)?;
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
                for k in 0..2 {
                    let sum: f64 = row.iter().zip(&acceleration).map(|(m, a)| m * a[k]).sum();
                    out[2 * n + k] += scale * sum;
                }
            }
        }
    }

    fn add_contact(&self, t: f64, u: &[f64], out: &mut [f64]) {
        for (point, contact) in self.contacts.iter().enumerate() {
            let m = self.multiplier(point);
            let position = self.contact_position(contact, t, u);
            let traction = contact.law.traction(&position, u[m], &contact.state);
            let rows = contact.law.rows(&position, u[m], u[m + 1], &traction);
            for (i, force) in rows.force.iter().enumerate() {
                out[2 * contact.nodes[i / 2] + i % 2] += force;
            }
            out[m] = rows.closure;
            out[m + 1] = rows.complementarity;
        }
    }

    /// Values of the Jacobian's entries (see [`Self::jacobian_pattern`]) at time `t` and unknowns
    /// `u`, with `shift` the derivative of the acceleration by the unknown (1/ms²).
    pub fn jacobian(
        &self,
        t: f64,
        u: &[f64],
        shift: f64,
        values: &mut [f64],
    ) -> Result<(), ElementFailure> {
        let scale = 1.0 / self.problem.young_modulus;
        let inertia = scale * shift * self.problem.density;
        let (element_values, rest) = values.split_at_mut(ELEMENT_ENTRIES * self.elements.len());
        let (contact_values, supports) = rest.split_at_mut(CONTACT_ENTRIES * self.contacts.len());
        let mut local = ElementForce::ZERO;
        for (element, out) in element_values.chunks_exact_mut(ELEMENT_ENTRIES).enumerate() {
            self.element_force(element, u, true, &mut local)?;
            let mass = self.kernels[element].mass();
            for (i, row) in local.stiffness.iter().enumerate() {
                let out = &mut out[16 * i..16 * (i + 1)];
                for (value, stiffness) in out.iter_mut().zip(row) {
                    *value = scale * stiffness;
                }
                for (b, m) in mass[i / 2].iter().enumerate() {
                    out[2 * b + i % 2] += inertia * m;
                }
            }
        }
        for (point, out) in contact_values.chunks_exact_mut(CONTACT_ENTRIES).enumerate() {
            self.contact_jacobian(t, u, point, out);
        }
        supports.fill(1.0);
        Ok(())
    }

    fn contact_jacobian(&self, t: f64, u: &[f64], point: usize, out: &mut [f64]) {
        let contact = &self.contacts[point];
        let multiplier = u[self.multiplier(point)];
        let position = self.contact_position(contact, t, u);
        let traction = contact.law.traction(&position, multiplier, &contact.state);
        let tangent = contact.law.tangent(&position, multiplier, &traction);
        out[AT.force_u].copy_from_slice(tangent.force_u.as_flattened());
        out[AT.force_multiplier].copy_from_slice(&tangent.force_multiplier);
        out[AT.closure_u].copy_from_slice(&tangent.closure_u);
        out[AT.closure_multiplier] = tangent.compliance;
        out[AT.closure_gap] = tangent.closure_gap;
        out[AT.complementarity_u].copy_from_slice(&tangent.complementarity_u);
        out[AT.complementarity_multiplier] = tangent.complementarity_multiplier;
        out[AT.complementarity_gap] = tangent.complementarity_gap;
    }

    fn element_force(
        &self,
        element: usize,
        u: &[f64],
        with_stiffness: bool,
        out: &mut ElementForce,
    ) -> Result<(), ElementFailure> {
        self.kernels[element]
            .internal_force(
                &self.element_values(element, u),
                &self.problem.material,
                self.element_states(element),
                with_stiffness,
                out,
            )
            .map_err(|cause| self.element_failure(element, u, cause))
    }

    pub(super) fn element_failure(
        &self,
        element: usize,
        u: &[f64],
        cause: GaussPointFailure,
    ) -> ElementFailure {
        let corner = self.connectivity[element][0];
        let [x, y] = self.coordinates[corner];
        ElementFailure {
            element: self.elements[element],
            position: [x + u[2 * corner], y + u[2 * corner + 1]],
            cause,
        }
    }

    /// Where a contact point is at time `t`, and how far from its tool.
    pub(super) fn contact_position(
        &self,
        contact: &LocalContact,
        t: f64,
        u: &[f64],
    ) -> PointPosition {
        contact.position(&self.edge_positions(contact, u), t)
    }

    /// Takes the states at time `t` and unknowns `u` as history. Call it once per accepted step.
    pub fn commit(&mut self, t: f64, u: &[f64]) -> Result<(), ElementFailure> {
        let count = self.problem.quadrature.point_count();
        for element in 0..self.elements.len() {
            let values = self.element_values(element, u);
            for point in 0..count {
                let index = count * element + point;
                let (response, ..) = self.kernels[element]
                    .point_response(point, &values, &self.problem.material, &self.states[index])
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                self.states[index] = response.state();
            }
        }
        self.commit_friction(t, u);
        Ok(())
    }

    fn commit_friction(&mut self, t: f64, u: &[f64]) {
        for point in 0..self.contacts.len() {
            let multiplier = u[self.multiplier(point)];
            let contact = &self.contacts[point];
            let nodes = self.edge_positions(contact, u);
            let position = contact.position(&nodes, t);
            let traction = contact
                .law
                .traction(&position, multiplier, &contact.state)
                .value;
            let mean_force = 0.5 * self.problem.young_modulus * (contact.state.traction + traction);
            self.friction_work -= mean_force * position.slip;
            let shift = contact.tool.motion.shift(t);
            self.contacts[point].state = FrictionState {
                traction,
                arc_length: position.distance.arc_length,
                nodes: nodes.map(|x| [x[0] - shift[0], x[1] - shift[1]]),
            };
        }
    }
}
