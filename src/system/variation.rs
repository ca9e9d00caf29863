//! How what a subdomain computes moves with a parameter of the problem, along with the unknowns and the history.
//!
//! The kernels give exact derivatives. What they need to know of the parameter, how it moves the numbers of the problem
//! (nodes, constants, tools), is the difference of the two problems beside it, the same on every rank.

use mpi::traits::Communicator;
use petsc::VectorRef;

use super::System;
use super::evaluated::EvaluatedStep;
use super::history::History;
use super::problem::Problem;
use super::shape_slope::ShapeSlopes;
use super::subdomain::{LocalContact, Subdomain};
use crate::contact::{ContactAt, ContactLawSlope, ContactMotion, ContactSlope, FrictionState};
use crate::element::{PointMotion, Quad8Slope};
use crate::material::{MaterialSlope, PointState};
use crate::mesh::SurfaceSide;
use crate::plane::{PlaneTensor, dot, interpolate};
use crate::tool::ProfileSlope;

/// Multipliers up to this size are rounding (mm), and gaps up to this size are closed (mm; PETSc's limit).
const NO_FORCE: f64 = 1e-13;
const CLOSED: f64 = 1e-8;
/// Gauss points whose trial stress differs from the flow stress by a larger share are not at a kink.
const NEAR: f64 = 1e-3;
/// The share of a parameter within which a Gauss point that begins or ceases to yield makes its derivative doubtful.
const DOUBTFUL: f64 = 1e-6;

/// How a parameter moves the numbers of one rank's part of the problem, per unit.
pub struct Variation {
    /// Value of the parameter.
    value: f64,
    /// Of Young's modulus, as a share of it.
    young: f64,
    material: MaterialSlope,
    /// Of the local nodes, mm, and of their elements; none if the mesh stays.
    mesh: Option<(Vec<[f64; 2]>, Vec<Quad8Slope>)>,
    lower_tool: Option<ProfileSlope>,
    upper_tool: Option<ProfileSlope>,
    /// Of the constants of the contact points.
    contacts: Vec<ContactLawSlope>,
}

/// What has moved at the end of a step, on this rank.
#[derive(Clone, Copy, Debug, Default)]
pub struct Advanced {
    /// Derivative of the punch force, N per mm of width of the half model.
    pub force: f64,
    /// Gauss points so near a kink that their derivative may hold on one side only.
    pub doubtful_points: usize,
}

impl System {
    /// For the problems with more and with less of a parameter of this value, `width` of it apart, on the same mesh but
    /// for its coordinates.
    pub fn variation(&self, sides: [Problem; 2], width: f64, value: f64) -> Variation {
        let rank = self.comm().rank() as usize;
        let side = |problem| Subdomain::new(problem, self.partition(), self.numbering(), rank);
        Variation::between(self.local(), &sides.map(side), width, value)
    }

    /// The sum of all ranks' shares of a residual. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn sum_of_shares(&self, shares: &[f64], out: &mut VectorRef) -> petsc::Result<()> {
        out.set_all(0.0)?;
        self.ghosts.reverse_add(shares, out)
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
    /// Whether a contact point carries a force at converged unknowns.
    fn carries(&self, u: &[f64], point: usize) -> bool {
        let m = self.multiplier(point);
        u[m] > NO_FORCE && u[m + 1] <= CLOSED
    }
}

impl Variation {
    fn between(of: &Subdomain, sides: &[Subdomain; 2], width: f64, value: f64) -> Self {
        let [above, below] = sides;
        let coordinates = above.coordinates.iter().zip(&below.coordinates);
        let nodes: Vec<[f64; 2]> = coordinates
            .map(|(a, b)| [0, 1].map(|k| (a[k] - b[k]) / width))
            .collect();
        let element = |(element, nodes_of): (usize, &[usize; 8])| {
            let kernels = [above, below].map(|side| &side.kernels[element]);
            Quad8Slope::new(
                &of.kernels[element],
                nodes_of.map(|n| nodes[n]),
                kernels,
                width,
            )
        };
        let moves = nodes.iter().any(|node| *node != [0.0; 2]);
        let elements = moves.then(|| of.connectivity.iter().enumerate().map(element).collect());
        let [more, less] = [&above.problem, &below.problem];
        let tool = |side| {
            let (above, below) = (more.tool(side)?, less.tool(side)?);
            ProfileSlope::between(&above.profile, &below.profile, width)
        };
        let laws = above.contacts.iter().zip(&below.contacts);
        Self {
            value,
            young: (more.young_modulus - less.young_modulus) / width / of.problem.young_modulus,
            material: MaterialSlope::between(&more.material, &less.material, width),
            lower_tool: tool(SurfaceSide::Bottom),
            upper_tool: tool(SurfaceSide::Top),
            contacts: laws
                .map(|(above, below)| ContactLawSlope::between(&above.law, &below.law, width))
                .collect(),
            mesh: elements.map(|elements| (nodes, elements)),
        }
    }

    /// The derivative of the history of a sheet that has not moved; a derivative is kept as a history, number for number.
    pub fn virgin_slope(&self, of: &Subdomain) -> History {
        let friction = |contact: &LocalContact| {
            let nodes = contact.nodes.map(|n| self.node(n));
            let x = contact.reference(&contact.nodes.map(|n| of.coordinates[n]));
            let (profile, shape) = (&contact.tool.profile, contact.law.shape);
            let at = profile.distance(x);
            let by_tool = self
                .tool(contact.side)
                .map(|by| profile.distance_slope(&at, by).arc_length);
            FrictionState {
                traction: 0.0,
                arc_length: dot(at.arc_gradient, interpolate(shape, &nodes))
                    + by_tool.unwrap_or(0.0),
                nodes,
            }
        };
        History::still(of, of.contacts.iter().map(friction).collect())
    }

    /// The derivative of this rank's share of the residual at held unknowns, where the history before the step moves by
    /// `history` and the accelerations by `a` (local). Open contact points, which take no part in equilibrium, are left
    /// out.
    pub fn residual_slope(
        &self,
        step: &EvaluatedStep<'_>,
        history: &History,
        a: &[f64],
        out: &mut [f64],
    ) {
        let (of, held) = (step.of, vec![0.0; out.len()]);
        out.fill(0.0);
        self.add_force_slopes(step, history, out);
        self.add_inertia_slopes(step, a, out);
        for point in (0..of.contacts.len()).filter(|&point| of.carries(step.u, point)) {
            let (slope, m) = (
                self.contact(step, point, &held, history),
                of.multiplier(point),
            );
            for (i, force) in slope.force.iter().enumerate() {
                out[2 * of.contacts[point].nodes[i / 2] + i % 2] += force;
            }
            out[m] = slope.closure;
        }
        for support in &of.supports {
            out[support.unknown] = 0.0;
        }
    }

    fn add_force_slopes(&self, step: &EvaluatedStep<'_>, history: &History, out: &mut [f64]) {
        let (of, held) = (step.of, [[0.0; 2]; 8]);
        let scale = 1.0 / of.problem.young_modulus;
        for (element, nodes) in of.connectivity.iter().enumerate() {
            let (states, moves) = (history.element(element), self.element(element));
            for (k, (at, before)) in step.points(element).iter().zip(states).enumerate() {
                let yields = at.response.response().yields();
                if moves.is_none() && *before == PointState::STILL && self.material.is_zero(yields)
                {
                    continue;
                }
                let motion = match moves {
                    Some(_) => at.motion(k, &held, moves),
                    None => PointMotion::STILL,
                };
                let slope = at
                    .response
                    .slope(&motion.deformation, before, &self.material);
                let stress = less(
                    slope.kirchhoff,
                    self.young,
                    at.response.response().kirchhoff,
                );
                for (&n, force) in nodes.iter().zip(at.force_slope(&motion, &stress)) {
                    out[2 * n] += scale * force[0];
                    out[2 * n + 1] += scale * force[1];
                }
            }
        }
    }

    fn add_inertia_slopes(&self, step: &EvaluatedStep<'_>, a: &[f64], out: &mut [f64]) {
        let of = step.of;
        let scale = of.problem.density / of.problem.young_modulus;
        if scale == 0.0 {
            return;
        }
        let moved = a
            .iter()
            .zip(step.a)
            .map(|(moved, a)| moved - self.young * a);
        of.add_inertia(&moved.collect::<Vec<f64>>(), out);
        let Some((_, elements)) = &self.mesh else {
            return;
        };
        for ((element, moves), nodes) in elements.iter().enumerate().zip(&of.connectivity) {
            let acceleration = of.element_values(element, step.a);
            for (row, &n) in moves.mass().iter().zip(nodes) {
                for k in 0..2 {
                    let sum: f64 = row.iter().zip(&acceleration).map(|(m, a)| m * a[k]).sum();
                    out[2 * n + k] += scale * sum;
                }
            }
        }
    }

    /// With the derivatives `du` of the unknowns at the end of a step (local), takes that of the history from its start to
    /// its end.
    pub fn advance(&self, step: &EvaluatedStep<'_>, du: &[f64], history: &mut History) -> Advanced {
        let doubtful_points = self.advance_material(step, du, history);
        let of = step.of;
        let slides = of.problem.friction_coefficient > 0.0;
        let mut force = 0.0;
        for point in 0..of.contacts.len() {
            let carries = of.carries(step.u, point);
            if !slides && !carries {
                continue;
            }
            let slope = self.contact(step, point, du, history);
            if carries && of.contacts[point].side == SurfaceSide::Top {
                let [load, by_load] = slope.load;
                force -= of.problem.young_modulus * (by_load[1] + self.young * load[1]);
            }
            history.friction[point] = slope.state;
        }
        Advanced {
            force,
            doubtful_points,
        }
    }

    fn advance_material(
        &self,
        step: &EvaluatedStep<'_>,
        du: &[f64],
        history: &mut History,
    ) -> usize {
        let (of, mut doubtful) = (step.of, 0);
        let states = history.gauss_points.chunks_exact_mut(history.per_element);
        for (element, states) in states.enumerate() {
            let (moved, moves) = (of.element_values(element, du), self.element(element));
            for (k, (at, state)) in step.points(element).iter().zip(states).enumerate() {
                let excess = at.excess;
                let near = excess.abs() < NEAR;
                if !at.response.response().yields() && !near {
                    continue;
                }
                let motion = at.motion(k, &moved, moves);
                let slope = at
                    .response
                    .slope(&motion.deformation, state, &self.material);
                if near {
                    let material = &of.problem.material;
                    let by = material.excess_slope(&at.response, &slope, state, &self.material);
                    doubtful += usize::from((by * self.value).abs() * DOUBTFUL > excess.abs());
                }
                *state = slope.state;
            }
        }
        doubtful
    }

    /// Derivatives of a contact point along those of the unknowns.
    fn contact(
        &self,
        step: &EvaluatedStep<'_>,
        point: usize,
        du: &[f64],
        history: &History,
    ) -> ContactSlope {
        let (of, m) = (step.of, step.of.multiplier(point));
        let (contact, (position, traction)) = (&of.contacts[point], &step.contacts[point]);
        let at = ContactAt {
            tool: &contact.tool.profile,
            position,
            multiplier: step.u[m],
            traction,
            before: &step.before.friction[point],
        };
        let motion = ContactMotion {
            nodes: contact
                .nodes
                .map(|n| [0, 1].map(|k| self.node(n)[k] + du[2 * n + k])),
            multiplier: du[m],
            tool: self.tool(contact.side),
            law: &self.contacts[point],
            before: &history.friction[point],
        };
        contact.law.slope(&at, &motion)
    }

    /// Derivatives of what is read off the sheet's shape, with the derivatives `du` of the unknowns (local).
    pub fn shape_slopes(&self, step: &EvaluatedStep<'_>, du: &[f64]) -> ShapeSlopes {
        step.of.shape_slopes(step.u, du, |n| self.node(n))
    }

    /// Motion of a local node, mm per unit.
    fn node(&self, node: usize) -> [f64; 2] {
        self.mesh
            .as_ref()
            .map_or([0.0; 2], |(nodes, _)| nodes[node])
    }

    fn element(&self, element: usize) -> Option<&Quad8Slope> {
        self.mesh.as_ref().map(|(_, elements)| &elements[element])
    }

    fn tool(&self, side: SurfaceSide) -> Option<&ProfileSlope> {
        match side {
            SurfaceSide::Bottom => self.lower_tool.as_ref(),
            SurfaceSide::Top => self.upper_tool.as_ref(),
        }
    }
}

/// `a - share b`.
fn less(a: PlaneTensor, share: f64, b: PlaneTensor) -> PlaneTensor {
    PlaneTensor {
        xx: a.xx - share * b.xx,
        yy: a.yy - share * b.yy,
        zz: a.zz - share * b.zz,
        xy: a.xy - share * b.xy,
    }
}
