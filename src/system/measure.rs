//! What a state is worth: forces, energies, the arm's angle, and how well contact holds.

use super::LocalSystem;
use super::evaluate::ElementFailure;
use crate::mesh::SurfaceSide;

/// The arm's fit uses the outer sixth of the half sheet: beyond the die's shoulder it is free of
/// stress, so it is straight unless it yielded on its way.
const ARM_START: f64 = 5.0 / 6.0;
/// Penetration is looked for at so many equal steps along each edge: between contact points, too.
const PENETRATION_PROBES: usize = 48;

/// One rank's contribution: numbers that add up over the ranks, and numbers of which the largest
/// counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartialMeasures {
    /// To be added over the ranks.
    pub sums: [f64; SUMS],
    /// To be maximised over the ranks.
    pub maxima: [f64; MAXIMA],
}

const SUMS: usize = 18;
const MAXIMA: usize = 6;

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
    /// Work taken by the surface's give and by friction, mJ.
    pub contact_energy: f64,
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
    /// Smallest contact force of a point, N; a negative one pulls.
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

impl LocalSystem {
    /// This rank's contribution at time `t` (ms), with unknowns `u`, velocities `v` and
    /// accelerations `a` (local). States must be the committed ones of `u`.
    pub fn measure(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        a: &[f64],
    ) -> Result<PartialMeasures, ElementFailure> {
        let mut partial = PartialMeasures {
            sums: [0.0; SUMS],
            maxima: [f64::NEG_INFINITY; MAXIMA],
        };
        partial.sums[6] = self.friction_work;
        self.measure_contact(t, u, &mut partial);
        self.measure_elements(u, v, a, &mut partial)?;
        self.measure_shape(t, u, &mut partial);
        Ok(partial)
    }

    fn measure_contact(&self, t: f64, u: &[f64], partial: &mut PartialMeasures) {
        let young = self.problem.young_modulus;
        for (point, contact) in self.contacts.iter().enumerate() {
            let m = self.multiplier(point);
            let (force, gap) = (young * u[m], u[m + 1]);
            let nodes = self.edge_positions(contact, u);
            let distance = contact.position(&nodes, t).distance;
            // The state is committed, so its traction is the present one.
            let friction = young * contact.state.traction;
            let upward = force * distance.gradient[1] + friction * distance.arc_gradient[1];
            match contact.side {
                SurfaceSide::Top => partial.sums[0] -= upward,
                SurfaceSide::Bottom => partial.sums[1] += upward,
            }
            if let Some(law) = contact.law.friction {
                let beyond = friction.abs() / law.coefficient - force.max(0.0);
                partial.maxima[5] = partial.maxima[5].max(beyond);
            }
            partial.sums[6] += 0.5 * force * contact.law.compliance * u[m];
            if gap <= 0.0 && force > 0.0 {
                partial.sums[7] += 1.0;
            }
            let maxima = &mut partial.maxima;
            maxima[1] = maxima[1].max(-force);
            maxima[2] = maxima[2].max(force);
            maxima[3] = maxima[3].max((force * gap).abs());
            if contact.first_of_edge {
                let probes = PENETRATION_PROBES;
                for k in 0..=probes {
                    let shape = crate::element::edge_shape(2.0 * k as f64 / probes as f64 - 1.0);
                    let x = [0, 1].map(|i| (0..3).map(|b| shape[b] * nodes[b][i]).sum::<f64>());
                    let value = contact.tool.distance(x, t).value;
                    maxima[0] = maxima[0].max(-value);
                }
            }
            maxima[0] = maxima[0].max(-distance.value);
        }
    }

    fn measure_elements(
        &self,
        u: &[f64],
        v: &[f64],
        a: &[f64],
        partial: &mut PartialMeasures,
    ) -> Result<(), ElementFailure> {
        let material = &self.problem.material;
        for element in 0..self.elements.len() {
            let values = self.element_values(element, u);
            for (point, state) in self.element_states(element).iter().enumerate() {
                let (response, _, volume) = self.kernels[element]
                    .point_response(point, &values, material, state)
                    .map_err(|cause| self.element_failure(element, u, cause))?;
                let p = state.equivalent_plastic_strain;
                partial.sums[4] += volume * response.elastic_energy();
                partial.sums[5] += volume * material.hardening().plastic_work(p);
                partial.maxima[4] = partial.maxima[4].max(p);
            }
            let density = self.problem.density;
            let (velocity, acceleration) = (
                self.element_values(element, v),
                self.element_values(element, a),
            );
            for (i, row) in self.kernels[element].mass().iter().enumerate() {
                for (j, m) in row.iter().enumerate() {
                    partial.sums[2] -= density * m * acceleration[j][1];
                    let product = velocity[i][0] * velocity[j][0] + velocity[i][1] * velocity[j][1];
                    partial.sums[3] += 0.5 * density * m * product;
                }
            }
        }
        Ok(())
    }

    fn measure_shape(&self, t: f64, u: &[f64], partial: &mut PartialMeasures) {
        let mesh = &self.problem.mesh;
        let half_length = mesh.nodes.iter().fold(0.0_f64, |m, x| m.max(x[0]));
        for (local, &node) in self.nodes.iter().enumerate() {
            if !self.owned[local] {
                continue;
            }
            let before = self.coordinates[local];
            let now = [before[0] + u[2 * local], before[1] + u[2 * local + 1]];
            if node == mesh.point_a {
                partial.sums[8] += u[2 * local + 1];
                if let Some(tool) = &self.problem.upper_tool {
                    partial.sums[9] += tool.distance(now, t).value;
                }
            }
            if before[0] >= ARM_START * half_length {
                // Measured from the sheet's end, so that nothing cancels when the means are taken.
                let from = [before[0] - half_length, before[1]];
                let products = [
                    1.0,
                    from[0],
                    from[1],
                    now[0],
                    now[1],
                    from[0] * now[0] + from[1] * now[1],
                    from[0] * now[1] - from[1] * now[0],
                    from[0] * from[0] + from[1] * from[1] + now[0] * now[0] + now[1] * now[1],
                ];
                for (sum, product) in partial.sums[10..].iter_mut().zip(products) {
                    *sum += product;
                }
            }
        }
    }
}

impl Measures {
    /// From the reduced contributions; `whole_sheet` (mm) turns half model forces per millimetre of
    /// width into those of the sheet.
    pub fn from_reduced(reduced: &PartialMeasures, whole_sheet: f64) -> Self {
        let sums = &reduced.sums;
        let maxima = &reduced.maxima;
        let (angle, angle_fit_residual) = arm_fit(&sums[10..]);
        Self {
            punch_force: whole_sheet * sums[0],
            die_force: whole_sheet * sums[1],
            inertia: whole_sheet * sums[2],
            kinetic_energy: whole_sheet * sums[3],
            strain_energy: whole_sheet * sums[4],
            plastic_dissipation: whole_sheet * sums[5],
            contact_energy: whole_sheet * sums[6],
            active_points: sums[7] as usize,
            point_a_displacement: sums[8],
            point_a_gap: sums[9],
            angle,
            angle_fit_residual,
            max_penetration: maxima[0].max(0.0),
            min_contact_force: -whole_sheet * maxima[1],
            max_contact_force: whole_sheet * maxima[2],
            max_complementarity: whole_sheet * maxima[3],
            max_plastic_strain: maxima[4],
            cone_violation: maxima[5].max(0.0) / maxima[2].max(f64::MIN_POSITIVE),
        }
    }
}

/// Opening angle (degrees) and root mean square residual (mm) of the rigid motion that fits the arm
/// best in the least squares sense (Kabsch 1976, in two dimensions).
fn arm_fit(sums: &[f64]) -> (f64, f64) {
    let n = sums[0];
    let [fx, fy, nx, ny] = [1, 2, 3, 4].map(|i| sums[i] / n);
    let along = sums[5] - n * (fx * nx + fy * ny);
    let across = sums[6] - n * (fx * ny - fy * nx);
    let spread = sums[7] - n * (fx * fx + fy * fy + nx * nx + ny * ny);
    let rotation = across.atan2(along).to_degrees();
    let residual = ((spread - 2.0 * along.hypot(across)) / n).max(0.0).sqrt();
    (180.0 - 2.0 * rotation, residual)
}
