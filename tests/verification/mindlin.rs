//! A cylinder pressed on a block with friction, then sheared, back and forth.

use std::f64::consts::PI;

use mpi::topology::SimpleCommunicator;
use ssnp155::contact::{ContactLocation, ContactRule, ContactState};
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::system::{Factor, NodalValue};
use ssnp155::tool::punch;

use crate::flow::Constants;
use crate::hertz::{ORDERING, RADIUS, SIZE, between, ellipse, knots};
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Statics, Touch, Touching, fixed, nodes_where, problem};
use crate::svg::Chart;

pub const SHEARED: Case = Case {
    name: "friction_mindlin",
    title: "Contact: Cattaneo and Mindlin, a cylinder pressed and sheared with friction",
    text: "The block of the Hertz case, whole (200 x 100 mm), pressed on the cylinder of 1000 mm by its base, which is then moved along the cylinder and back at constant pressing force P, coefficient of friction 0.3. \
Under a shearing force Q the outer contact slips and |x| < c = a √(1 - Q/(μ P)) sticks, with the traction q = μ p₀ (√(1 - x²/a²) - (c/a) √(1 - x²/c²)); on the way back from Q₁, slip of the other sign enters from the ends and a third ellipse of half width a √(1 - (Q₁ - Q)/(2 μ P)) is added. \
The theory needs normal and tangential forces that do not couple; under a rigid cylinder that is an incompressible block: Dundurs' constant (1 - 2ν)/(2(1 - ν)) is 2e-4 for ν = 0.4999 here (0.24 for aluminium). \
The elastic slip of friction is 1e-7 mm/MPa, E*/a times that 1 % (with 1e-8 and 3e-8 Newton's method finds no solution in the first steps of pressing). Where a zone ends, the traction has infinite slope, which an edge of 1/32 mm cannot follow: points nearer than two edges to an end are left out of comparisons and drawn. \
Stick width and depth are those of an ellipse fitted to what is missing to μ p. Tolerance: 0.5 % for the fit, as for Hertz; an edge for the last point that sticks; 1 % of p₀ for tractions as for Hertz, that is 1 %/μ of μ p₀, and the 1 % of elastic slip. \
With all points counted, errors at the ends are of the order of √h over a length h: the largest falls with √h, the root of the mean square with h as far as the ends alone make it, so its order between edges of 1/16 and 1/32 mm must lie between 1/2 and 1 (pressing leaves some friction behind where the points close one after the other, which falls more slowly).",
    quick: false,
    two_ranks: false,
    run: sheared,
};

const SOURCE: &str = "Cattaneo 1938, Mindlin 1949; Johnson 1985, section 7.2";
const BACK: &str = "Mindlin and Deresiewicz 1953; Johnson 1985, section 7.3";
/// PETSc's own factorisation takes a tenth of the time of MUMPS's here.
const SOLVER: &str = "condensed_pc_factor_mat_solver_type";
const FRICTION: f64 = 0.3;
const FRICTION_COMPLIANCE: f64 = 1e-7;
const CONTACT_COMPLIANCE: f64 = 1e-8;
/// How far the base is pressed in, and moved along, mm.
const PRESSED: f64 = 2e-3;
const MOVED: f64 = 6e-4;
/// Steps of pressing, and of moving by [`MOVED`].
const STEPS: [u32; 2] = [16, 4];
const EDGES: [f64; 2] = [1.0 / 16.0, 1.0 / 32.0];

/// The theory at a force P and a shearing force, both measured.
struct Theory {
    half_width: f64,
    peak: f64,
    /// Factor and half width w of the ellipses μ p₀ √(w² - x²)/a.
    layers: Vec<[f64; 2]>,
}

impl Theory {
    /// After Q alone, or after Q on the way back from `turned`.
    fn new(modulus: f64, [shear, force]: [f64; 2], turned: Option<f64>) -> Self {
        let half_width = (4.0 * force * RADIUS / (PI * modulus)).sqrt();
        let width = |shear: f64| half_width * (1.0 - shear / (FRICTION * force)).sqrt();
        Self {
            half_width,
            peak: 2.0 * force / (PI * half_width),
            layers: match turned {
                None => vec![[1.0, half_width], [-1.0, width(shear)]],
                Some(most) => vec![
                    [-1.0, half_width],
                    [2.0, width(0.5 * (most - shear))],
                    [-1.0, width(most)],
                ],
            },
        }
    }

    /// Traction over μ p₀.
    fn traction(&self, x: f64) -> f64 {
        let ellipse = |w: f64| (w * w - x * x).max(0.0).sqrt() / self.half_width;
        self.layers.iter().map(|[k, w]| k * ellipse(*w)).sum()
    }

    /// Errors of the tractions over μ p₀, of points that carry and are further than `away` from the ends of zones.
    fn errors(&self, points: &[Touch], away: f64) -> Vec<f64> {
        let smooth = |x: f64| self.layers.iter().all(|[_, w]| (x.abs() - w).abs() >= away);
        points
            .iter()
            .map(|point| (point.reference[0], point.friction))
            .filter(|(x, _)| x.abs() < self.half_width && smooth(*x))
            .map(|(x, q)| (q / (FRICTION * self.peak) - self.traction(x)).abs())
            .collect()
    }
}

/// The block on its base, with edges of this length in the contact.
struct Block {
    statics: Statics,
    base: Vec<usize>,
}

impl Block {
    fn new(world: &SimpleCommunicator, constants: &Constants, edge: f64) -> Result<Self> {
        let fine = |length: f64| (length / edge) as usize;
        let across = knots(edge, fine(1.2), 1.6);
        let down = knots(edge, fine(0.45), 1.6);
        let (nx, ny) = (across.len() - 1, down.len() - 1);
        let (half, height) = (nx as f64, ny as f64);
        let mesh = SheetMesh::new(2.0 * half, height, 2 * nx, ny).mapped(|[i, j]| {
            let x = between(&across, (i - half).abs());
            [x.copysign(i - half), SIZE - between(&down, height - j)]
        });
        let mut block = problem(mesh.clone(), constants, Quadrature::Reduced);
        let base = nodes_where(&mesh, |x| x[1] == 0.0);
        let along = Factor(vec![(1.0, 0.0), (2.0, MOVED), (4.0, -MOVED)]);
        let up = Factor(vec![(0.0, 0.0), (1.0, PRESSED)]);
        for &node in &base {
            for (component, factor) in [&along, &up].into_iter().enumerate() {
                block.supports.push(NodalValue {
                    node,
                    component,
                    value: 1.0,
                    factor: factor.clone(),
                });
            }
        }
        block.contact_rule = ContactRule::new(ContactLocation::Points, 6);
        block.contact_compliance = CONTACT_COMPLIANCE;
        block.friction_coefficient = FRICTION;
        block.friction_compliance = FRICTION_COMPLIANCE;
        block.upper_tool = Some(fixed(punch(RADIUS, SIZE, RADIUS)));
        petsc::options::set(ORDERING, "nd")?;
        petsc::options::set(SOLVER, "petsc")?;
        // Rounding counts 1/(1 - 2ν) times here.
        let statics = Statics::new(world, block, Touching::Innermost, 2e-9)?;
        petsc::options::clear(ORDERING)?;
        petsc::options::clear(SOLVER)?;
        Ok(Self { statics, base })
    }

    /// Steps from one whole time to another.
    fn advance(&mut self, from: f64, to: f64, steps: u32) -> Result<()> {
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            self.statics.advance(from + (to - from) * share)?;
        }
        Ok(())
    }

    /// Shearing and pressing force of the base, N per mm.
    fn forces(&self) -> Result<[f64; 2]> {
        let all = self.statics.internal_forces()?;
        Ok([0, 1].map(|k| self.base.iter().map(|&node| all[node][k]).sum()))
    }
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

fn mean(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

fn sheared(world: &SimpleCommunicator) -> Result<Answer> {
    let constants = Constants {
        poisson: 0.4999,
        ..Constants::elastic()
    };
    let modulus = constants.plane_modulus();
    let mut means = Vec::new();
    let mut rows = Vec::new();
    let mut pictures = Vec::new();
    for edge in EDGES {
        let mut block = Block::new(world, &constants, edge)?;
        block.advance(0.0, 1.0, STEPS[0])?;
        let pressed = block.forces()?[1];
        block.advance(1.0, 2.0, STEPS[1])?;
        let [most, force] = block.forces()?;
        let theory = Theory::new(modulus, [most, force], None);
        let points = block.statics.contacts()?;
        means.push(mean(&theory.errors(&points, 0.0)));
        if edge > EDGES[1] {
            continue;
        }
        let stick = theory.layers[1][1];
        let limit = FRICTION * theory.peak;
        let tolerance = 0.01 / FRICTION + FRICTION_COMPLIANCE * modulus / theory.half_width;
        let missing: Vec<[f64; 2]> = points
            .iter()
            .map(|p| [p.reference[0], FRICTION * p.pressure - p.friction])
            .filter(|[x, _]| x.abs() < stick - 2.0 * edge)
            .collect();
        let [depth, width] = ellipse(&missing);
        let sticking = points.iter().filter(|p| p.state == ContactState::Stick);
        let last = sticking.map(|p| p.reference[0].abs()).fold(0.0, f64::max);
        let over = most / (FRICTION * force);
        rows.extend([
            Row::relative(
                "P while sheared over P before",
                force / pressed,
                1.0,
                1e-3,
                "no coupling",
            ),
            Row::relative(
                format!("half width of the stick zone at Q = {over:.3} μ P, fitted, mm"),
                width,
                stick,
                5e-3,
                SOURCE,
            ),
            Row::relative(
                "traction missing to μ p in the middle, fitted, MPa",
                depth,
                limit * stick / theory.half_width,
                5e-3,
                SOURCE,
            ),
            Row::absolute("last point that sticks, mm", last, stick, edge, SOURCE),
            Row::absolute(
                "largest error of a traction over μ p₀, two edges off the ends",
                largest(&theory.errors(&points, 2.0 * edge)),
                0.0,
                tolerance,
                SOURCE,
            ),
        ]);
        pictures.push((
            "verification-mindlin",
            "Friction against the distance from the middle",
            chart(&theory, &points).svg()?,
        ));
        for (from, to) in [(2.0, 3.0), (3.0, 4.0)] {
            block.advance(from, to, STEPS[1])?;
            let [shear, force] = block.forces()?;
            let theory = Theory::new(modulus, [shear, force], Some(most));
            let over = shear / (FRICTION * force);
            rows.push(Row::absolute(
                format!("the same on the way back, at Q = {over:.3} μ P"),
                largest(&theory.errors(&block.statics.contacts()?, 2.0 * edge)),
                0.0,
                tolerance,
                BACK,
            ));
        }
    }
    rows.push(Row::absolute(
        format!(
            "order of the mean error of all tractions (mean error {:.1e})",
            means[1]
        ),
        (means[0] / means[1]).log2(),
        0.75,
        0.25,
        "√h over a length h at the ends of the zones",
    ));
    Ok(Answer { rows, pictures })
}

fn chart<'a>(theory: &Theory, points: &[Touch]) -> Chart<'a> {
    let a = theory.half_width;
    let dots = points
        .iter()
        .filter(|p| (0.0..1.2 * a).contains(&p.reference[0]));
    Chart {
        title: "Cylinder pressed and sheared: friction on the contact",
        x_label: "distance from the middle over the half width",
        y_label: "traction over μ p₀",
        end: [1.2, 1.0],
        tick: [0.2, 0.2],
        curve: (
            "Cattaneo and Mindlin",
            (0..=600)
                .map(|i| 1.2 * f64::from(i) / 600.0)
                .map(|x| [x, theory.traction(x * a)])
                .collect(),
        ),
        dots: (
            "contact points",
            dots.map(|p| [p.reference[0] / a, p.friction / (FRICTION * theory.peak)])
                .collect(),
        ),
    }
}
