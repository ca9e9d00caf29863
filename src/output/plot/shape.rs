//! The deformed sheet between its tools, coloured by equivalent plastic strain.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::canvas::{Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, TITLE_SIZE, render};
use super::color::{color_bar, viridis};
use super::elements::DeformedElement;
use super::geometry::{boundary, clipped, curve, grown, outline, region, tool_outline};
use crate::text::number;

pub(super) const DIE: RGBColor = RGBColor(205, 209, 215);
pub(super) const PUNCH: RGBColor = RGBColor(222, 225, 230);
pub(super) const MARK: RGBColor = RGBColor(190, 24, 60);

/// Side of the close-up in thicknesses of the sheet: wide enough for the gap on both sides.
const CLOSE_UP_SIDE: f64 = 5.0;
/// Width of the picture of the whole sheet, and its greatest height, pixels.
const WIDTH: f64 = 780.0;
const MOST_HEIGHT: f64 = 700.0;
/// Upper end of the colours before anything yields.
const NO_STRAIN: f64 = 1e-3;
/// Height of the lines above the frames and space below them, pixels.
const TOP: f64 = 82.0;
const BELOW: f64 = 62.0;
const LEFT: f64 = 78.0;
/// What is free beside, above and below the sheet, and how high above the die at least is shown, as fractions of its half
/// length with these denominators.
const MARGIN_ACROSS: f64 = 12.0;
const MARGIN_UP: f64 = 10.0;
const HEADROOM: f64 = 5.0;

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
    /// Half length and thickness of the undeformed sheet, mm: they frame the picture.
    pub sheet: [f64; 2],
}

/// The figure as SVG: the whole sheet (the half model and its mirror image), and beside it a close-up of the place with the
/// largest plastic strain. Element edges are drawn where elements are large enough to tell them apart.
///
/// # Errors
/// A sentence, if there is nothing to draw or the drawing fails.
pub fn shape_svg(shape: &Shape) -> Result<String, String> {
    if shape.elements.is_empty()
        || !shape
            .elements
            .iter()
            .flat_map(|e| e.nodes)
            .flatten()
            .all(f64::is_finite)
    {
        return Err("there are no elements, or some of their positions are not finite".into());
    }
    // Before anything yields all are alike: then the element nearest to the axis.
    let most = shape.elements.iter().max_by(|a, b| {
        let strain = a.plastic_strain.total_cmp(&b.plastic_strain);
        strain.then(b.nodes[4][0].abs().total_cmp(&a.nodes[4][0].abs()))
    });
    let largest = most.map_or(0.0, |element| element.plastic_strain);
    let top = if largest > 0.0 { largest } else { NO_STRAIN };
    let main = main_frame(shape)?;
    let side = CLOSE_UP_SIDE * shape.sheet[1];
    let close_up = most.map(|element| close_up_frame(element, side, &main));
    let right = close_up.map_or(main.right, |frame| frame.right);
    render(right + 130.0, main.bottom + BELOW, |canvas| {
        canvas.text(
            (LEFT, 28.0),
            shape.title,
            TITLE_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
        main.grid(canvas)?;
        scene(canvas, &main, shape, top)?;
        main.axes(canvas, "x in mm", "y in mm")?;
        if let Some(frame) = close_up {
            captions(canvas, &main, &frame, shape)?;
            scene(canvas, &frame, shape, top)?;
            mark(canvas, &frame, &frame)?;
            mark(canvas, &main, &frame)?;
        }
        color_bar(canvas, right, &main, top)
    })
}

/// The part of the plane shown, at the same scale in both directions.
fn main_frame(shape: &Shape) -> Result<Frame, String> {
    let nodes = || shape.elements.iter().flat_map(|element| element.nodes);
    let [half_length, _] = shape.sheet;
    let right = nodes().map(|[x, _]| x).fold(half_length, f64::max);
    // The sides of a die may go down farther than there is anything to see.
    let deepest = shape.die.iter().map(|[_, y]| y.max(-half_length));
    let low = nodes().map(|[_, y]| y).chain(deepest).fold(0.0, f64::min);
    let high = nodes()
        .map(|[_, y]| y)
        .fold(half_length / HEADROOM, f64::max);
    let right = right + half_length / MARGIN_ACROSS;
    let margin = half_length / MARGIN_UP;
    let (x, y) = ((-right, right), (low - margin, high + margin));
    if !(x.1 > x.0 && y.1 > y.0) {
        return Err(format!("the window {x:?} x {y:?} is empty"));
    }
    let scale = f64::min(WIDTH / (x.1 - x.0), MOST_HEIGHT / (y.1 - y.0));
    let (right, bottom) = (LEFT + scale * (x.1 - x.0), TOP + scale * (y.1 - y.0));
    Ok(Frame {
        left: LEFT,
        top: TOP,
        right,
        bottom,
        x,
        y,
    })
}

/// A square to the right of the main frame, as high as it, around an element.
fn close_up_frame(element: &DeformedElement, side: f64, main: &Frame) -> Frame {
    let mean = |d: usize| element.nodes.iter().map(|node| node[d]).sum::<f64>() / 8.0;
    let around = |value: f64| (value - 0.5 * side, value + 0.5 * side);
    let left = main.right + 28.0;
    let right = left + main.bottom - main.top;
    Frame {
        left,
        right,
        x: around(mean(0)),
        y: around(mean(1)),
        ..*main
    }
}

fn captions(canvas: &Canvas, main: &Frame, close_up: &Frame, shape: &Shape) -> Result<(), String> {
    let above = main.top - 16.0;
    canvas.text(
        (main.left, above),
        "whole sheet",
        LABEL_SIZE,
        FAINT_INK,
        HPos::Left,
        false,
    )?;
    let yields = shape
        .elements
        .iter()
        .any(|element| element.plastic_strain > 0.0);
    let place = if yields {
        ", at the largest plastic strain"
    } else {
        ""
    };
    let side = number(close_up.x.1 - close_up.x.0);
    let caption = format!("close-up, {side} mm wide{place}");
    canvas.text(
        (close_up.left, above),
        &caption,
        LABEL_SIZE,
        FAINT_INK,
        HPos::Left,
        false,
    )?;
    if !shape.die.is_empty() {
        let corner = (main.left + 14.0, main.bottom - 16.0);
        canvas.text(corner, "die", LABEL_SIZE, FAINT_INK, HPos::Left, false)?;
    }
    let tip = shape
        .punch
        .first()
        .map_or(f64::INFINITY, |[_, y]| y - shape.stroke_mm);
    let (middle, down) = main.at(0.0, tip);
    if down > main.top + 34.0 {
        canvas.text(
            (middle, main.top + 16.0),
            "punch",
            LABEL_SIZE,
            FAINT_INK,
            HPos::Center,
            false,
        )?;
    }
    Ok(())
}

/// A rectangle in `frame` around what `seen` shows.
fn mark(canvas: &Canvas, frame: &Frame, seen: &Frame) -> Result<(), String> {
    let (x, y) = (seen.x, seen.y);
    let corners = [(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1), (x.0, y.0)];
    canvas.line(&corners.map(|(x, y)| frame.at(x, y)), MARK, 1.2)
}

fn scene(canvas: &Canvas, frame: &Frame, shape: &Shape, top: f64) -> Result<(), String> {
    let die = tool_outline(shape.die, 0.0, frame);
    let punch = tool_outline(shape.punch, shape.stroke_mm, frame);
    tool(canvas, frame, &die, frame.y.0 - 1.0, DIE)?;
    tool(canvas, frame, &punch, frame.y.1 + 1.0, PUNCH)?;
    elements(canvas, frame, shape.elements, top)
}

/// A tool fills everything between its outline and `level`.
fn tool(
    canvas: &Canvas,
    frame: &Frame,
    line: &[[f64; 2]],
    level: f64,
    color: RGBColor,
) -> Result<(), String> {
    canvas.polygon(&clipped(&region(line, level), frame), color)?;
    polyline(canvas, frame, line, FAINT_INK, 1.2)
}

/// A line, cut to the frame piece by piece.
fn polyline(
    canvas: &Canvas,
    frame: &Frame,
    line: &[[f64; 2]],
    color: RGBColor,
    width: f64,
) -> Result<(), String> {
    for piece in line.windows(2) {
        let pixels = clipped(piece, frame);
        if pixels.len() > 1 {
            canvas.line(&pixels, color, width)?;
        }
    }
    Ok(())
}

fn elements(
    canvas: &Canvas,
    frame: &Frame,
    elements: &[DeformedElement],
    top: f64,
) -> Result<(), String> {
    let scale = (frame.right - frame.left) / (frame.x.1 - frame.x.0);
    let length = |a: [f64; 2], b: [f64; 2]| scale * (a[0] - b[0]).hypot(a[1] - b[1]);
    let size =
        |e: &DeformedElement| length(e.nodes[0], e.nodes[1]).min(length(e.nodes[0], e.nodes[3]));
    let edges_visible = elements.iter().map(size).sum::<f64>() > 7.0 * elements.len() as f64;
    for (element, side) in elements
        .iter()
        .flat_map(|element| [(element, 1.0), (element, -1.0)])
    {
        let nodes = element.nodes.map(|[x, y]| [side * x, y]);
        let color = viridis(element.plastic_strain / top);
        if edges_visible {
            let mut line = outline(&nodes, 6);
            canvas.polygon(&clipped(&grown(&line, 0.2 / scale), frame), color)?;
            line.push(line[0]);
            polyline(canvas, frame, &line, INK, 0.5)?;
        } else {
            // A little larger than they are: otherwise the background shines through between neighbours.
            canvas.polygon(
                &clipped(&grown(&outline(&nodes, 1), 0.3 / scale), frame),
                color,
            )?;
        }
    }
    for (edge, side) in boundary(elements)
        .iter()
        .flat_map(|edge| [(edge, 1.0), (edge, -1.0)])
    {
        let line = curve(
            &edge.map(|[x, y]| [side * x, y]),
            if edges_visible { 6 } else { 1 },
        );
        polyline(
            canvas,
            frame,
            &line,
            INK,
            if edges_visible { 1.4 } else { 0.7 },
        )?;
    }
    Ok(())
}
