//! What is solved: the sheet, its material, the tools and their motion.

use crate::case::{Case, Dynamics, Tools};
use crate::contact::{ContactSample, contact_rule};
use crate::element::Quadrature;
use crate::material::VonMises;
use crate::mesh::{SheetMesh, SurfaceSide};
use crate::tool::{Profile, PunchMotion, die, punch};

/// The whole problem, the same on every rank.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Mesh of the half sheet.
    pub mesh: SheetMesh,
    /// Material of the sheet.
    pub material: VonMises,
    /// Young's modulus, MPa; forces are divided by it in the equations.
    pub young_modulus: f64,
    /// Density, g/mm³; zero solves without inertia.
    pub density: f64,
    /// Gauss rule of the elements.
    pub quadrature: Quadrature,
    /// Contact points of the reference edge.
    pub contact_samples: Vec<ContactSample>,
    /// Give of the surface under unit pressure, mm/MPa.
    pub contact_compliance: f64,
    /// The fixed die.
    pub die: Profile,
    /// The punch at the start of its motion.
    pub punch: Profile,
    /// Motion of the punch.
    pub motion: PunchMotion,
    /// Half model force per millimetre of width to force of the whole sheet, mm.
    pub whole_sheet: f64,
}

impl Problem {
    /// The problem a case describes.
    pub fn new(case: &Case) -> Self {
        let Tools {
            punch_radius,
            die_radius,
            die_shoulder_radius,
        } = case.tools;
        let (sheet, divisions, loading) = (&case.sheet, &case.discretisation, &case.loading);
        let density = match loading.dynamics {
            Dynamics::Slow => case.material.density,
            Dynamics::None => 0.0,
        };
        Self {
            mesh: SheetMesh::new(
                sheet.half_length(),
                sheet.thickness,
                divisions.nx,
                divisions.ny,
            ),
            material: VonMises::new(
                case.material.young_modulus,
                case.material.poisson_ratio,
                case.material.hardening.clone(),
            ),
            young_modulus: case.material.young_modulus,
            density,
            quadrature: divisions.quadrature,
            contact_samples: contact_rule(divisions.contact_points_per_edge),
            contact_compliance: divisions.contact_compliance,
            die: die(die_radius, die_shoulder_radius, sheet.half_length()),
            punch: punch(punch_radius, sheet.thickness, loading.stroke),
            motion: loading.motion(),
            whole_sheet: sheet.force_factor(),
        }
    }

    /// The tool a face of the sheet can touch, and how far it has moved at time `t` (ms), mm.
    pub fn tool(&self, side: SurfaceSide, t: f64) -> (&Profile, [f64; 2]) {
        match side {
            SurfaceSide::Bottom => (&self.die, [0.0, 0.0]),
            SurfaceSide::Top => (&self.punch, [0.0, -self.motion.depth(t)]),
        }
    }
}
