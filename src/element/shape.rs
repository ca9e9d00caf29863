//! Shape functions of the eight-node serendipity quadrilateral and of its edges.

/// Reference coordinates (ξ, η) of the nodes, in VTK's order.
pub const NODES: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

/// The eight shape functions at (ξ, η).
pub fn shape([xi, eta]: [f64; 2]) -> [f64; 8] {
    std::array::from_fn(|a| {
        let [xa, ea] = NODES[a];
        let (along, across) = (1.0 + xi * xa, 1.0 + eta * ea);
        match a {
            0..=3 => 0.25 * along * across * (xi * xa + eta * ea - 1.0),
            4 | 6 => 0.5 * (1.0 - xi * xi) * across,
            _ => 0.5 * along * (1.0 - eta * eta),
        }
    })
}

/// Their derivatives with respect to ξ and η.
pub fn shape_gradients([xi, eta]: [f64; 2]) -> [[f64; 2]; 8] {
    std::array::from_fn(|a| {
        let [xa, ea] = NODES[a];
        let (along, across) = (1.0 + xi * xa, 1.0 + eta * ea);
        match a {
            0..=3 => [
                0.25 * xa * across * (2.0 * xi * xa + eta * ea),
                0.25 * ea * along * (xi * xa + 2.0 * eta * ea),
            ],
            4 | 6 => [-xi * across, 0.5 * ea * (1.0 - xi * xi)],
            _ => [0.5 * xa * (1.0 - eta * eta), -eta * along],
        }
    })
}

/// Quadratic shape functions of an edge at ξ: left end, right end, middle.
pub fn edge_shape(xi: f64) -> [f64; 3] {
    [0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi]
}

/// Their first derivatives by ξ.
pub fn edge_shape_slopes(xi: f64) -> [f64; 3] {
    [xi - 0.5, xi + 0.5, -2.0 * xi]
}

/// Their second derivatives by ξ, the same everywhere.
pub const EDGE_SHAPE_CURVATURES: [f64; 3] = [1.0, 1.0, -2.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_interpolate_and_their_gradients_are_their_slopes() {
        for (a, &node) in NODES.iter().enumerate() {
            let n = shape(node);
            for (b, value) in n.iter().enumerate() {
                assert!((value - f64::from(u8::from(a == b))).abs() < 1e-15);
            }
        }
        let (x, h) = ([0.31, -0.47], 1e-6);
        let gradients = shape_gradients(x);
        for k in 0..2 {
            let (mut plus, mut minus) = (x, x);
            plus[k] += h;
            minus[k] -= h;
            let (up, down) = (shape(plus), shape(minus));
            for a in 0..8 {
                assert!((gradients[a][k] - (up[a] - down[a]) / (2.0 * h)).abs() < 1e-9);
            }
        }
        assert!((edge_shape(0.3).iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
