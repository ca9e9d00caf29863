//! A beam bent over two rounded edges: the moment-curvature integral and the equilibrium of a heavily bent beam.
//!
//! In plane strain the moment of a strip is M(κ) = ∫ σ(κ y) y dy with σ from rates that are integrated independently of the
//! program (Marciniak, Duncan and Hu 2002, Mechanics of Sheet Metal Forming, chapter 6). Without friction an edge pushes the
//! sheet at right angles, so in the frame of the arm, with the contact as its origin, M = P ξ all the way to the nose: the
//! curvature follows, and with it the whole shape (the elastica, with another law of bending). The arm turns back by
//! ∫ M/(E' I) ds when the force goes away.

#[allow(dead_code)]
#[path = "../verification/flow.rs"]
mod flow;

use flow::Constants;

const THICKNESS: f64 = 1.0;
const WIDTH: f64 = 30.0;
/// Largest curvature of the table, 1/mm, and its entries.
const MOST_CURVATURE: f64 = 0.4;
const ENTRIES: usize = 800;
const FIBRES: usize = 200;
/// Step along the beam, mm.
const STEP: f64 = 0.01;

/// Bending over edges of one radius.
pub struct Bending {
    /// Centre of the edge's rounding: x, and how far below the die's top, mm; the latter is its radius.
    centre: f64,
    radius: f64,
    /// Moments per width (N) of curvatures from 0 to the largest.
    moments: Vec<f64>,
    stiffness: f64,
}

/// A bent sheet.
pub struct Bent {
    /// Stroke of the punch, mm.
    pub stroke: f64,
    /// Force of the whole sheet, N.
    pub force: f64,
    /// Angle between the arms, degrees, and after release.
    pub angle: f64,
    pub released: f64,
}

/// A beam from the edge inwards until it is level.
struct Shape {
    along: f64,
    aside: f64,
    spring: f64,
}

impl Bending {
    pub fn new(centre: f64, radius: f64) -> Self {
        let constants = Constants::aluminium();
        let height = |k: usize| 0.5 * THICKNESS * (k as f64 + 0.5) / FIBRES as f64;
        // One curve of stress and strain, fine enough for a straight line between its points.
        let largest = MOST_CURVATURE * 0.5 * THICKNESS;
        let strains: Vec<f64> = (0..=4000)
            .map(|k| largest * f64::from(k) / 4000.0)
            .collect();
        let stresses: Vec<f64> = constants
            .plane_strain_tension(&strains, 1e-4)
            .iter()
            .map(|s| s[0])
            .collect();
        let moment = |entry: usize| {
            let curvature = MOST_CURVATURE * entry as f64 / ENTRIES as f64;
            let fibre = |k: usize| between(&stresses, curvature * height(k) / largest) * height(k);
            2.0 * (0..FIBRES).map(fibre).sum::<f64>() * 0.5 * THICKNESS / FIBRES as f64
        };
        Self {
            centre,
            radius,
            moments: (0..=ENTRIES).map(moment).collect(),
            stiffness: constants.plane_modulus() * THICKNESS.powi(3) / 12.0,
        }
    }

    fn curvature(&self, moment: f64) -> f64 {
        let after = self
            .moments
            .partition_point(|&m| m < moment)
            .clamp(1, ENTRIES);
        let [low, high] = [self.moments[after - 1], self.moments[after]];
        let entry = (after - 1) as f64 + (moment - low) / (high - low);
        MOST_CURVATURE * entry / ENTRIES as f64
    }

    /// With the edge's force per width (N/mm) and the angle of the arm; none if the beam is not level within reach.
    fn shape(&self, force: f64, arm: f64) -> Option<Shape> {
        let mut shape = Shape {
            along: 0.0,
            aside: 0.0,
            spring: 0.0,
        };
        let mut turned = 0.0;
        while turned < arm {
            if shape.along > 3.0 * self.centre {
                return None;
            }
            // The midpoint rule.
            let middle = shape.along + 0.5 * STEP * f64::cos(turned);
            let curvature = self.curvature(force * middle);
            let step = STEP.min((arm - turned) / curvature.max(1e-12));
            let direction = turned + 0.5 * step * curvature;
            shape.along += step * direction.cos();
            shape.aside += step * direction.sin();
            shape.spring += step * force * middle / self.stiffness;
            turned += step * curvature;
            if step < STEP {
                break;
            }
        }
        Some(shape)
    }

    /// The sheet whose arms are at this angle (radians) to the level.
    pub fn at_arm_angle(&self, arm: f64) -> Bent {
        let (sin, cos) = arm.sin_cos();
        let radius = self.radius + 0.5 * THICKNESS;
        // Where the middle line of the sheet is above the contact.
        let contact = [self.centre - radius * sin, -self.radius + radius * cos];
        let inwards = |shape: &Shape| shape.along * cos + shape.aside * sin;
        let (mut low, mut high) = (1e-3, 1e3);
        for _ in 0..60 {
            let force = 0.5 * (low + high);
            // A larger force bends it level nearer to the edge.
            match self.shape(force, arm) {
                Some(shape) if inwards(&shape) <= contact[0] => high = force,
                _ => low = force,
            }
        }
        let shape = self
            .shape(high, arm)
            .expect("the larger force bends it level");
        let middle = contact[1] - (shape.along * sin - shape.aside * cos);
        let opening = |arm: f64| 180.0 - 2.0 * arm.to_degrees();
        Bent {
            stroke: 0.5 * THICKNESS - middle,
            force: 2.0 * high * cos * WIDTH,
            angle: opening(arm),
            released: opening(arm - shape.spring),
        }
    }

    /// Angle between the arms at a stroke (mm), and after release, degrees.
    pub fn at_stroke(&self, stroke: f64) -> (f64, f64) {
        let (mut low, mut high) = (0.01, 1.0);
        for _ in 0..40 {
            let arm = 0.5 * (low + high);
            if self.at_arm_angle(arm).stroke < stroke {
                low = arm;
            } else {
                high = arm;
            }
        }
        let bent = self.at_arm_angle(low);
        (bent.angle, bent.released)
    }
}

/// Value at this share of equally spaced points, straight between them.
fn between(points: &[f64], share: f64) -> f64 {
    let place = share * (points.len() - 1) as f64;
    let before = (place as usize).min(points.len() - 2);
    points[before] + (place - before as f64) * (points[before + 1] - points[before])
}
