//! Where the contact points of an edge are, and what share of the edge each stands for.

use crate::element::edge_shape;

/// Where contact is looked for on the edges of the sheet's faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLocation {
    /// At equally spaced points of each edge.
    Points,
    /// At the nodes, as in code_aster's discrete formulation.
    Nodes,
    /// Where the edge is closest to the tool: one point per edge that moves along it.
    Closest,
}

/// Contact points of every edge of a face.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactRule {
    /// The same fixed points on every edge.
    Points(Vec<ContactSample>),
    /// The nodes: each edge has its left end and its middle, the last one also its right end.
    Nodes,
    /// One moving point.
    Closest,
}

/// One contact point of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Edge shape functions at the point (a moving one: at its middle position): left end, right end,
    /// middle.
    pub shape: [f64; 3],
    /// Length it stands for as a share of the edge's; the shares of a face add up to its edges.
    pub weight: f64,
    /// Whether it moves to where the edge is closest to the tool.
    pub moves: bool,
}

impl ContactRule {
    /// The rule for `location`, with `count` points per edge where that is a choice.
    pub fn new(location: ContactLocation, count: usize) -> Self {
        match location {
            ContactLocation::Points => Self::Points(equally_spaced(count)),
            ContactLocation::Nodes => Self::Nodes,
            ContactLocation::Closest => Self::Closest,
        }
    }

    /// The points that belong to an edge of a face of equal edges; `first` and `last` tell whether it
    /// is the face's leftmost or rightmost one.
    ///
    /// A node stands for the length that a uniform pressure's consistent force gives it (1/6, 4/6 and
    /// 1/6 of an edge, corners summed over both edges): so nodal contact, too, passes the contact
    /// patch test, with the same compliance everywhere.
    pub fn samples(&self, first: bool, last: bool) -> Vec<ContactSample> {
        let at = |xi: f64, weight: f64| ContactSample {
            shape: edge_shape(xi),
            weight,
            moves: *self == Self::Closest,
        };
        match self {
            Self::Points(samples) => samples.clone(),
            Self::Nodes => {
                let left = if first { 1.0 / 6.0 } else { 1.0 / 3.0 };
                let mut samples = vec![at(-1.0, left), at(0.0, 2.0 / 3.0)];
                if last {
                    samples.push(at(1.0, 1.0 / 6.0));
                }
                samples
            }
            Self::Closest => vec![at(0.0, 1.0)],
        }
    }
}

/// `count` equally spaced points, each in the middle of its piece of the edge, so that the spacing
/// goes on unbroken from edge to edge. From three points on the weights integrate quadratic
/// functions exactly: a uniform pressure gives the consistent nodal forces and so passes the
/// contact patch test.
fn equally_spaced(count: usize) -> Vec<ContactSample> {
    let n = count as f64;
    let xi = |i: usize| (2.0 * i as f64 + 1.0) / n - 1.0;
    let squares: Vec<f64> = (0..count).map(|i| xi(i).powi(2)).collect();
    let mean = squares.iter().sum::<f64>() / n;
    let variance = squares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / n;
    let correction = if count >= 3 {
        (1.0 / 3.0 - mean) / variance
    } else {
        0.0
    };
    (0..count)
        .map(|i| ContactSample {
            shape: edge_shape(xi(i)),
            weight: (1.0 + correction * (squares[i] - mean)) / n,
            moves: false,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forces of a uniform pressure of one at the nodes of a face of `edges` edges of length one.
    fn nodal_forces(rule: &ContactRule, edges: usize) -> Vec<f64> {
        let mut forces = vec![0.0; 2 * edges + 1];
        for edge in 0..edges {
            for sample in rule.samples(edge == 0, edge + 1 == edges) {
                assert!(sample.weight > 0.0);
                for (node, n) in [2 * edge, 2 * edge + 2, 2 * edge + 1]
                    .into_iter()
                    .zip(sample.shape)
                {
                    forces[node] += sample.weight * n;
                }
            }
        }
        forces
    }

    #[test]
    fn a_uniform_pressure_gives_the_consistent_nodal_forces() {
        let points = (3..=24).map(|count| ContactRule::new(ContactLocation::Points, count));
        for rule in points.chain([ContactRule::Nodes]) {
            let forces = nodal_forces(&rule, 3);
            let [end, middle, corner] = [1.0 / 6.0, 2.0 / 3.0, 1.0 / 3.0];
            let exact = [end, middle, corner, middle, corner, middle, end];
            for (force, exact) in forces.iter().zip(exact) {
                assert!((force - exact).abs() < 1e-14, "{rule:?}: {forces:?}");
            }
        }
    }
}
