//! Adds up what a run spends and gains, and turns measures of a state into the row of a step.

use crate::output::StepRecord;
use crate::system::Measures;

/// Below this force (N) imbalance is measured against it instead of the force itself: at the first
/// touch any residual would be large against nothing.
pub(super) const LEAST_FORCE: f64 = 1.0;

/// How an accepted step came about.
#[derive(Clone, Copy, Debug)]
pub struct StepEffort {
    /// Time at its end, ms.
    pub t: f64,
    /// Its length, ms.
    pub dt: f64,
    /// Depth of the punch at its end, mm.
    pub depth: f64,
    /// Newton iterations of the accepted attempt.
    pub newton_iterations: u32,
    /// Residual norm at its end, mm.
    pub residual_norm: f64,
    /// Attempts refused before.
    pub refused_solves: u32,
}

/// Sums over the run.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    depth: f64,
    force: f64,
    external_work: f64,
}

impl Ledger {
    /// Punch force of the last row, N.
    pub fn force(&self) -> f64 {
        self.force
    }

    /// What the ledger remembers: depth (mm), force (N) and work of the punch (mJ).
    pub(super) fn memory(&self) -> [f64; 3] {
        let Self {
            depth,
            force,
            external_work,
        } = *self;
        [depth, force, external_work]
    }

    /// Goes on with the memory of another ledger.
    pub(super) fn recall(&mut self, [depth, force, external_work]: [f64; 3]) {
        *self = Self {
            depth,
            force,
            external_work,
        };
    }

    /// The row of an accepted step. The punch's work is the trapezoidal sum of its force over its
    /// way: second order in the step.
    pub fn record(&mut self, effort: &StepEffort, measures: &Measures) -> StepRecord {
        let force = measures.punch_force;
        self.external_work += 0.5 * (self.force + force) * (effort.depth - self.depth);
        (self.force, self.depth) = (force, effort.depth);
        let held = measures.strain_energy
            + measures.plastic_dissipation
            + measures.contact_energy
            + measures.kinetic_energy;
        let imbalance = force - measures.die_force - measures.inertia;
        let largest_force = force.abs().max(measures.die_force.abs()).max(LEAST_FORCE);
        StepRecord {
            t_ms: effort.t,
            stroke_mm: effort.depth,
            force_N: force,
            dy_A_punch_mm: -effort.depth,
            dy_A_sheet_mm: measures.point_a_displacement,
            gap_A_mm: measures.point_a_gap,
            angle_deg: measures.angle,
            dt_ms: effort.dt,
            newton_iterations: effort.newton_iterations,
            active_points: measures.active_points as u32,
            max_penetration_mm: measures.max_penetration,
            min_contact_force_N: measures.min_contact_force,
            kinetic_energy_mJ: measures.kinetic_energy,
            strain_energy_mJ: measures.strain_energy,
            plastic_dissipation_mJ: measures.plastic_dissipation,
            contact_energy_mJ: measures.contact_energy,
            external_work_mJ: self.external_work,
            energy_error: (self.external_work - held) / self.external_work.abs().max(held),
            die_force_N: measures.die_force,
            inertia_N: measures.inertia,
            balance_error: imbalance / largest_force,
            cone_violation: measures.cone_violation,
            angle_fit_residual_mm: measures.angle_fit_residual,
            residual_norm_mm: effort.residual_norm,
            refused_solves: effort.refused_solves,
            max_complementarity_mJ: measures.max_complementarity,
        }
    }
}
