//! What a state is worth: forces, energies, the arm's angle, and how well contact holds.

use mpi::traits::Communicator;

use super::error::ElementFailure;
use super::history::History;
use super::measure_sums::{Maxima, Sums};
use super::subdomain::Subdomain;
use crate::element::edge_shape;
use crate::mesh::SurfaceSide;
use crate::plane::{Vector, interpolate};
use crate::tool::Distance;

/// The arm's fit uses the outer sixth of the half sheet: beyond the die's shoulder it is free of
/// stress, so it is straight unless it yielded before.
pub(super) const ARM_START: f64 = 5.0 / 6.0;
/// Penetration is looked for at this many equal steps along each edge: between contact points, too.
const PENETRATION_PROBES: usize = 48;
/// No place on a quadratic edge is farther from a point than this many times the farthest of its nodes: the largest sum of
/// the magnitudes of its shape functions. A distance changes by no more than the way.
const REACH: f64 = 1.25;

/// Measures of the whole sheet (both halves, full width) at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Force that pushes the punch down, N.
    pub punch_force: f64,
    /// Force of the die on the sheet, upward, N.
    pub die_force: f64,
    /// Force that accelerates the sheet downward, N.
    pub inertia: f64,
    /// Kinetic energy, mJ.
    pub kinetic_energy: f64,
    /// Stored elastic energy, mJ.
    pub strain_energy: f64,
    /// Plastic work since the start, mJ.
    pub plastic_dissipation: f64,
    /// Work of friction since the start, mJ.
    pub friction_work: f64,
    /// Energy stored in the compliance of contact, mJ.
    pub compliance_energy: f64,
    /// Contact points that carry a force, in the half model.
    pub active_points: usize,
    /// Displacement of point A of the sheet in y, mm.
    pub point_a_displacement: f64,
    /// Distance of point A to the punch, mm.
    pub point_a_gap: f64,
    /// Opening angle between the two arms, degrees.
    pub angle: f64,
    /// Root mean square distance of the arm from the straight fit, mm.
    pub angle_fit_residual: f64,
    /// Deepest penetration at the contact points and between them, mm.
    pub max_penetration: f64,
    /// Smallest contact force of a point, N; a negative one is tensile.
    pub min_contact_force: f64,
    /// Largest contact force of a point, N.
    pub max_contact_force: f64,
    /// Largest product of contact force (N) and open gap (mm) of a point, mJ.
    pub max_complementarity: f64,
    /// Largest equivalent plastic strain.
    pub max_plastic_strain: f64,
    /// Largest excess of friction over the coefficient times the contact force of a point, as a share
    /// of the coefficient times the largest contact force; zero if the cone holds.
    pub cone_violation: f64,
}

/// One rank's contribution to the [`Measures`].
#[derive(Clone, Debug)]
pub(super) struct PartialMeasures {
    sums: Sums,
    maxima: Maxima,
}

impl Measures {
    /// Work taken by friction and by the compliance of contact, mJ.
    pub fn contact_energy(&self) -> f64 {
        self.friction_work + self.compliance_energy
    }
}

impl Subdomain {
    /// This rank's contribution at time `t` (ms), with unknowns `u`, velocities `v` and
    /// accelerations `a` (local). The history must be that of `u`.
    pub(super) fn measure(
        &self,
        history: &History,
        t: f64,
        u: &[f64],
        v: &[f64],
        a: &[f64],
    ) -> Result<PartialMeasures, ElementFailure> {
        let mut partial = PartialMeasures {
            sums: Sums {
                friction_work: history.friction_work,
                ..Sums::default()
            },
            maxima: Maxima::NONE,
        };
        self.measure_contact(history, t, u, &mut partial);
        self.measure_elements(history, u, &mut partial)?;
        self.measure_motion(v, a, &mut partial.sums);
        self.measure_shape(t, u, &mut partial.sums);
        Ok(partial)
    }

    fn measure_contact(&self, history: &History, t: f64, u: &[f64], out: &mut PartialMeasures) {
        let PartialMeasures { sums, maxima } = out;
        let young = self.problem.young_modulus;
        for (point, (contact, committed)) in self.contacts.iter().zip(&history.friction).enumerate()
        {
            let m = self.multiplier(point);
            let (force, gap) = (young * u[m], u[m + 1]);
            let nodes = self.edge_positions(contact, u);
            let position = contact.position(&nodes, t, committed);
            let distance = position.distance;
            // The history is that of `u`, so its friction is the present one.
            let friction = young * committed.traction;
            let upward = upward(force, friction, &distance);
            match contact.side {
                SurfaceSide::Top => sums.punch_force -= upward,
                SurfaceSide::Bottom => sums.die_force += upward,
            }
            sums.compliance_energy += 0.5 * force * contact.law.compliance * u[m];
            if gap <= 0.0 && force > 0.0 {
                sums.active_points += 1.0;
            }
            let mut penetration = -distance.value;
            if contact.first_of_edge && distance.value < REACH * spread(position.x, &nodes) {
                for k in 0..=PENETRATION_PROBES {
                    let shape = edge_shape(2.0 * k as f64 / PENETRATION_PROBES as f64 - 1.0);
                    let x = interpolate(shape, &nodes);
                    penetration = penetration.max(-contact.tool.signed_distance(x, t));
                }
            }
            let friction_excess = contact.law.friction.map_or(f64::NEG_INFINITY, |law| {
                friction.abs() / law.coefficient - force.max(0.0)
            });
            maxima.include(&Maxima {
                penetration,
                tensile_force: -force,
                contact_force: force,
                complementarity: (force * gap).abs(),
                friction_excess,
                ..Maxima::NONE
            });
        }
    }

    fn measure_elements(
        &self,
        history: &History,
        u: &[f64],
        out: &mut PartialMeasures,
    ) -> Result<(), ElementFailure> {
        let material = &self.problem.material;
        for element in 0..self.elements.len() {
            let values = self.element_values(element, u);
            for (point, state) in history.element(element).iter().enumerate() {
                let (response, _, volume) = self.kernels[element]
                    .point_response(point, &values, material, state)
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                let p = state.equivalent_plastic_strain;
                out.sums.strain_energy += volume * response.elastic_energy();
                out.sums.plastic_dissipation += volume * material.hardening().plastic_work(p);
                out.maxima.plastic_strain = out.maxima.plastic_strain.max(p);
            }
        }
        Ok(())
    }

    fn measure_motion(&self, v: &[f64], a: &[f64], sums: &mut Sums) {
        let density = self.problem.density;
        for (element, kernel) in self.kernels.iter().enumerate() {
            let velocity = self.element_values(element, v);
            let acceleration = self.element_values(element, a);
            for (i, row) in kernel.mass().iter().enumerate() {
                for (j, m) in row.iter().enumerate() {
                    sums.inertia -= density * m * acceleration[j][1];
                    let product = velocity[i][0] * velocity[j][0] + velocity[i][1] * velocity[j][1];
                    sums.kinetic_energy += 0.5 * density * m * product;
                }
            }
        }
    }

    fn measure_shape(&self, t: f64, u: &[f64], sums: &mut Sums) {
        let mesh = &self.problem.mesh;
        let half_length = mesh.nodes.iter().fold(0.0_f64, |m, x| m.max(x[0]));
        for (local, &node) in self.nodes.iter().enumerate() {
            if !self.owned[local] {
                continue;
            }
            let before = self.coordinates[local];
            let now = [before[0] + u[2 * local], before[1] + u[2 * local + 1]];
            if node == mesh.point_a {
                sums.point_a_displacement += u[2 * local + 1];
                if let Some(tool) = &self.problem.upper_tool {
                    sums.point_a_gap += tool.signed_distance(now, t);
                }
            }
            if before[0] >= ARM_START * half_length {
                // Measured from the sheet's end, so that nothing cancels when the means are taken.
                sums.arm.add([before[0] - half_length, before[1]], now);
            }
        }
    }
}

/// How far the farthest of an edge's nodes is from a point, mm.
fn spread(from: Vector, nodes: &[Vector; 3]) -> f64 {
    let away = nodes.map(|x| (x[0] - from[0]).hypot(x[1] - from[1]));
    away.into_iter().fold(0.0, f64::max)
}

/// Vertical part of a contact point's normal and friction force on the sheet, N per mm of width.
pub(super) fn upward(force: f64, friction: f64, distance: &Distance) -> f64 {
    force * distance.gradient[1] + friction * distance.arc_gradient[1]
}

impl PartialMeasures {
    /// The measures of the whole sheet; `whole_sheet` (mm) turns forces of the half model per millimetre of width
    /// into those of the sheet. Collective.
    pub fn over_ranks(&self, comm: &impl Communicator, whole_sheet: f64) -> Measures {
        let (sums, maxima) = (self.sums.over_ranks(comm), self.maxima.over_ranks(comm));
        let (angle, angle_fit_residual) = sums.arm.fit();
        Measures {
            punch_force: whole_sheet * sums.punch_force,
            die_force: whole_sheet * sums.die_force,
            inertia: whole_sheet * sums.inertia,
            kinetic_energy: whole_sheet * sums.kinetic_energy,
            strain_energy: whole_sheet * sums.strain_energy,
            plastic_dissipation: whole_sheet * sums.plastic_dissipation,
            friction_work: whole_sheet * sums.friction_work,
            compliance_energy: whole_sheet * sums.compliance_energy,
            active_points: sums.active_points as usize,
            point_a_displacement: sums.point_a_displacement,
            point_a_gap: sums.point_a_gap,
            angle,
            angle_fit_residual,
            max_penetration: maxima.penetration.max(0.0),
            min_contact_force: -whole_sheet * maxima.tensile_force,
            max_contact_force: whole_sheet * maxima.contact_force,
            max_complementarity: whole_sheet * maxima.complementarity,
            max_plastic_strain: maxima.plastic_strain,
            cone_violation: maxima.friction_excess.max(0.0)
                / maxima.contact_force.max(f64::MIN_POSITIVE),
        }
    }
}
