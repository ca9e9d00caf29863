//! Derivatives of what a subdomain computes by a parameter of the problem, along with what moves with the parameter.
//!
//! Two problems beside the one that is solved, with the parameter a little above and below its value, are evaluated at
//! the same unknowns from histories and accelerations moved along their own derivatives: the difference by the width is
//! the derivative. All of it is explicit, so no tolerance of a solver enters; what is left is rounding divided by the
//! share of the parameter by which the problems differ, and the square of that share.

use mpi::traits::Communicator;
use petsc::{Vector, VectorRef};

use super::System;
use super::error::ElementFailure;
use super::history::History;
use super::measures::upward;
use super::problem::Problem;
use super::shape_slope::ShapeSlopes;
use super::subdomain::Subdomain;
use crate::element::ElementForce;
use crate::mesh::SurfaceSide;

/// Multipliers up to this size are rounding (mm), and gaps up to this size are closed (mm; PETSc's limit).
const NO_FORCE: f64 = 1e-13;
const CLOSED: f64 = 1e-8;

/// The problems beside one of a system.
pub struct Variation {
    /// Above and below.
    sides: [Subdomain; 2],
    /// Half the distance between them, in the unit of the parameter.
    half_width: f64,
}

/// An accepted step as this rank sees it.
pub struct LocalStep<'a> {
    /// What it started from.
    pub before: &'a History,
    /// What it left.
    pub after: &'a History,
    /// Which Gauss points have yielded on it.
    pub flowing: &'a [bool],
    /// Time at its end, ms.
    pub t: f64,
    /// Unknowns at its end, mm.
    pub u: &'a [f64],
    /// Accelerations in its equations, mm/ms².
    pub a: &'a [f64],
}

/// What moves with a parameter.
pub struct Directions<'a> {
    /// Derivative of the history a step starts from.
    pub history: &'a History,
    /// A guess at that of the unknowns at its end (local); gaps stay.
    pub u: &'a [f64],
    /// That of the accelerations in its equations which goes with the guess (local).
    pub a: &'a [f64],
}

/// Room for both sides, the same for all parameters.
pub struct Workspace {
    histories: [History; 2],
    u: Vec<f64>,
    a: Vec<f64>,
    residuals: [Vec<f64>; 2],
}

impl System {
    /// For problems above and below this one, on the same mesh but for its coordinates.
    pub fn variation(&self, [above, below]: [Problem; 2], half_width: f64) -> Variation {
        let rank = self.comm().rank() as usize;
        let side = |problem| Subdomain::new(problem, self.partition(), self.numbering(), rank);
        Variation {
            sides: [side(above), side(below)],
            half_width,
        }
    }

    /// The sum of all ranks' shares of a residual. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn sum_of_shares(&self, shares: &[f64], out: &mut VectorRef) -> petsc::Result<()> {
        out.set_all(0.0)?;
        self.ghosts.reverse_add(shares, out)
    }

    /// The vector with these local values, of which each rank has its own. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn own_values(&self, local: &[f64]) -> petsc::Result<Vector> {
        let mut all = self.vector()?;
        let first = all.ownership_range()?.start;
        let mut write = all.write()?;
        for (value, row) in local.iter().zip(self.local().rows()) {
            let own = usize::try_from(row - first).ok();
            if let Some(entry) = own.and_then(|own| write.get_mut(own)) {
                *entry = *value;
            }
        }
        drop(write);
        Ok(all)
    }

    /// Global rows of this rank's gaps that are closed by a contact force at the converged unknowns `u` (local), ascending.
    pub fn closed_gaps(&self, u: &[f64]) -> Vec<i32> {
        let local = self.local();
        let points = 0..local.contacts.len();
        points
            .filter(|&point| local.carries(u, point))
            .map(|point| local.rows[local.multiplier(point) + 1])
            .collect()
    }
}

impl Subdomain {
    /// Leaves of a guess at the derivatives of the unknowns (local) what can be: gaps stay, and so does what an open point
    /// does not carry at the converged unknowns `u`.
    pub fn limit_guess(&self, u: &[f64], guess: &mut [f64]) {
        for point in 0..self.contacts.len() {
            let m = self.multiplier(point);
            guess[m + 1] = 0.0;
            if !self.carries(u, point) {
                guess[m] = 0.0;
            }
        }
    }

    /// Whether a contact point carries a force at converged unknowns.
    fn carries(&self, u: &[f64], point: usize) -> bool {
        let m = self.multiplier(point);
        u[m] > NO_FORCE && u[m + 1] <= CLOSED
    }
}

impl Workspace {
    /// For the variations of this subdomain.
    pub fn new(of: &Subdomain) -> Self {
        let room = || vec![0.0; of.unknown_count()];
        Self {
            histories: [0, 1].map(|_| History::virgin(of)),
            u: room(),
            a: room(),
            residuals: [0, 1].map(|_| room()),
        }
    }
}

impl Variation {
    /// The derivative of the history of a sheet that has not moved.
    pub fn virgin_slope(&self) -> History {
        let [above, below] = self.sides.each_ref().map(History::virgin);
        let mut slope = above.clone();
        slope.slope_between(&above, &below, 2.0 * self.half_width);
        slope
    }

    /// The derivative of this rank's share of the residual along `along`. Open contact points, which take no part in
    /// equilibrium, are left out.
    ///
    /// # Errors
    /// If an element cannot be evaluated beside the solution.
    pub fn residual_slope(
        &self,
        step: &LocalStep<'_>,
        along: &Directions<'_>,
        work: &mut Workspace,
        out: &mut [f64],
    ) -> Result<(), ElementFailure> {
        for (side, by) in [self.half_width, -self.half_width].into_iter().enumerate() {
            work.histories[side].move_from(step.before, by, along.history);
            move_from(&mut work.u, step.u, by, along.u);
            move_from(&mut work.a, step.a, by, along.a);
            self.residual(side, step, work)?;
        }
        let [above, below] = &work.residuals;
        for ((out, above), below) in out.iter_mut().zip(above).zip(below) {
            *out = (above - below) / (2.0 * self.half_width);
        }
        Ok(())
    }

    /// The residual of one side.
    fn residual(
        &self,
        side: usize,
        step: &LocalStep<'_>,
        work: &mut Workspace,
    ) -> Result<(), ElementFailure> {
        let (of, history) = (&self.sides[side], &work.histories[side]);
        let out = &mut work.residuals[side];
        out.fill(0.0);
        let scale = 1.0 / of.problem.young_modulus;
        let mut local = ElementForce::ZERO;
        for element in 0..of.elements.len() {
            of.element_force(history, element, &work.u, false, &mut local)?;
            for (i, force) in local.force.iter().enumerate() {
                out[2 * of.connectivity[element][i / 2] + i % 2] += scale * force;
            }
        }
        of.add_inertia(&work.a, out);
        for point in (0..of.contacts.len()).filter(|&point| of.carries(step.u, point)) {
            of.add_contact_point(history, step.t, &work.u, point, out);
        }
        for support in &of.supports {
            out[support.unknown] = 0.0;
        }
        Ok(())
    }

    /// After [`Variation::residual_slope`] of the same step, with the derivatives `du` of its unknowns (local): puts the
    /// derivative of the history at its end into `history`. Returns that of the punch force (N per mm of width, half
    /// model, this rank's share) and the number of Gauss points that yield on one side only.
    ///
    /// # Errors
    /// As [`Variation::residual_slope`].
    pub fn advance(
        &self,
        step: &LocalStep<'_>,
        du: &[f64],
        work: &mut Workspace,
        history: &mut History,
    ) -> Result<(f64, usize), ElementFailure> {
        let mut forces = [0.0; 2];
        for (side, by) in [self.half_width, -self.half_width].into_iter().enumerate() {
            let (of, u) = (&self.sides[side], &mut work.u);
            move_from(u, step.u, by, du);
            work.histories[side].advance_flowing(of, step.t, u, step.flowing)?;
            forces[side] = of.punch_force(&work.histories[side], step.t, u, step.u);
        }
        let (sides, by) = (&mut work.histories, self.half_width);
        let doubtful = History::mend_one_sided(sides, step.before, by, history, step.after);
        let [above, below] = sides;
        history.slope_between(above, below, 2.0 * self.half_width);
        Ok(((forces[0] - forces[1]) / (2.0 * self.half_width), doubtful))
    }

    /// Derivatives of what is read off the sheet's shape at displacements `u` with derivatives `du` (local).
    pub fn shape_slopes(&self, u: &[f64], du: &[f64]) -> ShapeSlopes {
        let [above, below] = &self.sides;
        let by_coordinate = |n: usize| {
            let (above, below) = (above.coordinates[n], below.coordinates[n]);
            [0, 1].map(|k| (above[k] - below[k]) / (2.0 * self.half_width))
        };
        above.shape_slopes(u, du, by_coordinate)
    }
}

impl Variation {
    /// The same of a sheet that has been released ([`super::Released`]), whose loads are gone.
    pub fn released(&self, system: &System) -> Self {
        let problems = self.sides.each_ref().map(|side| Problem {
            loads: Vec::new(),
            lower_tool: None,
            upper_tool: None,
            density: 0.0,
            supports: system.problem().supports.clone(),
            ..side.problem.clone()
        });
        system.variation(problems, self.half_width)
    }
}

impl Subdomain {
    /// Force of this rank's contact points that pushes the punch down, N per mm of width of the half model, at unknowns
    /// `u` whose history this is; of the points that carry at `base`.
    fn punch_force(&self, history: &History, t: f64, u: &[f64], base: &[f64]) -> f64 {
        let young = self.problem.young_modulus;
        let on_top = |&point: &usize| {
            self.contacts[point].side == SurfaceSide::Top && self.carries(base, point)
        };
        let force = |point: usize| {
            let (contact, committed) = (&self.contacts[point], &history.friction[point]);
            let distance = self.contact_position(contact, committed, t, u).distance;
            let multiplier = u[self.multiplier(point)];
            -upward(young * multiplier, young * committed.traction, &distance)
        };
        (0..self.contacts.len()).filter(on_top).map(force).sum()
    }
}

fn move_from(out: &mut [f64], base: &[f64], by: f64, slope: &[f64]) {
    for ((out, base), slope) in out.iter_mut().zip(base).zip(slope) {
        *out = base + by * slope;
    }
}
