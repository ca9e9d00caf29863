//! Work of one step, mechanism by mechanism: the mean of the forces at its two ends times the displacement between.
//!
//! At both ends the forces are in equilibrium, so the works are in balance with that of the tools whatever the step's
//! length is: what they differ by is what the solver left over. See docs/theory.md, section Energy.

use mpi::traits::Communicator;
use petsc::VectorRef;

use super::error::{ElementFailure, FailedElement};
use super::history::History;
use super::subdomain::{LocalContact, Subdomain};
use super::{System, SystemError};
use crate::contact::FrictionState;
use crate::element::ElementForce;
use crate::ranks;

/// An accepted state.
#[derive(Clone, Copy)]
pub struct AcceptedState<'a> {
    /// What the sheet remembers at it.
    pub history: &'a History,
    /// Time, ms.
    pub t: f64,
    /// Unknowns, mm.
    pub u: &'a VectorRef,
    /// Accelerations that its forces are in equilibrium with, mm/ms²; none in statics.
    pub acceleration: Option<&'a VectorRef>,
}

/// Work of a step on the whole sheet, mJ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Of the internal forces on the deformation of the sheet.
    pub internal: f64,
    /// Of the inertia forces.
    pub inertia: f64,
    /// Of the contact and friction forces on what the faces of the sheet move against the tools.
    pub contact: f64,
}

/// An accepted state as one rank sees it.
struct LocalState<'a> {
    history: &'a History,
    t: f64,
    u: Vec<f64>,
    a: Option<Vec<f64>>,
}

impl System {
    /// Work of the step from one accepted state to the next. Collective.
    ///
    /// # Errors
    /// If PETSc fails or an element cannot be evaluated, the same on every rank.
    pub fn work(
        &self,
        from: &AcceptedState<'_>,
        to: &AcceptedState<'_>,
    ) -> Result<Work, SystemError> {
        let (from, to) = (self.local_state(from)?, self.local_state(to)?);
        let mine = FailedElement::agree(&self.comm, self.local.work(&from, &to))?;
        Ok(mine.over_ranks(&self.comm, self.problem().whole_sheet))
    }

    fn local_state<'a>(&self, of: &AcceptedState<'a>) -> petsc::Result<LocalState<'a>> {
        Ok(LocalState {
            history: of.history,
            t: of.t,
            u: self.local_values(of.u)?,
            a: of.acceleration.map(|a| self.local_values(a)).transpose()?,
        })
    }
}

impl Subdomain {
    /// This rank's share, per millimetre of width.
    fn work(&self, from: &LocalState<'_>, to: &LocalState<'_>) -> Result<Work, ElementFailure> {
        Ok(Work {
            internal: self.internal_work(from, to)?,
            inertia: self.inertia_work(from, to),
            contact: self.contact_work(from, to),
        })
    }

    fn internal_work(
        &self,
        from: &LocalState<'_>,
        to: &LocalState<'_>,
    ) -> Result<f64, ElementFailure> {
        let mut work = 0.0;
        let mut local = ElementForce::ZERO;
        for element in 0..self.elements.len() {
            let before = self.element_values(element, &from.u);
            let after = self.element_values(element, &to.u);
            for state in [from, to] {
                self.element_force(state.history, element, &state.u, false, &mut local)?;
                for (i, force) in local.force.iter().enumerate() {
                    work += 0.5 * force * (after[i / 2][i % 2] - before[i / 2][i % 2]);
                }
            }
        }
        Ok(work)
    }

    fn inertia_work(&self, from: &LocalState<'_>, to: &LocalState<'_>) -> f64 {
        let mut work = 0.0;
        for (element, kernel) in self.kernels.iter().enumerate() {
            let before = self.element_values(element, &from.u);
            let after = self.element_values(element, &to.u);
            for acceleration in [&from.a, &to.a].into_iter().flatten() {
                let acceleration = self.element_values(element, acceleration);
                for (i, row) in kernel.mass().iter().enumerate() {
                    for k in 0..2 {
                        let force: f64 = row.iter().zip(&acceleration).map(|(m, a)| m * a[k]).sum();
                        work += 0.5 * self.problem.density * force * (after[i][k] - before[i][k]);
                    }
                }
            }
        }
        work
    }

    fn contact_work(&self, from: &LocalState<'_>, to: &LocalState<'_>) -> f64 {
        let mut work = 0.0;
        for (point, contact) in self.contacts.iter().enumerate() {
            let before = self.nodes_in_the_tools_frame(contact, from);
            let after = self.nodes_in_the_tools_frame(contact, to);
            for (state, nodes) in [(from, &before), (to, &after)] {
                let remembered = &state.history.friction[point];
                let multiplier = state.u[self.multiplier(point)];
                let forces = self.nodal_forces(contact, remembered, multiplier, nodes);
                for (i, force) in forces.iter().enumerate() {
                    work -= 0.5 * force * (after[i / 2][i % 2] - before[i / 2][i % 2]);
                }
            }
        }
        work
    }

    fn nodes_in_the_tools_frame(
        &self,
        contact: &LocalContact,
        state: &LocalState<'_>,
    ) -> [[f64; 2]; 3] {
        let shift = contact.tool.motion.shift(state.t);
        self.edge_positions(contact, &state.u)
            .map(|x| [x[0] - shift[0], x[1] - shift[1]])
    }

    /// Forces of a contact point on the nodes of its edge, N per mm of width.
    fn nodal_forces(
        &self,
        contact: &LocalContact,
        remembered: &FrictionState,
        multiplier: f64,
        nodes: &[[f64; 2]; 3],
    ) -> [f64; 6] {
        let position = contact
            .law
            .position(nodes, &contact.tool.profile, [0.0; 2], remembered);
        let (normal, along) = (position.distance.gradient, position.distance.arc_gradient);
        // The history is that of this state, so its friction is the present one.
        std::array::from_fn(|i| {
            let load = multiplier * normal[i % 2] + remembered.traction * along[i % 2];
            self.problem.young_modulus * position.shape[i / 2] * load
        })
    }
}

impl Work {
    fn over_ranks(self, comm: &impl Communicator, whole_sheet: f64) -> Self {
        let [internal, inertia, contact] =
            ranks::sums(comm, [self.internal, self.inertia, self.contact]);
        Self {
            internal: whole_sheet * internal,
            inertia: whole_sheet * inertia,
            contact: whole_sheet * contact,
        }
    }

    /// This work and that of another step.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            internal: self.internal + other.internal,
            inertia: self.inertia + other.inertia,
            contact: self.contact + other.contact,
        }
    }

    /// All of it.
    pub fn total(&self) -> f64 {
        self.internal + self.inertia + self.contact
    }
}
