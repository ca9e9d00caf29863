//! Structured mesh of eight-node quadrilaterals on the half sheet.

/// Which face of the sheet an edge belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceSide {
    /// The face on the die, y = 0 at the start.
    Bottom,
    /// The face under the punch, y = thickness at the start.
    Top,
}

/// A quadratic edge on a face of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceEdge {
    /// The face.
    pub side: SurfaceSide,
    /// The element the edge belongs to.
    pub element: usize,
    /// The edge's nodes as local numbers of the element: left end, right end, middle.
    pub local_nodes: [usize; 3],
}

/// The half sheet, x from 0 (symmetry line) to half its length, y from 0 to its thickness.
///
/// Element nodes are ordered as VTK's quadratic quadrilateral: four corners counter-clockwise from
/// the lower left, then the mid-sides bottom, right, top, left.
#[derive(Clone, Debug)]
pub struct SheetMesh {
    /// Reference coordinates of the nodes, mm.
    pub nodes: Vec<[f64; 2]>,
    /// Node numbers of each element.
    pub elements: Vec<[usize; 8]>,
    /// Bottom edges from left to right, then top edges from left to right.
    pub surface: Vec<SurfaceEdge>,
    /// Nodes on the symmetry line x = 0.
    pub symmetry_nodes: Vec<usize>,
    /// The top node on the symmetry line, point A of the benchmark.
    pub point_a: usize,
    /// Elements along the sheet.
    pub nx: usize,
    /// Elements through the thickness.
    pub ny: usize,
}

impl SheetMesh {
    /// `nx` by `ny` equal elements on a rectangle of `half_length` by `thickness` (mm).
    pub fn new(half_length: f64, thickness: f64, nx: usize, ny: usize) -> Self {
        let grid = HalfStepGrid { nx, ny };
        let mut nodes = Vec::with_capacity(grid.node_count());
        for j in 0..=2 * ny {
            for i in (0..=2 * nx).step_by(1 + j % 2) {
                let x = half_length * i as f64 / (2 * nx) as f64;
                let y = thickness * j as f64 / (2 * ny) as f64;
                nodes.push([x, y]);
            }
        }
        let mut elements = Vec::with_capacity(nx * ny);
        for ey in 0..ny {
            for ex in 0..nx {
                let (i, j) = (2 * ex, 2 * ey);
                elements.push([
                    grid.node(i, j),
                    grid.node(i + 2, j),
                    grid.node(i + 2, j + 2),
                    grid.node(i, j + 2),
                    grid.node(i + 1, j),
                    grid.node(i + 2, j + 1),
                    grid.node(i + 1, j + 2),
                    grid.node(i, j + 1),
                ]);
            }
        }
        let bottom = (0..nx).map(|ex| SurfaceEdge {
            side: SurfaceSide::Bottom,
            element: ex,
            local_nodes: [0, 1, 4],
        });
        let top = (0..nx).map(|ex| SurfaceEdge {
            side: SurfaceSide::Top,
            element: (ny - 1) * nx + ex,
            local_nodes: [3, 2, 6],
        });
        Self {
            surface: bottom.chain(top).collect(),
            symmetry_nodes: (0..=2 * ny).map(|j| grid.node(0, j)).collect(),
            point_a: grid.node(0, 2 * ny),
            nodes,
            elements,
            nx,
            ny,
        }
    }

    /// The same mesh with every node moved to where `place` puts it (mm).
    #[must_use]
    pub fn mapped(mut self, place: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        for node in &mut self.nodes {
            *node = place(*node);
        }
        self
    }

    /// The same mesh with every mid-side node halfway between its corners.
    #[must_use]
    pub fn straightened(mut self) -> Self {
        for element in &self.elements {
            for side in 0..4 {
                let [a, b] = [side, (side + 1) % 4].map(|corner| self.nodes[element[corner]]);
                self.nodes[element[4 + side]] = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            }
        }
        self
    }

    /// Which of the columns of elements along the sheet, from its middle outwards, an element is in.
    pub fn column(&self, element: usize) -> usize {
        element % self.nx
    }

    /// Node numbers of a surface edge: left end, right end, middle.
    pub fn edge_nodes(&self, edge: &SurfaceEdge) -> [usize; 3] {
        edge.local_nodes.map(|a| self.elements[edge.element][a])
    }
}

/// Numbering of the nodes on the grid of half element steps; points with both indices odd (the
/// element centres) do not exist.
struct HalfStepGrid {
    nx: usize,
    ny: usize,
}

impl HalfStepGrid {
    fn node_count(&self) -> usize {
        (2 * self.nx + 1) * (self.ny + 1) + (self.nx + 1) * self.ny
    }

    fn node(&self, i: usize, j: usize) -> usize {
        let full_row = 2 * self.nx + 1;
        let sparse_row = self.nx + 1;
        let row_start = (j / 2) * (full_row + sparse_row) + (j % 2) * full_row;
        row_start + if j % 2 == 0 { i } else { i / 2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_benchmark_mesh_has_the_documents_size() {
        let mesh = SheetMesh::new(60.0, 1.0, 170, 5);
        assert_eq!(mesh.nodes.len(), 2901);
        assert_eq!(mesh.elements.len(), 850);
        assert_eq!(mesh.nodes[mesh.point_a], [0.0, 1.0]);
        assert_eq!(mesh.symmetry_nodes.len(), 11);
    }

    #[test]
    fn mid_side_nodes_lie_between_their_corners() {
        let bent = SheetMesh::new(6.0, 1.0, 4, 3).mapped(|[x, y]| [x + 0.1 * y * y, y]);
        all_sides_are_straight(&bent.straightened());
        let mesh = SheetMesh::new(6.0, 1.0, 4, 3);
        all_sides_are_straight(&mesh);
        for edge in &mesh.surface {
            let y = if edge.side == SurfaceSide::Bottom {
                0.0
            } else {
                1.0
            };
            let [left, right, mid] = mesh.edge_nodes(edge).map(|n| mesh.nodes[n]);
            assert!(left[0] < mid[0] && mid[0] < right[0]);
            assert!(left[1] == y && mid[1] == y && right[1] == y);
        }
    }

    fn all_sides_are_straight(mesh: &SheetMesh) {
        for element in &mesh.elements {
            for (mid, (a, b)) in [(4, (0, 1)), (5, (1, 2)), (6, (2, 3)), (7, (3, 0))] {
                for k in 0..2 {
                    let mean = 0.5 * (mesh.nodes[element[a]][k] + mesh.nodes[element[b]][k]);
                    assert!((mesh.nodes[element[mid]][k] - mean).abs() < 1e-14);
                }
            }
        }
    }
}
