//! The case: the model a person describes, as plain numbers. Units are mm, N, MPa, g and ms.

use super::inverse::Sought;
use super::tool_file::ToolFile;
use crate::contact::ContactLocation;
use crate::element::Quadrature;
use crate::material::Hardening;
use crate::material::hardening::Declaration;
use crate::tool::PunchMotion;

/// Everything a run needs to know. Made by [`Case::read`], which refuses what cannot work.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The sheet.
    pub sheet: Sheet,
    /// The rigid tools.
    pub tools: Tools,
    /// What the punch does, and whether inertia counts.
    pub loading: Loading,
    /// What the sheet is made of.
    pub material: Material,
    /// Friction between sheet and tools.
    pub friction: Friction,
    /// Mesh, quadrature and contact points.
    pub discretisation: Discretisation,
    /// Time steps and Newton's method.
    pub stepping: Stepping,
    /// What is written where.
    pub output: Output,
    /// When to stop, and from where to go on.
    pub resuming: Resuming,
    /// What is looked for by several runs.
    pub inverse: Inverse,
}

impl Case {
    /// Length of an element along the sheet, mm.
    pub fn element_length(&self) -> f64 {
        self.sheet.half_length() / self.discretisation.nx as f64
    }

    /// Distance between neighbouring contact points, mm; with moving points, the length of the edge each has for itself.
    pub fn contact_spacing(&self) -> f64 {
        let edge = self.element_length();
        match self.discretisation.contact_location {
            ContactLocation::Points => edge / self.discretisation.contact_points_per_edge as f64,
            ContactLocation::Nodes => edge / 2.0,
            ContactLocation::Closest => edge,
        }
    }
}

/// The sheet: x in [0, length / 2], y in [0, thickness]; x = 0 is the plane of symmetry.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Length of the whole sheet, mm.
    pub length: f64,
    /// Thickness, mm.
    pub thickness: f64,
    /// Width of the sheet, mm.
    pub width: f64,
}

impl Sheet {
    /// Length of the half that is modelled, mm.
    pub fn half_length(&self) -> f64 {
        0.5 * self.length
    }

    /// Force of the whole sheet (N) per force of the half model for one mm of width (N/mm); mm.
    pub fn force_factor(&self) -> f64 {
        2.0 * self.width
    }
}

/// The rigid tools. Unless they are from files, the die's flat is y = 0 for x >= `die_edge`, the shoulder's centre is
/// (`die_edge`, -shoulder radius), the cavity's centre (0, -shoulder radius); the punch's lowest point is first at
/// (0, thickness).
#[derive(Debug, Clone, PartialEq)]
pub struct Tools {
    /// Radius of the punch, mm.
    pub punch_radius: f64,
    /// Radius of the cavity, mm.
    pub die_radius: f64,
    /// Radius of the shoulder, mm.
    pub die_shoulder_radius: f64,
    /// The punch from a file, in place of the benchmark's.
    pub punch_file: Option<ToolFile>,
    /// The die from a file, in place of the benchmark's.
    pub die_file: Option<ToolFile>,
}

impl Tools {
    /// Where the flat of the die begins, mm; also how far the bottom of the cavity lies below the flat.
    pub fn die_edge(&self) -> f64 {
        self.die_radius + self.die_shoulder_radius
    }
}

/// Whether the inertia of the sheet counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dynamics {
    /// Slow dynamics: the mass stabilises what would snap.
    Slow,
    /// Static.
    None,
}

/// What the punch does: down by the stroke in `time_load`, then back by a share of it in `time_unload`.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// Travel down, mm.
    pub stroke: f64,
    /// Share of the stroke by which the punch goes back, 0 to 1.
    pub unload_fraction: f64,
    /// Time for it, ms.
    pub time_load: f64,
    /// Time for the travel back, ms.
    pub time_unload: f64,
    /// Whether inertia counts.
    pub dynamics: Dynamics,
}

impl Loading {
    /// The punch's travel in time.
    pub fn motion(&self) -> PunchMotion {
        PunchMotion {
            stroke: self.stroke,
            unload_fraction: self.unload_fraction,
            time_load: self.time_load,
            time_unload: self.time_unload,
        }
    }
}

/// Elasticity, density and hardening of the sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Young's modulus, MPa.
    pub young_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// Density, g/mm3.
    pub density: f64,
    /// Which hardening law.
    pub hardening_law: &'static Declaration,
    /// Values of its constants, in the order of its declaration.
    pub hardening_constants: Vec<f64>,
    /// Path of the hardening table, or the word `benchmark` for the one in the program, also for another law.
    pub hardening_file: String,
    /// The law with these constants: flow stress (MPa) against equivalent plastic strain.
    pub hardening: Hardening,
}

/// Mesh, quadrature and contact points.
#[derive(Debug, Clone, PartialEq)]
pub struct Discretisation {
    /// Elements along half the sheet.
    pub nx: usize,
    /// Elements through the thickness.
    pub ny: usize,
    /// Gauss points along the sheet in an element.
    pub points_along: usize,
    /// Gauss points through the thickness in an element; none: as many as along the sheet.
    pub points_through: Option<usize>,
    /// Where contact is looked for.
    pub contact_location: ContactLocation,
    /// Contact points on each element edge of the sheet's surfaces.
    pub contact_points_per_edge: usize,
    /// Compliance of the tools' surface: how far it yields per contact pressure, mm/MPa.
    pub contact_compliance: f64,
    /// Deepest penetration with which a run counts as good, mm.
    pub penetration_limit: f64,
}

impl Discretisation {
    /// Number of elements of the sheet.
    pub fn elements(&self) -> usize {
        self.nx * self.ny
    }

    /// Gauss rule of the elements.
    pub fn quadrature(&self) -> Quadrature {
        let through = self.points_through.unwrap_or(self.points_along);
        Quadrature::of(self.points_along, through)
    }
}

/// Friction between sheet and tools.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// Coulomb's coefficient; 0 without friction.
    pub coefficient: f64,
    /// Elastic slip per friction traction, mm/MPa.
    pub compliance: f64,
}

/// Time steps and Newton's method.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepping {
    /// First time step, ms.
    pub dt_initial: f64,
    /// Least time step, ms.
    pub dt_min: f64,
    /// Greatest time step, ms.
    pub dt_max: f64,
    /// Number of equal steps down; 0: as the solution allows.
    pub fixed_steps_load: usize,
    /// Number of equal steps back; 0: as the solution allows.
    pub fixed_steps_unload: usize,
    /// Travels of the punch, going down, at which a step ends exactly, mm.
    pub report_strokes: Vec<f64>,
    /// Travels of the punch, going back, at which a step ends exactly, mm.
    pub report_returns: Vec<f64>,
    /// Whether a solve starts from extrapolated displacements.
    pub extrapolate: bool,
    /// Absolute tolerance on the norm of the scaled residual, mm.
    pub newton_tolerance: f64,
    /// Most Newton iterations in one solve.
    pub newton_max_iterations: usize,
}

/// What is written where.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Directory of the results.
    pub dir: String,
    /// Accepted steps from one saving of the fields to the next; 0: at the ends of loading and unloading only.
    pub every: usize,
    /// Whether every Newton iteration is shown.
    pub iterations: bool,
    /// Whether the model is only shown.
    pub dry_run: bool,
    /// Whether only warnings, verdicts and last words are shown.
    pub quiet: bool,
    /// Whether nothing at all is shown: one of several runs of a search.
    pub silent: bool,
    /// Output folders of two runs that are laid side by side; nothing is run then.
    pub compare: Option<[String; 2]>,
    /// Options by whose values the run is differentiated.
    pub sensitivity: Vec<&'static str>,
}

/// Checkpoints, when to stop, and from where to go on.
#[derive(Debug, Clone, PartialEq)]
pub struct Resuming {
    /// Accepted steps between checkpoints; 0: steps are not counted.
    pub checkpoint_every: usize,
    /// Minutes on the clock between checkpoints; 0: the clock is not looked at.
    pub checkpoint_minutes: f64,
    /// Seconds on the clock before which the run is to end.
    pub wall_limit: Option<f64>,
    /// Whether to go on from a checkpoint.
    pub restart: Restart,
    /// Whether the checkpoint of an interrupted run may be lost.
    pub overwrite: bool,
}

/// From where a run goes on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Restart {
    /// From the undeformed sheet.
    No,
    /// From the newest checkpoint in the directory of the results.
    Newest,
    /// From the checkpoint with this path.
    From(String),
}

/// What is looked for by several runs, if anything.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// Path of the measured curve that is to be met.
    pub identify: Option<String>,
    /// Wanted angle between the arms of the released sheet, degrees.
    pub design: Option<f64>,
    /// What may be changed for it.
    pub parameters: Vec<Sought>,
    /// Most runs.
    pub most_runs: usize,
    /// How far the angle of a design may be from the wanted one, degrees.
    pub tolerance: f64,
    /// How much finer the mesh of the run is that confirms a design; 1: no such run.
    pub refinement: usize,
}
