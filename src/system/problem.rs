//! What is solved: the sheet, its material, the tools and their motion.

use crate::contact::{ContactSample, contact_rule};
use crate::element::Quadrature;
use crate::material::VonMises;
use crate::mesh::{SheetMesh, SurfaceSide};
use crate::tool::{Profile, PunchMotion};

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
    /// The tool a face of the sheet can touch, and how far it has moved at time `t` (ms), mm.
    pub fn tool(&self, side: SurfaceSide, t: f64) -> (&Profile, [f64; 2]) {
        match side {
            SurfaceSide::Bottom => (&self.die, [0.0, 0.0]),
            SurfaceSide::Top => (&self.punch, [0.0, -self.motion.depth(t)]),
        }
    }

    /// Contact points with `count` of them on each edge.
    pub fn contact_samples(count: usize) -> Vec<ContactSample> {
        contact_rule(count)
    }
}
