//! Where the contact points of an edge are, and what share of the edge each stands for.

use crate::element::edge_shape;

/// One contact point of the reference edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Edge shape functions at the point: left end, right end, middle.
    pub shape: [f64; 3],
    /// Share of the edge's length; the shares of an edge add up to one.
    pub weight: f64,
}

/// `count` equally spaced points, each in the middle of its piece of the edge, so that the spacing
/// goes on unbroken from edge to edge. From three points on the weights integrate quadratic
/// functions exactly: a uniform pressure gives the consistent nodal forces and so passes the
/// contact patch test.
pub fn contact_rule(count: usize) -> Vec<ContactSample> {
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
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uniform_pressure_gives_the_consistent_nodal_forces() {
        for count in 3..=24 {
            let mut forces = [0.0; 3];
            for sample in contact_rule(count) {
                assert!(sample.weight > 0.0);
                for (force, n) in forces.iter_mut().zip(sample.shape) {
                    *force += sample.weight * n;
                }
            }
            for (force, exact) in forces.iter().zip([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) {
                assert!((force - exact).abs() < 1e-14, "{count} points: {forces:?}");
            }
        }
    }
}
