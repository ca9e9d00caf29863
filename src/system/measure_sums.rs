//! Sums and maxima over points, elements and ranks, from which the measures of a state come.

use mpi::traits::Communicator;

use crate::ranks;

/// What adds up over points, elements and ranks, for the half model and per millimetre of width.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    pub punch_force: f64,
    pub die_force: f64,
    pub inertia: f64,
    pub kinetic_energy: f64,
    pub strain_energy: f64,
    pub plastic_dissipation: f64,
    pub friction_work: f64,
    pub compliance_energy: f64,
    pub active_points: f64,
    pub point_a_displacement: f64,
    pub point_a_gap: f64,
    pub arm: ArmSums,
}

/// Sums over the nodes of the arm: reference position X from the sheet's end, and present position x.
#[derive(Clone, Debug, Default)]
pub(super) struct ArmSums {
    pub nodes: f64,
    pub from: [f64; 2],
    pub now: [f64; 2],
    /// X·x
    pub along: f64,
    /// X_1 x_2 - X_2 x_1
    pub across: f64,
    /// X·X + x·x
    pub spread: f64,
}

/// What is largest over points and ranks, likewise; minus infinity where there is nothing.
#[derive(Clone, Debug)]
pub(super) struct Maxima {
    pub penetration: f64,
    pub tensile_force: f64,
    pub contact_force: f64,
    pub complementarity: f64,
    pub plastic_strain: f64,
    /// Of friction over the coefficient less the contact force.
    pub friction_excess: f64,
}

impl Maxima {
    pub const NONE: Self = Self {
        penetration: f64::NEG_INFINITY,
        tensile_force: f64::NEG_INFINITY,
        contact_force: f64::NEG_INFINITY,
        complementarity: f64::NEG_INFINITY,
        plastic_strain: f64::NEG_INFINITY,
        friction_excess: f64::NEG_INFINITY,
    };

    /// The larger of both, each.
    pub fn include(&mut self, other: &Self) {
        *self = Self {
            penetration: self.penetration.max(other.penetration),
            tensile_force: self.tensile_force.max(other.tensile_force),
            contact_force: self.contact_force.max(other.contact_force),
            complementarity: self.complementarity.max(other.complementarity),
            plastic_strain: self.plastic_strain.max(other.plastic_strain),
            friction_excess: self.friction_excess.max(other.friction_excess),
        };
    }

    /// Over all ranks. Collective.
    pub fn over_ranks(&self, comm: &impl Communicator) -> Self {
        let Self {
            penetration,
            tensile_force,
            contact_force,
            complementarity,
            plastic_strain,
            friction_excess,
        } = *self;
        let mine = [
            penetration,
            tensile_force,
            contact_force,
            complementarity,
            plastic_strain,
            friction_excess,
        ];
        let [
            penetration,
            tensile_force,
            contact_force,
            complementarity,
            plastic_strain,
            friction_excess,
        ] = ranks::maxima(comm, mine);
        Self {
            penetration,
            tensile_force,
            contact_force,
            complementarity,
            plastic_strain,
            friction_excess,
        }
    }
}

impl Sums {
    /// Over all ranks. Collective.
    pub fn over_ranks(&self, comm: &impl Communicator) -> Self {
        let mine = [
            self.punch_force,
            self.die_force,
            self.inertia,
            self.kinetic_energy,
            self.strain_energy,
            self.plastic_dissipation,
            self.friction_work,
            self.compliance_energy,
            self.active_points,
            self.point_a_displacement,
            self.point_a_gap,
        ];
        let [
            punch_force,
            die_force,
            inertia,
            kinetic_energy,
            strain_energy,
            plastic_dissipation,
            friction_work,
            compliance_energy,
            active_points,
            point_a_displacement,
            point_a_gap,
        ] = ranks::sums(comm, mine);
        Self {
            punch_force,
            die_force,
            inertia,
            kinetic_energy,
            strain_energy,
            plastic_dissipation,
            friction_work,
            compliance_energy,
            active_points,
            point_a_displacement,
            point_a_gap,
            arm: self.arm.over_ranks(comm),
        }
    }
}

impl ArmSums {
    /// Adds a node with its reference and its present position.
    pub fn add(&mut self, from: [f64; 2], now: [f64; 2]) {
        self.nodes += 1.0;
        for k in 0..2 {
            self.from[k] += from[k];
            self.now[k] += now[k];
        }
        self.along += from[0] * now[0] + from[1] * now[1];
        self.across += from[0] * now[1] - from[1] * now[0];
        self.spread += from[0] * from[0] + from[1] * from[1] + now[0] * now[0] + now[1] * now[1];
    }

    /// Over all ranks. Collective.
    pub fn over_ranks(&self, comm: &impl Communicator) -> Self {
        let [[fx, fy], [nx, ny]] = [self.from, self.now];
        let mine = [
            self.nodes,
            fx,
            fy,
            nx,
            ny,
            self.along,
            self.across,
            self.spread,
        ];
        let [nodes, fx, fy, nx, ny, along, across, spread] = ranks::sums(comm, mine);
        Self {
            nodes,
            from: [fx, fy],
            now: [nx, ny],
            along,
            across,
            spread,
        }
    }

    /// Opening angle (degrees) and root mean square residual (mm) of the rigid motion that fits the arm
    /// best in the least squares sense (Kabsch 1976, in two dimensions).
    pub fn fit(&self) -> (f64, f64) {
        let n = self.nodes;
        let ([fx, fy], [nx, ny]) = (self.from.map(|x| x / n), self.now.map(|x| x / n));
        let along = self.along - n * (fx * nx + fy * ny);
        let across = self.across - n * (fx * ny - fy * nx);
        let spread = self.spread - n * (fx * fx + fy * fy + nx * nx + ny * ny);
        let rotation = across.atan2(along).to_degrees();
        let residual = ((spread - 2.0 * along.hypot(across)) / n).max(0.0).sqrt();
        (180.0 - 2.0 * rotation, residual)
    }
}
