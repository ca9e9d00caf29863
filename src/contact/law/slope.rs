//! How the equations of a contact point move with a parameter of the problem, along with the nodes of its edge, its
//! multiplier and what it remembers. A closed gap stays closed.

use super::{ContactLaw, PointPosition};
use crate::contact::{FrictionState, Traction};
use crate::plane::{Vector, dot, interpolate};
use crate::tool::{Distance, DistanceSlope, Profile, ProfileSlope};

/// Derivatives of the constants of a contact point by a parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLawSlope {
    compliance: f64,
    coefficient: f64,
    friction_compliance: f64,
}

/// A contact point at converged unknowns.
pub struct ContactAt<'a> {
    /// Its tool.
    pub tool: &'a Profile,
    /// Where it is.
    pub position: &'a PointPosition,
    /// Its multiplier, mm.
    pub multiplier: f64,
    /// Its friction.
    pub traction: &'a Traction,
    /// What it remembered before.
    pub before: &'a FrictionState,
}

/// What moves with the parameter, per unit of it.
pub struct ContactMotion<'a> {
    /// Of the current positions of the edge's nodes, mm.
    pub nodes: [Vector; 3],
    /// Of the multiplier, mm.
    pub multiplier: f64,
    /// Of the tool, if it moves.
    pub tool: Option<&'a ProfileSlope>,
    /// Of the constants.
    pub law: &'a ContactLawSlope,
    /// Of what it remembered before, number for number.
    pub before: &'a FrictionState,
}

/// Derivatives of the rows of a contact point and of what it remembers.
#[derive(Clone, Copy, Debug)]
pub struct ContactSlope {
    /// Of the equilibrium rows.
    pub force: [f64; 6],
    /// Of the closure row.
    pub closure: f64,
    /// The force on the sheet divided by Young's modulus, and its derivative, mm.
    pub load: [Vector; 2],
    /// Of the state if the step is accepted, number for number.
    pub state: FrictionState,
}

impl ContactLawSlope {
    /// From the constants with more and with less of the parameter, `width` of it apart.
    pub fn between(above: &ContactLaw, below: &ContactLaw, width: f64) -> Self {
        let by = |of: fn(&ContactLaw) -> f64| (of(above) - of(below)) / width;
        Self {
            compliance: by(|law| law.compliance),
            coefficient: by(|law| law.friction.map_or(0.0, |friction| friction.coefficient)),
            friction_compliance: by(|law| law.friction.map_or(0.0, |friction| friction.compliance)),
        }
    }
}

impl ContactLaw {
    /// Derivatives of [`ContactLaw::rows`], and of the next state.
    pub fn slope(&self, at: &ContactAt<'_>, motion: &ContactMotion<'_>) -> ContactSlope {
        let PointPosition {
            distance,
            shape,
            drift,
            ..
        } = at.position;
        let by_tool = tool_slope(at.tool, distance, motion.tool);
        let mut x = interpolate(*shape, &motion.nodes);
        // By the envelope theorem the distance of a moving point knows nothing of its way along the edge.
        let value = dot(distance.gradient, x) + by_tool.value;
        let (mut along, mut shape_slope) = (0.0, [0.0; 3]);
        if let Some(drift) = drift {
            let by_nodes = drift.by_u.iter().zip(motion.nodes.as_flattened());
            along = by_nodes.map(|(by, moved)| by * moved).sum::<f64>()
                - dot(by_tool.gradient, drift.x_slope) / drift.curvature;
            x = [0, 1].map(|k| x[k] + along * drift.x_slope[k]);
            shape_slope = drift.shape_slope.map(|slope| along * slope);
        }
        let moved = moved_distance(distance, x, value, &by_tool);
        let slip = moved.arc_length - self.arc_length_before(at, motion, along);
        let traction = self.traction_slope(at, motion, slip);
        let load = |multiplier: f64, normal: Vector, traction: f64, along: Vector| -> Vector {
            [0, 1].map(|k| multiplier * normal[k] + traction * along[k])
        };
        let (normal, tangent) = (distance.gradient, distance.arc_gradient);
        let force = load(at.multiplier, normal, at.traction.value, tangent);
        let carried = load(motion.multiplier, normal, traction, tangent);
        let turned = load(
            at.multiplier,
            moved.gradient,
            at.traction.value,
            moved.arc_gradient,
        );
        let by_force = [0, 1].map(|k| carried[k] + turned[k]);
        ContactSlope {
            force: std::array::from_fn(|i| {
                -(shape[i / 2] * by_force[i % 2] + shape_slope[i / 2] * force[i % 2])
            }),
            closure: value
                + motion.law.compliance * at.multiplier
                + self.compliance * motion.multiplier,
            load: [force, by_force],
            state: FrictionState {
                traction,
                arc_length: moved.arc_length,
                nodes: motion.nodes,
            },
        }
    }

    /// Of the arc length that the point of the sheet had before, where a moving point moves `along` its edge.
    fn arc_length_before(&self, at: &ContactAt<'_>, motion: &ContactMotion<'_>, along: f64) -> f64 {
        if self.moves_on.is_none() || self.friction.is_none() {
            return motion.before.arc_length;
        }
        let before = &at.before.nodes;
        let distance = at.tool.distance(interpolate(at.position.shape, before));
        let mut x = interpolate(at.position.shape, &motion.before.nodes);
        if let Some(drift) = &at.position.drift {
            let slope = interpolate(drift.shape_slope, before);
            x = [0, 1].map(|k| x[k] + along * slope[k]);
        }
        let by_tool = tool_slope(at.tool, &distance, motion.tool);
        dot(distance.arc_gradient, x) + by_tool.arc_length
    }

    /// Of the friction force, with the derivative of the slip.
    fn traction_slope(&self, at: &ContactAt<'_>, motion: &ContactMotion<'_>, slip: f64) -> f64 {
        let traction = at.traction;
        let Some(friction) = self.friction else {
            return 0.0;
        };
        if traction.by_arc_length != 0.0 {
            // It sticks: λ_t = λ_tn - slip / ε_t, and the slope is -1/ε_t.
            let softer = motion.law.friction_compliance * traction.by_arc_length * at.position.slip;
            motion.before.traction + traction.by_arc_length * (slip + softer)
        } else {
            let rougher = motion.law.coefficient / friction.coefficient;
            traction.by_multiplier * motion.multiplier + rougher * traction.value
        }
    }
}

/// Of the distance to a tool that may move, from a point that stays.
fn tool_slope(tool: &Profile, at: &Distance, by: Option<&ProfileSlope>) -> DistanceSlope {
    by.map_or_else(DistanceSlope::default, |by| tool.distance_slope(at, by))
}

/// Of the distance from a point that moves by `x`, where its value has this derivative.
fn moved_distance(at: &Distance, x: Vector, value: f64, by_tool: &DistanceSlope) -> DistanceSlope {
    let sum = |a: Vector, b: Vector| [a[0] + b[0], a[1] + b[1]];
    DistanceSlope {
        value,
        gradient: sum(at.hessian.times(x), by_tool.gradient),
        arc_length: dot(at.arc_gradient, x) + by_tool.arc_length,
        arc_gradient: sum(at.arc_hessian.times(x), by_tool.arc_gradient),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Friction;
    use crate::element::edge_shape;
    use crate::tool::die;

    /// Everything that moves, at this distance along its direction.
    struct Beside {
        tool: Profile,
        law: ContactLaw,
        nodes: [Vector; 3],
        multiplier: f64,
        before: FrictionState,
    }

    fn beside(slip: Option<f64>, moves: bool, by: f64) -> Beside {
        let nodes = [
            [26.25 + by, -1.1],
            [26.65, -0.77 + 0.4 * by],
            [26.45 + 0.3 * by, -0.931 - by],
        ];
        let slip = slip.map(|slip| {
            (
                slip,
                Friction {
                    coefficient: 0.2 + 0.1 * by,
                    compliance: 120.0 + 30.0 * by,
                },
            )
        });
        let start = [[26.25, -1.1], [26.65, -0.77], [26.45, -0.931]];
        let at_rest = die(25.0, 4.0, 60.0)
            .distance(interpolate(edge_shape(0.3), &start))
            .arc_length();
        let (back, friction) = slip.map_or((0.0, None), |(slip, friction)| (slip, Some(friction)));
        Beside {
            tool: die(25.0 + by, 4.0 + 0.5 * by, 60.0),
            law: ContactLaw {
                shape: edge_shape(0.3),
                compliance: 12.0 + 5.0 * by,
                moves_on: moves.then_some(0.8),
                friction,
            },
            nodes,
            multiplier: 3e-4 + 0.01 * by,
            before: FrictionState {
                traction: 1e-5 + 2e-3 * by,
                arc_length: at_rest - back + 0.7 * by,
                nodes: nodes.map(|[x, y]| {
                    [
                        x - 0.7 * back + 0.01 * (x - 26.4) + 2.0 * by,
                        y - 0.7 * back - by,
                    ]
                }),
            },
        }
    }

    #[test]
    fn slopes_agree_with_central_differences() {
        for slip in [None, Some(0.0), Some(0.9), Some(-0.9)] {
            for moves in [false, true] {
                slope_agrees(slip, moves);
            }
        }
    }

    fn slope_agrees(slip: Option<f64>, moves: bool) {
        let h = 1e-6;
        let [here, above, below] = [0.0, h, -h].map(|by| beside(slip, moves, by));
        let evaluate = |at: &Beside| {
            let position = at.law.position(&at.nodes, &at.tool, [0.0; 2], &at.before);
            let traction = at.law.traction(&position, at.multiplier, &at.before);
            let rows = at.law.rows(&position, at.multiplier, 0.0, &traction);
            (position, traction, rows)
        };
        let [(position, traction, _), more, less] = [&here, &above, &below].map(evaluate);
        assert_eq!(traction.by_arc_length != 0.0, slip == Some(0.0));
        assert_eq!(
            traction.by_multiplier != 0.0,
            slip.is_some_and(|slip| slip != 0.0)
        );
        assert_eq!(position.drift.is_some(), moves);
        let difference = |a: f64, b: f64| (a - b) / (2.0 * h);
        let of_nodes = |a: [Vector; 3], b: [Vector; 3]| -> [Vector; 3] {
            std::array::from_fn(|i| [0, 1].map(|k| difference(a[i][k], b[i][k])))
        };
        let before = FrictionState {
            traction: 2e-3,
            arc_length: 0.7,
            nodes: of_nodes(above.before.nodes, below.before.nodes),
        };
        let at = ContactAt {
            tool: &here.tool,
            position: &position,
            multiplier: here.multiplier,
            traction: &traction,
            before: &here.before,
        };
        let moved_tool = ProfileSlope::between(&above.tool, &below.tool, 2.0 * h);
        let motion = ContactMotion {
            nodes: of_nodes(above.nodes, below.nodes),
            multiplier: 0.01,
            tool: moved_tool.as_ref(),
            law: &ContactLawSlope::between(&above.law, &below.law, 2.0 * h),
            before: &before,
        };
        let exact = here.law.slope(&at, &motion);
        let close = |exact: f64, above: f64, below: f64, what: &str| {
            let difference = difference(above, below);
            assert!(
                (exact - difference).abs() < 1e-7 * (1.0 + exact.abs()),
                "{slip:?} {moves} {what}: {exact} {difference}"
            );
        };
        for i in 0..6 {
            close(exact.force[i], more.2.force[i], less.2.force[i], "force");
        }
        close(exact.closure, more.2.closure, less.2.closure, "closure");
        close(exact.state.traction, more.1.value, less.1.value, "traction");
        let [a, b] = [&more, &less].map(|of| of.0.distance.arc_length());
        close(exact.state.arc_length, a, b, "arc length");
    }
}
