//! Problems without the benchmark's tools, solved statically.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::rc::Rc;
use std::sync::Arc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Vector;
use ssnp155::contact::{ContactLocation, ContactRule, ContactState};
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;
use ssnp155::ranks::gather_lists;
use ssnp155::run::StaticPath;
use ssnp155::system::{
    ContactPointSample, Factor, History, Measures, NodalValue, Problem, System, Tool,
};
use ssnp155::tool::{Motion, Piece, Profile};

use crate::flow::Constants;
use crate::row::Result;

/// A problem without supports, loads, tools and density.
pub fn problem(mesh: SheetMesh, constants: &Constants, quadrature: Quadrature) -> Problem {
    Problem {
        mesh,
        material: constants.material(),
        young_modulus: constants.young,
        density: 0.0,
        quadrature,
        supports: Vec::new(),
        loads: Vec::new(),
        contact_rule: ContactRule::new(ContactLocation::Points, 1),
        contact_compliance: 0.0,
        friction_coefficient: 0.0,
        friction_compliance: 0.0,
        lower_tool: None,
        upper_tool: None,
        whole_sheet: 1.0,
    }
}

/// Gives the problem `points` contact points per edge and the tool `lower` below.
pub fn rest_on(problem: &mut Problem, lower: Profile, points: usize) {
    problem.contact_rule = ContactRule::new(ContactLocation::Points, points);
    problem.lower_tool = Some(fixed(lower));
}

/// A tool that does not move.
pub fn fixed(profile: Profile) -> Arc<Tool> {
    let motion = Motion::Fixed;
    Arc::new(Tool { profile, motion })
}

/// The horizontal line at height `y`, free above.
pub fn flat(y: f64) -> Profile {
    Profile::new(vec![Piece::Segment {
        start: [-1.0, y],
        end: [1.0, y],
    }])
    .expect("one piece is a chain")
}

/// A drum of `radius` around the origin, free outside; its open part points down.
pub fn drum(radius: f64) -> Profile {
    Profile::new(vec![Piece::Arc {
        centre: [0.0, 0.0],
        radius,
        from: 1.4 * PI,
        to: -0.4 * PI,
    }])
    .expect("one piece is a chain")
}

/// A factor equal to time.
pub fn with_time() -> Factor {
    Factor(vec![(0.0, 0.0), (1e9, 1e9)])
}

/// A prescribed displacement or load that grows with time.
pub fn growing(node: usize, component: usize, value: f64) -> NodalValue {
    NodalValue {
        node,
        component,
        value,
        factor: with_time(),
    }
}

/// A displacement held at zero.
pub fn held(node: usize, component: usize) -> NodalValue {
    NodalValue {
        node,
        component,
        value: 0.0,
        factor: Factor(Vec::new()),
    }
}

/// Nodes at which `on` holds.
pub fn nodes_where(mesh: &SheetMesh, on: impl Fn([f64; 2]) -> bool) -> Vec<usize> {
    (0..mesh.nodes.len())
        .filter(|&n| on(mesh.nodes[n]))
        .collect()
}

/// Sides of the rectangle an undistorted mesh covers, as edges of left, right and middle node.
pub fn side_edges(mesh: &SheetMesh, side: Side) -> Vec<[usize; 3]> {
    let (nx, ny) = (mesh.nx, mesh.ny);
    let (elements, [a, b, mid]): (Vec<usize>, [usize; 3]) = match side {
        Side::Left => ((0..ny).map(|j| j * nx).collect(), [0, 3, 7]),
        Side::Right => ((0..ny).map(|j| j * nx + nx - 1).collect(), [1, 2, 5]),
        Side::Top => (((ny - 1) * nx..ny * nx).collect(), [3, 2, 6]),
    };
    elements
        .into_iter()
        .map(|e| [a, b, mid].map(|local| mesh.elements[e][local]))
        .collect()
}

/// A side of the mesh.
#[derive(Clone, Copy)]
pub enum Side {
    Left,
    Right,
    Top,
}

/// Consistent nodal loads of a dead traction (N per mm of width and mm of edge) on a side with straight edges.
pub fn traction(
    mesh: &SheetMesh,
    side: Side,
    value: impl Fn([f64; 2]) -> [f64; 2],
    factor: &Factor,
) -> Vec<NodalValue> {
    let mut loads = Vec::new();
    for edge in side_edges(mesh, side) {
        let x = edge.map(|n| mesh.nodes[n]);
        let length = (x[1][0] - x[0][0]).hypot(x[1][1] - x[0][1]);
        for (xi, weight) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let n = ssnp155::element::edge_shape(xi);
            let at = [0, 1].map(|k| (0..3).map(|a| n[a] * x[a][k]).sum());
            let t = value(at);
            for (a, &node) in edge.iter().enumerate() {
                for (component, t) in t.into_iter().enumerate() {
                    loads.push(NodalValue {
                        node,
                        component,
                        value: t * n[a] * 0.5 * length * weight / 9.0,
                        factor: factor.clone(),
                    });
                }
            }
        }
    }
    loads
}

/// How contact points start.
#[derive(Clone, Copy)]
pub enum Touching {
    /// All closed points carry.
    All,
    /// Of the closed points, the one with the smallest x.
    Innermost,
}

/// What is asked of a contact point.
#[derive(Clone, Copy)]
pub struct Touch {
    /// Where it lies on the undeformed body, mm.
    pub reference: [f64; 2],
    /// Contact pressure, MPa.
    pub pressure: f64,
    /// Distance to the tool, mm.
    pub gap: f64,
    /// Friction traction, MPa.
    pub friction: f64,
    /// Whether it carries a force and slips.
    pub state: ContactState,
}

/// A static solution, time by time, on one rank or several: everything asked of it is gathered, the same on every rank.
pub struct Statics {
    pub system: Rc<System>,
    pub path: StaticPath,
    time: f64,
}

impl Statics {
    /// Starts from rest. `tolerance`: norm of the residual of a converged solve, mm.
    pub fn new(
        world: &SimpleCommunicator,
        problem: Problem,
        touching: Touching,
        tolerance: f64,
    ) -> Result<Self> {
        petsc::options::set("snes_atol", &tolerance.to_string())?;
        let system = Rc::new(System::new(problem, world.duplicate())?);
        let start = start_unknowns(&system, touching)?;
        Ok(Self {
            path: StaticPath::new(Rc::clone(&system), History::virgin(system.local()), start)?,
            system,
            time: 0.0,
        })
    }

    /// Solves at time `t`; the case fails if that fails.
    pub fn advance(&mut self, t: f64) -> Result<()> {
        let reason = self.path.advance(t)?;
        self.time = t;
        if reason.is_converged() {
            Ok(())
        } else {
            Err(format!("no solution at t = {t}: {reason:?}").into())
        }
    }

    /// Displacements node by node, in the order of the mesh.
    pub fn values(&self) -> Result<Vec<f64>> {
        let values = self.system.local_values(self.path.unknowns())?;
        let pairs = values.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        Ok(self.gathered(pairs, |_, other| other).concat())
    }

    /// Displacement of a node.
    pub fn displacement(&self, node: usize) -> Result<[f64; 2]> {
        let values = self.values()?;
        Ok([values[2 * node], values[2 * node + 1]])
    }

    /// Internal force at every node, N per mm of width.
    pub fn internal_forces(&self) -> Result<Vec<[f64; 2]>> {
        let values = self.system.local_values(self.path.unknowns())?;
        let mut forces = vec![0.0; values.len()];
        let local = self.system.local();
        local.add_internal_forces(&self.path.history(), &values, None, &mut forces)?;
        let young = local.problem().young_modulus;
        let pairs = forces.chunks_exact(2).map(|f| [young * f[0], young * f[1]]);
        // A node between two ranks has a share on each.
        Ok(self.gathered(pairs, |sum, share| [sum[0] + share[0], sum[1] + share[1]]))
    }

    /// Cauchy stress xx, yy, zz, xy at every node, MPa.
    pub fn stresses(&self) -> Result<Vec<[f64; 4]>> {
        let values = self.system.local_values(self.path.unknowns())?;
        let history = self.path.history();
        let samples = self.system.node_samples(&history, self.time, &values)?;
        Ok(self.gathered(samples.iter().map(|s| s.stress), |_, other| other))
    }

    /// What the ranks know of their nodes, node by node in the order of the mesh; where several know of a node, `join`ed
    /// from zero on.
    fn gathered<const N: usize>(
        &self,
        mine: impl Iterator<Item = [f64; N]>,
        join: impl Fn([f64; N], [f64; N]) -> [f64; N],
    ) -> Vec<[f64; N]> {
        let local = self.system.local();
        let places = local.node_coordinates().iter();
        let packed: Vec<f64> = places
            .zip(mine)
            .flat_map(|(place, value)| place.iter().copied().chain(value).collect::<Vec<_>>())
            .collect();
        let mesh = &local.problem().mesh;
        // The ranks' coordinates are copies of the mesh's, so they agree to the last bit.
        let bits = |x: &[f64]| [x[0].to_bits(), x[1].to_bits()];
        let numbers: HashMap<[u64; 2], usize> =
            mesh.nodes.iter().map(|x| bits(x)).zip(0..).collect();
        let mut values = vec![[0.0; N]; mesh.nodes.len()];
        for entry in gather_lists(self.system.comm(), &packed).chunks_exact(2 + N) {
            let value = &mut values[numbers[&bits(entry)]];
            *value = join(*value, std::array::from_fn(|k| entry[2 + k]));
        }
        values
    }

    /// The contact points, by their place along the body.
    pub fn contacts(&self) -> Result<Vec<Touch>> {
        let values = self.system.local_values(self.path.unknowns())?;
        let history = self.path.history();
        let local = self.system.local();
        let points = local.contact_points(&history, self.time, &values);
        let packed: Vec<f64> = points.iter().flat_map(pack).collect();
        let all = gather_lists(self.system.comm(), &packed);
        let mut all: Vec<Touch> = all.chunks_exact(PACKED).map(unpack).collect();
        all.sort_by(|a, b| {
            let [along, up] = [0, 1].map(|k| a.reference[k].total_cmp(&b.reference[k]));
            along.then(up)
        });
        Ok(all)
    }

    pub fn measures(&self) -> Result<Measures> {
        let (history, unknowns) = (self.path.history(), self.path.unknowns());
        Ok(self.system.measures(&history, self.time, unknowns, None)?)
    }
}

/// Numbers a contact point is packed into for a message.
const PACKED: usize = 6;

fn pack(point: &ContactPointSample) -> [f64; PACKED] {
    let [x, y] = point.reference;
    let state = f64::from(point.state.code());
    [x, y, point.pressure, point.gap, point.friction, state]
}

fn unpack(numbers: &[f64]) -> Touch {
    const STATES: [ContactState; 4] = [
        ContactState::Open,
        ContactState::Stick,
        ContactState::SlipForward,
        ContactState::SlipBackward,
    ];
    let [x, y, pressure, gap, friction, code] = std::array::from_fn(|k| numbers[k]);
    let state = STATES
        .into_iter()
        .find(|state| f64::from(state.code()) == code);
    Touch {
        reference: [x, y],
        pressure,
        gap,
        friction,
        state: state.expect("a state has its code"),
    }
}

/// Rest, with the gaps there are.
pub fn start_unknowns(system: &System, touching: Touching) -> Result<Vector> {
    /// A multiplier that says that a point carries, mm.
    const CARRIES: f64 = 1e-9;
    let mut unknowns = system.vector()?;
    unknowns.set_all(0.0)?;
    let local = system.local();
    let still = vec![0.0; local.unknown_count()];
    let points = local.contact_points(&History::virgin(local), 0.0, &still);
    let closed = |point: &ContactPointSample| point.gap < 1e-6;
    let of_mine = points
        .iter()
        .filter(|point| closed(point))
        .map(|point| point.reference[0])
        .fold(f64::INFINITY, f64::min);
    let of_all = gather_lists(system.comm(), &[of_mine]);
    let innermost = of_all.into_iter().fold(f64::INFINITY, f64::min);
    let first = system.owned_displacements();
    let mut write = unknowns.write()?;
    for (k, point) in points.iter().enumerate() {
        let carries = match touching {
            Touching::All => closed(point),
            Touching::Innermost => closed(point) && point.reference[0] <= innermost,
        };
        write[first + 2 * k] = if carries { CARRIES } else { 0.0 };
        write[first + 2 * k + 1] = if closed(point) { 0.0 } else { point.gap };
    }
    drop(write);
    Ok(unknowns)
}
