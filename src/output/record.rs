//! One accepted step in numbers: the columns of `history.csv`, each declared once with its meaning and its value.
//!
//! To add a column: an entry here; if nothing measured has its value, a field in [`Measures`] with the line that computes
//! it; and `UPDATE_DOCS=1 cargo test --test output_history` for docs/history.md.

// The field names are the column names, units in their usual spelling: they exist here and nowhere else.
#![allow(non_snake_case)]

use serde::{Deserialize, Serialize};

use crate::system::{Measures, Work};

/// Below this force (N) imbalance is measured against it instead of the force itself: at the first
/// touch any residual would be large against nothing.
pub(crate) const LEAST_FORCE: f64 = 1.0;

/// Below this work (mJ) likewise.
const LEAST_WORK: f64 = 1.0;

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

/// Everything a column can be made of.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// How the step came about.
    pub effort: &'a StepEffort,
    /// The state at its end.
    pub measures: &'a Measures,
    /// Work of the punch since the start, mJ.
    pub external_work: f64,
    /// Where it went since the start, by the same rule, mJ.
    pub work: &'a Work,
}

impl Step<'_> {
    /// What is stored, dissipated and moving, mJ.
    fn held_energy(&self) -> f64 {
        let measures = self.measures;
        measures.strain_energy
            + measures.plastic_dissipation
            + measures.contact_energy()
            + measures.kinetic_energy
    }

    fn energy_error(&self) -> f64 {
        let (work, held) = (self.external_work, self.held_energy());
        (work - held) / work.abs().max(held)
    }

    /// Work of the punch less that of the forces in the sheet, on it and between it and the tools.
    fn work_error(&self) -> f64 {
        let (work, taken) = (self.external_work, self.work.total());
        (work - taken) / work.abs().max(taken.abs()).max(LEAST_WORK)
    }

    fn balance_error(&self) -> f64 {
        let (force, die_force) = (self.measures.punch_force, self.measures.die_force);
        let imbalance = force - die_force - self.measures.inertia;
        imbalance / force.abs().max(die_force.abs()).max(LEAST_FORCE)
    }
}

/// How bad a value of a certificate is: the larger, the worse.
pub(crate) type Badness = fn(f64) -> f64;

/// A column of the table.
pub struct Column {
    /// Its name, which ends with the unit if it has one.
    pub name: &'static str,
    /// What it is, in lines that belong together.
    pub meaning: &'static [&'static str],
    /// Its value in a row.
    pub(crate) value: fn(&StepRecord) -> f64,
    /// Of a certificate, how bad a value is.
    pub(crate) certificate: Option<Badness>,
}

macro_rules! columns {
    ($($(#[doc = $meaning:literal])+ $name:ident: $kind:ty = $value:expr $(, worst: $badness:expr)?;)*) => {
        /// One accepted step in numbers. Forces are those of the whole sheet (both halves, full width) in N; energies are
        /// those of the whole sheet in mJ = N mm; stroke counts positive downwards, displacements `dy` positive upwards.
        /// A value that was not computed is NaN.
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
        pub struct StepRecord {
            $($(#[doc = $meaning])+ pub $name: $kind,)*
        }

        impl StepRecord {
            /// The row of a step.
            pub fn of(step: &Step) -> Self {
                Self {
                    $($name: {
                        let value: fn(&Step) -> $kind = $value;
                        value(step)
                    },)*
                }
            }
        }

        /// All columns in their order.
        pub static COLUMNS: &[Column] = &[$(Column {
            name: stringify!($name),
            meaning: &[$($meaning),+],
            value: |record| f64::from(record.$name),
            certificate: columns!(@certificate $($badness)?),
        },)*];
    };
    (@certificate) => { None };
    (@certificate $badness:expr) => { Some($badness) };
}

columns! {
    /// Time at the end of the step, ms.
    t_ms: f64 = |step| step.effort.t;
    /// Travel of the punch downwards, as imposed, mm.
    stroke_mm: f64 = |step| step.effort.depth;
    /// Force on the punch, N, positive when the sheet pushes it up.
    force_N: f64 = |step| step.measures.punch_force;
    /// "A, punch side": vertical displacement of the punch tip above A, mm.
    dy_A_punch_mm: f64 = |step| -step.effort.depth;
    /// "A, sheet side": vertical displacement of the sheet's node A, mm.
    dy_A_sheet_mm: f64 = |step| step.measures.point_a_displacement;
    /// Distance between punch and sheet at A, mm, positive when open.
    gap_A_mm: f64 = |step| step.measures.point_a_gap;
    /// Opening between the two straight arms, degrees.
    angle_deg: f64 = |step| step.measures.angle;
    /// Length of the step, ms.
    dt_ms: f64 = |step| step.effort.dt;
    /// Newton iterations of the accepted solve; those of refused solves are not counted.
    newton_iterations: u32 = |step| step.effort.newton_iterations;
    /// Contact points that carry a force, in the half model.
    active_points: u32 = |step| step.measures.active_points as u32;
    /// Deepest penetration at the contact points and between them, mm; 0 if nothing penetrates.
    max_penetration_mm: f64 = |step| step.measures.max_penetration, worst: |value| value;
    /// Smallest contact force over all contact points, N; a negative one is tensile.
    min_contact_force_N: f64 = |step| step.measures.min_contact_force, worst: |value| -value;
    /// Kinetic energy, mJ.
    kinetic_energy_mJ: f64 = |step| step.measures.kinetic_energy;
    /// Elastic strain energy, mJ.
    strain_energy_mJ: f64 = |step| step.measures.strain_energy;
    /// Plastic work since the start, mJ.
    plastic_dissipation_mJ: f64 = |step| step.measures.plastic_dissipation;
    /// Energy stored in the compliance of the contact surface, and work of friction since the start, mJ.
    contact_energy_mJ: f64 = |step| step.measures.contact_energy();
    /// Work of the punch since the start, mJ: the trapezoidal sum of its force over its travel.
    external_work_mJ: f64 = |step| step.external_work;
    /// Work of the punch less the four energies, as a share of the larger of the two: an error of second order in the step.
    energy_error: f64 = |step| step.energy_error(), worst: f64::abs;
    /// Vertical force on the die, N, positive when the sheet pushes it down.
    die_force_N: f64 = |step| step.measures.die_force;
    /// Vertical inertia force of the sheet, N.
    inertia_N: f64 = |step| step.measures.inertia;
    /// Punch force less die force and inertia, as a share of the larger of the two forces (at least 1 N).
    balance_error: f64 = |step| step.balance_error(), worst: f64::abs;
    /// Largest excess of friction over the coefficient times the contact force of a point, as a share of the
    /// coefficient times the largest contact force; 0 without friction.
    cone_violation: f64 = |step| step.measures.cone_violation, worst: f64::abs;
    /// Root mean square distance of the outer arm from the straight fit that gives the angle, mm.
    angle_fit_residual_mm: f64 = |step| step.measures.angle_fit_residual;
    /// Norm of the scaled residual (forces divided by Young's modulus) where Newton stopped, mm.
    residual_norm_mm: f64 = |step| step.effort.residual_norm, worst: f64::abs;
    /// Solves of this step that were refused and repeated with a shorter one.
    refused_solves: u32 = |step| step.effort.refused_solves;
    /// Largest product of contact force and open gap of a contact point, mJ; it is 0 where complementarity holds.
    max_complementarity_mJ: f64 = |step| step.measures.max_complementarity, worst: f64::abs;
    /// Work of friction since the start, mJ.
    friction_work_mJ: f64 = |step| step.measures.friction_work;
    /// Energy stored in the compliance of the contact surface, mJ.
    compliance_energy_mJ: f64 = |step| step.measures.compliance_energy;
    /// Work of the internal forces since the start, mJ, summed as that of the punch.
    internal_work_mJ: f64 = |step| step.work.internal;
    /// Work of the contact and friction forces on what the sheet moves against the tools since the start, mJ, summed likewise.
    contact_work_mJ: f64 = |step| step.work.contact;
    /// Work of the inertia forces since the start, mJ, summed likewise.
    inertia_work_mJ: f64 = |step| step.work.inertia;
    /// Work of the inertia forces less the kinetic energy, mJ: what the time integration has dissipated.
    integrator_dissipation_mJ: f64 = |step| step.work.inertia - step.measures.kinetic_energy;
    /// Work of the punch less those of internal, contact and inertia forces, as a share of it (at least 1 mJ): what the solver left over.
    work_error: f64 = |step| step.work_error(), worst: f64::abs;
}

/// The page docs/history.md; a test keeps the file equal to it.
pub fn columns_markdown() -> String {
    let mut page = String::from(
        "# Columns of history.csv\n\n\
         <!-- Rendered from src/output/record.rs by `UPDATE_DOCS=1 cargo test --test output_history`; changes by hand are \
         lost. -->\n\n\
         One row per accepted step. Forces and energies are those of the whole sheet (both halves, full width). A\n\
         certificate's worst value over the run is in `summary.json` and in the report.\n\n\
         | column | certificate | meaning |\n|---|---|---|\n",
    );
    for column in COLUMNS {
        let meaning: String = column.meaning.concat();
        let certificate = if column.certificate.is_some() {
            "yes"
        } else {
            ""
        };
        page.push_str(&format!(
            "| `{}` | {certificate} | {} |\n",
            column.name,
            meaning.trim()
        ));
    }
    page
}
