//! The deformed sheet between its tools, coloured by equivalent plastic strain.

use std::collections::HashMap;

use mpi::datatype::PartitionMut;
use mpi::traits::{Communicator, CommunicatorCollectives, Root};
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::super::{FieldSample, SheetPart};
use super::canvas::{
    Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, Pixel, TICK_SIZE, TITLE_SIZE, render,
};
use super::canvas::{tick_label, ticks, viridis};

const DIE: RGBColor = RGBColor(205, 209, 215);
const PUNCH: RGBColor = RGBColor(222, 225, 230);

/// One 8-node element in its deformed position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeformedElement {
    /// Deformed positions [x, y] of the nodes, mm: corners counter-clockwise, then mid-sides.
    pub nodes: [[f64; 2]; 8],
    /// Equivalent plastic strain, one value for the element.
    pub plastic_strain: f64,
}

impl DeformedElement {
    /// The elements of a part, each with the mean plastic strain of its nodes.
    pub fn of(part: &SheetPart, samples: &[FieldSample]) -> Vec<Self> {
        let element = |quad: &[usize; 8]| Self {
            nodes: quad.map(|node| {
                let ([x, y], [ux, uy]) = (part.coordinates[node], samples[node].displacement);
                [x + ux, y + uy]
            }),
            plastic_strain: quad
                .map(|node| samples[node].equivalent_plastic_strain)
                .iter()
                .sum::<f64>()
                / 8.0,
        };
        part.quads.iter().map(element).collect()
    }
}

/// Brings the elements of all ranks to rank 0, in the order of the ranks; the other ranks get none. Collective.
pub fn gather_elements(comm: &impl Communicator, mine: &[DeformedElement]) -> Vec<DeformedElement> {
    const SIZE: usize = 17;
    let flat: Vec<f64> = mine
        .iter()
        .flat_map(|e| e.nodes.into_iter().flatten().chain([e.plastic_strain]))
        .collect();
    let mut counts = vec![0_i32; comm.size() as usize];
    comm.all_gather_into(&(flat.len() as i32), &mut counts[..]);
    let root = comm.process_at_rank(0);
    if comm.rank() != 0 {
        root.gather_varcount_into(&flat[..]);
        return Vec::new();
    }
    let starts: Vec<i32> = counts
        .iter()
        .scan(0, |end, count| Some(std::mem::replace(end, *end + count)))
        .collect();
    let mut all = vec![0.0; counts.iter().sum::<i32>() as usize];
    root.gather_varcount_into_root(
        &flat[..],
        &mut PartitionMut::new(&mut all[..], counts, starts),
    );
    let element = |values: &[f64]| DeformedElement {
        nodes: std::array::from_fn(|node| [values[2 * node], values[2 * node + 1]]),
        plastic_strain: values[SIZE - 1],
    };
    all.chunks_exact(SIZE).map(element).collect()
}

/// What the figure shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// The whole sheet: the half model and its mirror image.
    Whole,
    /// A rectangle [x from, x to, y from, y to], mm.
    Window([f64; 4]),
}

/// One instant to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct Shape<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// The elements of the half model.
    pub elements: &'a [DeformedElement],
    /// Outline of the die for x >= 0, mm, from the axis outwards; the die is below.
    pub die: &'a [[f64; 2]],
    /// Outline of the punch for x >= 0 in its initial position, mm, from the tip outwards; the punch is above.
    pub punch: &'a [[f64; 2]],
    /// How far the punch has moved down, mm.
    pub stroke_mm: f64,
    /// Upper end of the colours; the largest value in `elements` if `None`. Give it to compare instants.
    pub plastic_strain_max: Option<f64>,
    /// What to show.
    pub view: View,
}

/// The figure as SVG. Element edges are drawn where elements are large enough to tell them apart.
///
/// # Errors
/// A sentence, if there is nothing to draw or the drawing fails.
pub fn shape_svg(shape: &Shape) -> Result<String, String> {
    let frame = frame(shape)?;
    let largest = shape
        .elements
        .iter()
        .map(|element| element.plastic_strain)
        .fold(0.0, f64::max);
    let top = shape.plastic_strain_max.unwrap_or(largest);
    let top = if top > 0.0 { top } else { 1e-3 };
    render(frame.right + 130.0, frame.bottom + 62.0, |canvas| {
        canvas.text(
            (frame.left, 28.0),
            shape.title,
            TITLE_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
        frame.grid(canvas)?;
        tool(canvas, &frame, &die_region(shape.die, &frame), DIE)?;
        tool(
            canvas,
            &frame,
            &punch_region(shape.punch, shape.stroke_mm, &frame),
            PUNCH,
        )?;
        elements(canvas, &frame, shape.elements, top)?;
        frame.axes(canvas, "x in mm", "y in mm")?;
        color_bar(canvas, &frame, top)
    })
}

/// The part of the plane shown, at the same scale in both directions.
fn frame(shape: &Shape) -> Result<Frame, String> {
    let nodes = || shape.elements.iter().flat_map(|element| element.nodes);
    if shape.elements.is_empty() || !nodes().flatten().all(f64::is_finite) {
        return Err("there are no elements, or some of their positions are not finite".into());
    }
    let (x, y) = match shape.view {
        View::Window([x0, x1, y0, y1]) => ((x0, x1), (y0, y1)),
        View::Whole => {
            let right = nodes().map(|[x, _]| x).fold(60.0, f64::max) + 5.0;
            let low = nodes()
                .chain(shape.die.iter().copied())
                .map(|[_, y]| y)
                .fold(0.0, f64::min);
            let high = nodes().map(|[_, y]| y).fold(8.0, f64::max);
            ((-right, right), (low - 6.0, high + 6.0))
        }
    };
    if !(x.1 > x.0 && y.1 > y.0) {
        return Err(format!("the window {x:?} x {y:?} is empty"));
    }
    let (left, top) = (78.0, 54.0);
    let scale = f64::min(860.0 / (x.1 - x.0), 700.0 / (y.1 - y.0));
    Ok(Frame {
        left,
        top,
        right: left + scale * (x.1 - x.0),
        bottom: top + scale * (y.1 - y.0),
        x,
        y,
    })
}

/// Mirror image and half model as one line from left to right.
fn whole_outline(half: &[[f64; 2]]) -> Vec<[f64; 2]> {
    half.iter()
        .rev()
        .map(|&[x, y]| [-x, y])
        .chain(half.iter().copied())
        .collect()
}

/// Everything below the outline, which goes on level to both sides of the frame.
fn die_region(half: &[[f64; 2]], frame: &Frame) -> Vec<[f64; 2]> {
    let mut region = whole_outline(half);
    if let Some(&[x, y]) = half.last() {
        let (side, floor) = (
            x.max(frame.x.0.abs()).max(frame.x.1.abs()) + 1.0,
            frame.y.0 - 1.0,
        );
        region.insert(0, [-side, y]);
        region.extend([[side, y], [side, floor.min(y)], [-side, floor.min(y)]]);
    }
    region
}

/// Everything above the outline, whose ends go on straight up.
fn punch_region(half: &[[f64; 2]], stroke: f64, frame: &Frame) -> Vec<[f64; 2]> {
    let mut region: Vec<_> = whole_outline(half)
        .into_iter()
        .map(|[x, y]| [x, y - stroke])
        .collect();
    if let (Some(&[left, y]), Some(&[right, _])) = (region.first(), region.last()) {
        let ceiling = y.max(frame.y.1 + 1.0);
        region.extend([[right, ceiling], [left, ceiling]]);
    }
    region
}

fn tool(
    canvas: &Canvas,
    frame: &Frame,
    region: &[[f64; 2]],
    color: RGBColor,
) -> Result<(), String> {
    let mut pixels = clipped(region, frame);
    if pixels.len() < 3 {
        return Ok(());
    }
    canvas.polygon(&pixels, color)?;
    pixels.push(pixels[0]);
    canvas.line(&pixels, FAINT_INK, 1.2)
}

fn elements(
    canvas: &Canvas,
    frame: &Frame,
    elements: &[DeformedElement],
    top: f64,
) -> Result<(), String> {
    let size = |e: &DeformedElement| {
        pixels_between(frame, e.nodes[0], e.nodes[1])
            .min(pixels_between(frame, e.nodes[0], e.nodes[3]))
    };
    let edges_visible = elements.iter().map(size).sum::<f64>() > 7.0 * elements.len() as f64;
    let mirrored = |e: &DeformedElement| e.nodes.map(|[x, y]| [-x, y]);
    let all = elements
        .iter()
        .flat_map(|e| [(e.nodes, e.plastic_strain), (mirrored(e), e.plastic_strain)]);
    for (nodes, strain) in all {
        // Finer polylines where they can be seen.
        let mut pixels = clipped(&outline(&nodes, if edges_visible { 6 } else { 2 }), frame);
        if pixels.len() < 3 {
            continue;
        }
        let color = viridis(strain / top);
        canvas.polygon(&pixels, color)?;
        pixels.push(pixels[0]);
        // Without its own edge in the same colour, the background would shine through between neighbours.
        let (line, width) = if edges_visible {
            (INK, 0.5)
        } else {
            (color, 0.4)
        };
        canvas.line(&pixels, line, width)?;
    }
    for edge in boundary(elements) {
        for side in [1.0, -1.0] {
            let inside = |&[x, y]: &[f64; 2]| {
                x >= frame.x.0 && x <= frame.x.1 && y >= frame.y.0 && y <= frame.y.1
            };
            let edge = edge.map(|[x, y]| [side * x, y]);
            if edge.iter().all(inside) {
                let pixels: Vec<_> = curve(&edge, 6)
                    .iter()
                    .map(|&[x, y]| frame.at(x, y))
                    .collect();
                canvas.line(&pixels, INK, if edges_visible { 1.4 } else { 0.8 })?;
            }
        }
    }
    Ok(())
}

fn pixels_between(frame: &Frame, a: [f64; 2], b: [f64; 2]) -> f64 {
    let (a, b) = (frame.at(a[0], a[1]), frame.at(b[0], b[1]));
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// The edges of an element: corner, mid-side, corner.
fn edges(nodes: &[[f64; 2]; 8]) -> [[[f64; 2]; 3]; 4] {
    std::array::from_fn(|side| [nodes[side], nodes[side + 4], nodes[(side + 1) % 4]])
}

/// A quadratic edge in `pieces` straight pieces, both ends included.
fn curve([a, m, b]: &[[f64; 2]; 3], pieces: usize) -> Vec<[f64; 2]> {
    let point = |index: usize| {
        let s = 2.0 * index as f64 / pieces as f64 - 1.0;
        std::array::from_fn(|d| {
            0.5 * s * (s - 1.0) * a[d] + (1.0 - s * s) * m[d] + 0.5 * s * (s + 1.0) * b[d]
        })
    };
    (0..=pieces).map(point).collect()
}

fn outline(nodes: &[[f64; 2]; 8], pieces: usize) -> Vec<[f64; 2]> {
    edges(nodes)
        .iter()
        .flat_map(|edge| curve(edge, pieces).into_iter().take(pieces))
        .collect()
}

/// Edges that belong to one element only, without those on the axis of symmetry. Parts of different ranks do not share
/// node numbers, so edges are known by the place of their mid-side.
fn boundary(elements: &[DeformedElement]) -> Vec<[[f64; 2]; 3]> {
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

/// The polygon cut to the frame (Sutherland and Hodgman 1974), in pixels.
fn clipped(polygon: &[[f64; 2]], frame: &Frame) -> Vec<Pixel> {
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

fn color_bar(canvas: &Canvas, plot: &Frame, top: f64) -> Result<(), String> {
    const STRIPES: usize = 128;
    let (left, right) = (plot.right + 24.0, plot.right + 40.0);
    let bar = Frame {
        left,
        right,
        top: plot.top,
        bottom: plot.bottom,
        x: (0.0, 1.0),
        y: (0.0, top),
    };
    for stripe in 0..STRIPES {
        let from = top * stripe as f64 / STRIPES as f64;
        // Each stripe runs to the top: the next one covers what is too much, and no seam is left.
        let corners = [
            bar.at(0.0, from),
            bar.at(1.0, from),
            bar.at(1.0, top),
            bar.at(0.0, top),
        ];
        canvas.polygon(&corners, viridis((stripe as f64 + 0.5) / STRIPES as f64))?;
    }
    let corners = [
        bar.at(0.0, 0.0),
        bar.at(1.0, 0.0),
        bar.at(1.0, top),
        bar.at(0.0, top),
        bar.at(0.0, 0.0),
    ];
    canvas.line(&corners, FAINT_INK, 1.0)?;
    for value in ticks(bar.y, 7) {
        let (_, up) = bar.at(0.0, value);
        canvas.line(&[(right, up), (right + 4.0, up)], FAINT_INK, 1.0)?;
        canvas.text(
            (right + 8.0, up),
            &tick_label(value, bar.y),
            TICK_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
    }
    let middle = 0.5 * (bar.top + bar.bottom);
    canvas.text(
        (right + 62.0, middle),
        "equivalent plastic strain",
        LABEL_SIZE,
        INK,
        HPos::Center,
        true,
    )
}
