//! The material along paths of stretch, without a mesh.

use mpi::topology::SimpleCommunicator;
use ssnp155::material::{PointState, VonMises};
use ssnp155::plane::PlaneTensor;

use crate::flow::{Constants, bisect};
use crate::row::{Answer, Case, Result, Row};

/// Which stresses are made to vanish by their stretch.
#[derive(Clone, Copy, PartialEq)]
enum Free {
    /// In y only; the stretch in z is one.
    Y,
    /// In y and z alike.
    YAndZ,
}

/// A material point stretched in x.
struct Driver {
    material: VonMises,
    state: PointState,
    /// Logarithmic strain in z so far.
    strain_z: f64,
    free: Free,
}

impl Driver {
    fn new(material: VonMises, free: Free) -> Self {
        Self {
            material,
            state: PointState::VIRGIN,
            strain_z: 0.0,
            free,
        }
    }

    /// Kirchhoff stress at logarithmic strains, with the new state. The material
    /// keeps the stretch in z at one; another one enters through the elastic left Cauchy-Green
    /// tensor's component zz, which the state holds.
    fn respond(&self, x: f64, y: f64, z: f64) -> (PlaneTensor, PointState) {
        let mut state = self.state;
        state.cp_inverse.zz *= (2.0 * (z - self.strain_z)).exp();
        let f = [[x.exp(), 0.0], [0.0, y.exp()]];
        let response = self
            .material
            .respond(&f, &state)
            .expect("a positive stretch");
        (response.kirchhoff, response.state())
    }

    /// Moves on to the logarithmic strain `x` with the free stresses at zero; gives the stress.
    fn stretch(&mut self, x: f64) -> PlaneTensor {
        let z = |y: f64| if self.free == Free::YAndZ { y } else { 0.0 };
        let lateral = |y: f64| self.respond(x, y, z(y)).0.yy;
        let y = bisect(-2.0, 2.0, lateral);
        let (stress, state) = self.respond(x, y, z(y));
        self.state = state;
        self.strain_z = z(y);
        stress
    }

    fn plastic_strain(&self) -> f64 {
        self.state.equivalent_plastic_strain
    }
}

pub const UNIAXIAL: Case = Case {
    name: "material_uniaxial",
    title: "Material: uniaxial tension along the hardening table",
    text: "A point is stretched to the logarithmic strains of the table, with the lateral stretches iterated until the lateral \
stresses vanish. The path is proportional, so the return map is exact and the Kirchhoff stress must be the table's. \
(The table is read as Kirchhoff stress; the true stress is smaller by the volume ratio, 0.1 to 0.3 % here.) Tolerance: rounding.",
    quick: true,
    two_ranks: false,
    run: uniaxial,
};

fn uniaxial(_: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "the table itself, inputs/reference/hardening.csv";
    let table = include_str!("../../inputs/reference/hardening.csv");
    let mut driver = Driver::new(Constants::aluminium().material(), Free::YAndZ);
    let mut rows = Vec::new();
    let points = table.lines().filter_map(|line| {
        let (strain, stress) = line.split_once(',')?;
        Some((strain.parse::<f64>().ok()?, stress.parse::<f64>().ok()?))
    });
    for (index, (strain, stress)) in points.enumerate() {
        let computed = driver.stretch(strain).xx;
        if index % 4 == 1 || index == 0 {
            let quantity = format!("Kirchhoff stress at strain {strain}, MPa");
            // The table's first strain has six digits: its stress may differ in the sixth.
            let tolerance = if index == 0 { 2e-6 } else { 1e-12 };
            rows.push(Row::relative(quantity, computed, stress, tolerance, SOURCE));
        }
    }
    Ok(rows.into())
}

pub const PLANE_STRAIN: Case = Case {
    name: "material_plane_strain",
    title: "Material: plane strain tension",
    text: "Stretched in x, free in y, no strain in z: at first the Poisson ratio is that of the elastic material, later 1/2, so the \
stress turns in the deviatoric plane and the return map (backward Euler) is of first order. The reference integrates the \
Prandtl-Reuss rates in logarithmic strains by a Runge-Kutta method; principal axes do not turn, so small strain equations hold \
for any strain. 2000 and 4000 steps to a strain of 0.5, extrapolated to the limit of small steps. Tolerance: what is left of second order, and the kinks of the table.",
    quick: true,
    two_ranks: false,
    run: plane_strain,
};

fn plane_strain(_: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "Prandtl-Reuss rates (Hill 1950, chapter II), integrated independently";
    let constants = Constants::aluminium();
    let at = [0.02, 0.1, 0.5];
    let reference = constants.plane_strain_tension(&at, 1e-6);
    let path = |steps: usize| {
        let mut driver = Driver::new(constants.material(), Free::Y);
        let mut out = Vec::new();
        for step in 1..=steps {
            let strain = 0.5 * step as f64 / steps as f64;
            let stress = driver.stretch(strain);
            if at.iter().any(|a| (a - strain).abs() < 1e-12) {
                out.push([stress.xx, stress.zz, driver.plastic_strain()]);
            }
        }
        out
    };
    let (coarse, fine) = (path(2000), path(4000));
    let mut rows = Vec::new();
    for (i, strain) in at.iter().enumerate() {
        let names = ["stress in x, MPa", "stress in z, MPa", "plastic strain"];
        for (k, name) in names.iter().enumerate() {
            let quantity = format!("{name}, at strain {strain}");
            let limit = 2.0 * fine[i][k] - coarse[i][k];
            rows.push(Row::relative(
                quantity,
                limit,
                reference[i][k],
                2e-5,
                SOURCE,
            ));
        }
    }
    let error = |path: &[[f64; 3]]| (path[0][1] - reference[0][1]).abs();
    let order = (error(&coarse) / error(&fine)).log2();
    rows.push(Row::absolute(
        "order of the stress in z at strain 0.02",
        order,
        1.0,
        0.1,
        "backward Euler",
    ));
    Ok(rows.into())
}

pub const CYCLIC: Case = Case {
    name: "material_cyclic",
    title: "Material: uniaxial cycles",
    text: "Logarithmic strain 0 → 0.05 → -0.05 → 0.1 → 0, uniaxial stress. With isotropic hardening each branch ends \
at |stress| = yield stress(p), where p follows from the strain of the branch; a piecewise linear equation solved by bisection. \
The path is proportional, so the return map must be exact, in any number of steps (7 per branch here). Tolerance: rounding.",
    quick: true,
    two_ranks: false,
    run: cyclic,
};

fn cyclic(_: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "closed form (isotropic hardening, Simo and Hughes 1998, chapter 1)";
    let constants = Constants::aluminium();
    let mut driver = Driver::new(constants.material(), Free::YAndZ);
    let yield_stress = |p: f64| constants.hardening.yield_stress(p).0;
    let (mut from, mut plastic, mut p) = (0.0, 0.0, 0.0);
    let mut rows = Vec::new();
    for to in [0.05, -0.05, 0.1, 0.0_f64] {
        let mut stress = 0.0;
        for step in 1..=7 {
            stress = driver
                .stretch(from + (to - from) * f64::from(step) / 7.0)
                .xx;
        }
        // to = plastic strain before ± dp ± yield stress / E.
        let sign = (to - from).signum();
        let dp = bisect(0.0, 1.0, |dp| {
            plastic + sign * dp + sign * yield_stress(p + dp) / constants.young - to
        } * sign);
        p += dp;
        plastic += sign * dp;
        from = to;
        let quantity = format!("Kirchhoff stress at strain {to}, MPa");
        rows.push(Row::relative(
            quantity,
            stress,
            sign * yield_stress(p),
            1e-11,
            SOURCE,
        ));
        let quantity = format!("plastic strain at strain {to}");
        rows.push(Row::relative(
            quantity,
            driver.plastic_strain(),
            p,
            1e-11,
            SOURCE,
        ));
    }
    Ok(rows.into())
}
