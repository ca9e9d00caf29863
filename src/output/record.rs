//! One accepted step in numbers: the row of `history.csv`.

// The field names are the column names, units in their usual spelling: they exist here and nowhere else.
#![allow(non_snake_case)]

use serde::{Deserialize, Serialize};

/// What one accepted step gives. Forces are those of the whole sheet (both halves, full width) in N; energies are
/// those of the whole sheet in mJ = N mm; stroke counts positive downwards, displacements `dy` positive upwards.
/// A value that was not computed is NaN.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct StepRecord {
    /// Time at the end of the step, ms.
    pub t_ms: f64,
    /// Imposed punch travel, mm, positive downwards.
    pub stroke_mm: f64,
    /// Force on the punch, N, positive when the sheet pushes it up.
    pub force_N: f64,
    /// "A, punch side": vertical displacement of the punch tip above A, mm.
    pub dy_A_punch_mm: f64,
    /// "A, sheet side": vertical displacement of the sheet's node A, mm.
    pub dy_A_sheet_mm: f64,
    /// Distance between punch and sheet at A, mm, positive when open.
    pub gap_A_mm: f64,
    /// Opening between the two straight arms, degrees.
    pub angle_deg: f64,
    /// Length of the step, ms.
    pub dt_ms: f64,
    /// Newton iterations of the step, refused attempts not counted.
    pub newton_iterations: u32,
    /// Contact points that carry pressure.
    pub active_points: u32,
    /// Largest penetration over all contact points, mm, 0 if none penetrates.
    pub max_penetration_mm: f64,
    /// Smallest contact force over all contact points, N; negative would mean that a contact pulls.
    pub min_contact_force_N: f64,
    /// Kinetic energy, mJ.
    pub kinetic_energy_mJ: f64,
    /// Elastic strain energy, mJ.
    pub strain_energy_mJ: f64,
    /// Plastic work dissipated so far, mJ.
    pub plastic_dissipation_mJ: f64,
    /// Work done so far against contact (friction and the contact law itself), mJ.
    pub contact_energy_mJ: f64,
    /// Work done so far by the punch, mJ.
    pub external_work_mJ: f64,
    /// Energy balance error divided by the largest energy so far.
    pub energy_error: f64,
    /// Vertical force on the die, N, positive when the sheet pushes it down.
    pub die_force_N: f64,
    /// Vertical inertia force of the sheet, N.
    pub inertia_N: f64,
    /// Punch force minus die force minus inertia, divided by the larger force.
    pub balance_error: f64,
    /// Largest excess of friction over the coefficient times the contact force of a point, as a share of the
    /// coefficient times the largest contact force; 0 without friction.
    pub cone_violation: f64,
    /// Root mean square distance of the outer arm from the straight fit that gives the angle, mm.
    pub angle_fit_residual_mm: f64,
    /// Norm of the residual where Newton stopped, as a displacement correction, mm.
    pub residual_norm_mm: f64,
    /// Attempts of this step that were refused and redone with a shorter one.
    pub refused_solves: u32,
    /// Largest product of contact force and open gap of a contact point, mJ: nothing may push across a gap.
    pub max_complementarity_mJ: f64,
}
