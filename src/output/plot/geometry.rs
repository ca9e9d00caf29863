//! Plane geometry of the shape figure: edges of quadratic elements, outlines of regions, cutting to a frame.

use std::collections::HashMap;

use super::canvas::{Frame, Pixel};
use super::elements::DeformedElement;

/// The edges of an element: corner, mid-side, corner.
pub(super) fn edges(nodes: &[[f64; 2]; 8]) -> [[[f64; 2]; 3]; 4] {
    std::array::from_fn(|side| [nodes[side], nodes[side + 4], nodes[(side + 1) % 4]])
}

/// A quadratic edge in `pieces` straight pieces, both ends included.
pub(super) fn curve([a, m, b]: &[[f64; 2]; 3], pieces: usize) -> Vec<[f64; 2]> {
    let point = |index: usize| {
        let s = 2.0 * index as f64 / pieces as f64 - 1.0;
        std::array::from_fn(|d| {
            0.5 * s * (s - 1.0) * a[d] + (1.0 - s * s) * m[d] + 0.5 * s * (s + 1.0) * b[d]
        })
    };
    (0..=pieces).map(point).collect()
}

pub(super) fn outline(nodes: &[[f64; 2]; 8], pieces: usize) -> Vec<[f64; 2]> {
    edges(nodes)
        .iter()
        .flat_map(|edge| curve(edge, pieces).into_iter().take(pieces))
        .collect()
}

/// Edges that belong to one element only, without those on the axis of symmetry. Parts of different ranks do not share
/// node numbers, so edges are known by the place of their mid-side.
pub(super) fn boundary(elements: &[DeformedElement]) -> Vec<[[f64; 2]; 3]> {
    let place = |edge: &[[f64; 2]; 3]| edge[1].map(|value| (value * 1e6).round() as i64);
    let mut seen: HashMap<[i64; 2], usize> = HashMap::new();
    let all: Vec<_> = elements
        .iter()
        .flat_map(|element| edges(&element.nodes))
        .collect();
    all.iter()
        .for_each(|edge| *seen.entry(place(edge)).or_default() += 1);
    let outer =
        |edge: &[[f64; 2]; 3]| seen.get(&place(edge)) == Some(&1) && edge[1][0].abs() > 1e-6;
    all.into_iter().filter(outer).collect()
}

/// Mirror image and half model as one line from left to right.
fn whole_outline(half: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mirrored = half.iter().rev().map(|&[x, y]| [-x, y]);
    mirrored.chain(half.iter().copied()).collect()
}

/// The outline of a tool from left to right, moved down by the stroke (mm); its ends go straight on beyond the frame.
pub(super) fn tool_outline(half: &[[f64; 2]], stroke: f64, frame: &Frame) -> Vec<[f64; 2]> {
    let mut line: Vec<_> = half.iter().map(|&[x, y]| [x, y - stroke]).collect();
    if let [.., before, last] = line[..] {
        let step = [0, 1].map(|d| last[d] - before[d]);
        let size = [frame.x.0, frame.x.1, frame.y.0, frame.y.1, last[0], last[1]];
        let far = 2.0
            * size
                .iter()
                .fold(1.0, |most: f64, size| most.max(size.abs()));
        let length = step[0].hypot(step[1]).max(f64::MIN_POSITIVE);
        line.push([0, 1].map(|d| last[d] + far * step[d] / length));
    }
    whole_outline(&line)
}

/// What lies between a line and the level `y`.
pub(super) fn region(line: &[[f64; 2]], y: f64) -> Vec<[f64; 2]> {
    let mut region = line.to_vec();
    if let (Some(&[left, _]), Some(&[right, _])) = (line.first(), line.last()) {
        region.extend([[right, y], [left, y]]);
    }
    region
}

/// The polygon with each corner moved outwards by `distance` along both of its sides.
pub(super) fn grown(polygon: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    let count = polygon.len();
    let away = |from: [f64; 2], to: [f64; 2]| {
        let length = (to[0] - from[0])
            .hypot(to[1] - from[1])
            .max(f64::MIN_POSITIVE);
        [0, 1].map(|d| distance * (to[d] - from[d]) / length)
    };
    let corner = |index: usize| {
        let point = polygon[index];
        let before = away(polygon[(index + count - 1) % count], point);
        let after = away(polygon[(index + 1) % count], point);
        [0, 1].map(|d| point[d] + before[d] + after[d])
    };
    (0..count).map(corner).collect()
}

/// The polygon (or the piece of a line) cut to the frame (Sutherland and Hodgman 1974), in pixels.
pub(super) fn clipped(polygon: &[[f64; 2]], frame: &Frame) -> Vec<Pixel> {
    let mut points = polygon.to_vec();
    for (axis, limit, keep_above) in [
        (0, frame.x.0, true),
        (0, frame.x.1, false),
        (1, frame.y.0, true),
        (1, frame.y.1, false),
    ] {
        let inside = |point: &[f64; 2]| {
            if keep_above {
                point[axis] >= limit
            } else {
                point[axis] <= limit
            }
        };
        let mut kept = Vec::with_capacity(points.len() + 2);
        for (index, point) in points.iter().enumerate() {
            let before = points[(index + points.len() - 1) % points.len()];
            if inside(point) != inside(&before) {
                let share = (limit - before[axis]) / (point[axis] - before[axis]);
                kept.push(std::array::from_fn(|d| {
                    before[d] + share * (point[d] - before[d])
                }));
            }
            if inside(point) {
                kept.push(*point);
            }
        }
        points = kept;
    }
    points.iter().map(|&[x, y]| frame.at(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
        x: (0.0, 10.0),
        y: (0.0, 10.0),
    };

    #[test]
    fn polygons_and_lines_are_cut_to_the_frame() {
        let square = clipped(&[[-5.0, 2.0], [5.0, 2.0], [5.0, 4.0], [-5.0, 4.0]], &FRAME);
        assert_eq!(square, [(0.0, 8.0), (5.0, 8.0), (5.0, 6.0), (0.0, 6.0)]);
        let line = clipped(&[[-5.0, 5.0], [15.0, 5.0]], &FRAME);
        assert!(
            line.iter()
                .all(|&(x, y)| (0.0..=10.0).contains(&x) && y == 5.0),
            "{line:?}"
        );
        assert!(line.contains(&(0.0, 5.0)) && line.contains(&(10.0, 5.0)));
        assert!(clipped(&[[-5.0, 5.0], [-1.0, 5.0]], &FRAME).is_empty());
    }

    #[test]
    fn a_grown_square_is_larger_on_all_sides() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(
            grown(&square, 0.5),
            [[-0.5, -0.5], [1.5, -0.5], [1.5, 1.5], [-0.5, 1.5]]
        );
    }

    #[test]
    fn the_boundary_has_neither_shared_edges_nor_the_axis() {
        let element = |x: f64| DeformedElement {
            nodes: [
                [0., 0.],
                [1., 0.],
                [1., 1.],
                [0., 1.],
                [0.5, 0.],
                [1., 0.5],
                [0.5, 1.],
                [0., 0.5],
            ]
            .map(|[dx, dy]| [x + dx, dy]),
            plastic_strain: 0.0,
        };
        // 3 edges of the first (its left one lies on the axis) and 3 of the second, less the shared ones.
        assert_eq!(boundary(&[element(0.0), element(1.0)]).len(), 5);
    }
}
