//! What is solved: a sheet, its material, supports and loads, and the tools with their motion.

use std::sync::Arc;

use crate::case::{Case, Dynamics};
use crate::contact::{ContactRule, ContactSample};
use crate::element::Quadrature;
use crate::material::VonMises;
use crate::mesh::{SheetMesh, SurfaceSide};
use crate::tool::{Distance, Motion, Profile};

/// The whole problem, the same on every rank.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Mesh of the sheet.
    pub mesh: SheetMesh,
    /// Material of the sheet.
    pub material: VonMises,
    /// Young's modulus, MPa; forces are divided by it in the equations.
    pub young_modulus: f64,
    /// Density, g/mm³; zero solves without inertia.
    pub density: f64,
    /// Gauss rule of the elements.
    pub quadrature: Quadrature,
    /// Prescribed displacements.
    pub supports: Vec<NodalValue>,
    /// Dead loads, N per mm of width.
    pub loads: Vec<NodalValue>,
    /// Where the faces' edges have contact points.
    pub contact_rule: ContactRule,
    /// Contact compliance: how far the surface yields under unit pressure, mm/MPa.
    pub contact_compliance: f64,
    /// Coulomb's coefficient of friction.
    pub friction_coefficient: f64,
    /// Elastic slip under unit friction traction, mm/MPa.
    pub friction_compliance: f64,
    /// The tool the lower face can touch.
    pub lower_tool: Option<Arc<Tool>>,
    /// The tool the upper face can touch.
    pub upper_tool: Option<Arc<Tool>>,
    /// Half model force per millimetre of width to force of the whole sheet, mm.
    pub whole_sheet: f64,
}

/// A value at a node that is proportional to a function of time.
#[derive(Clone, Debug)]
pub struct NodalValue {
    /// Node of the mesh.
    pub node: usize,
    /// 0 for x, 1 for y.
    pub component: usize,
    /// Value at factor one: mm, or N per mm of width.
    pub value: f64,
    /// The factor against time.
    pub factor: Factor,
}

/// A factor against time, linear between the points and constant outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor(pub Vec<(f64, f64)>);

/// A rigid tool and its motion.
#[derive(Clone, Debug)]
pub struct Tool {
    /// Outline in its first position.
    pub profile: Profile,
    /// How it moves.
    pub motion: Motion,
}

impl Tool {
    /// Signed distance of `x` (mm) to the tool at time `t` (ms).
    pub fn distance(&self, x: [f64; 2], t: f64) -> Distance {
        let shift = self.motion.shift(t);
        self.profile.distance([x[0] - shift[0], x[1] - shift[1]])
    }

    /// The same without what belongs to it, mm.
    pub fn signed_distance(&self, x: [f64; 2], t: f64) -> f64 {
        let shift = self.motion.shift(t);
        self.profile
            .signed_distance([x[0] - shift[0], x[1] - shift[1]])
    }
}

impl Factor {
    /// The factor at time `t` (ms).
    pub fn at(&self, t: f64) -> f64 {
        let points = &self.0;
        let after = points.partition_point(|&(time, _)| time < t);
        match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
            (Some((t0, f0)), Some(&(t1, f1))) => f0 + (f1 - f0) * (t - t0) / (t1 - t0),
            (None, Some(&(_, factor))) | (Some((_, factor)), None) => factor,
            (None, None) => 0.0,
        }
    }
}

impl Problem {
    /// The problem a case describes.
    pub fn new(case: &Case) -> Self {
        let (sheet, divisions, loading) = (&case.sheet, &case.discretisation, &case.loading);
        let density = match loading.dynamics {
            Dynamics::Slow => case.material.density,
            Dynamics::None => 0.0,
        };
        let mesh = SheetMesh::new(
            sheet.half_length(),
            sheet.thickness,
            divisions.nx,
            divisions.ny,
        );
        let on_symmetry_line = |&node: &usize| NodalValue {
            node,
            component: 0,
            value: 0.0,
            factor: Factor(Vec::new()),
        };
        Self {
            supports: mesh.symmetry_nodes.iter().map(on_symmetry_line).collect(),
            loads: Vec::new(),
            mesh,
            material: VonMises::new(
                case.material.young_modulus,
                case.material.poisson_ratio,
                case.material.hardening.clone(),
            ),
            young_modulus: case.material.young_modulus,
            density,
            quadrature: divisions.quadrature(),
            contact_rule: ContactRule::new(
                divisions.contact_location,
                divisions.contact_points_per_edge,
            ),
            contact_compliance: divisions.contact_compliance,
            friction_coefficient: case.friction.coefficient,
            friction_compliance: case.friction.compliance,
            lower_tool: Some(Arc::new(Tool {
                profile: case.die(),
                motion: Motion::Fixed,
            })),
            upper_tool: Some(Arc::new(Tool {
                profile: case.punch(),
                motion: Motion::Down(loading.motion()),
            })),
            whole_sheet: sheet.force_factor(),
        }
    }

    /// Contact points that belong to a surface edge of the mesh.
    pub fn contact_samples(&self, edge: usize) -> Vec<ContactSample> {
        let along = edge % self.mesh.nx;
        self.contact_rule
            .samples(along == 0, along + 1 == self.mesh.nx)
    }

    /// The tool a face of the sheet can touch.
    pub fn tool(&self, side: SurfaceSide) -> Option<&Arc<Tool>> {
        match side {
            SurfaceSide::Bottom => self.lower_tool.as_ref(),
            SurfaceSide::Top => self.upper_tool.as_ref(),
        }
    }
}
