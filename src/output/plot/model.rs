//! A sketch of the model before anything moves: sheet, tools, axis, mesh and the measures that matter.

use plotters::style::text_anchor::HPos;

use super::canvas::{Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, TITLE_SIZE, render};
use super::geometry::{clipped, die_outline, punch_outline, region};
use super::shape::{DIE, MARK, PUNCH};
use crate::case::Case;

const LEFT: f64 = 78.0;
const TOP: f64 = 60.0;
const WIDTH: f64 = 860.0;
/// What is free around the model, and how far labels are above what they name, as fractions of the sheet's half length with
/// these denominators.
const MARGIN: f64 = 12.0;
const LABEL_ABOVE: f64 = 24.0;

/// The sketch as SVG: both halves, with the punch at the start and, in outline, at full stroke. `die` and `punch` are their
/// right halves from the axis outwards, the punch in its first position, mm.
///
/// # Errors
/// A sentence, if the drawing fails.
pub fn model_svg(case: &Case, die: &[[f64; 2]], punch: &[[f64; 2]]) -> Result<String, String> {
    let (sheet, tools) = (&case.sheet, &case.tools);
    let half = sheet.half_length();
    let margin = half / MARGIN;
    let (x, y) = (
        (-half - margin, half + margin),
        (
            -tools.die_edge() - margin,
            0.8 * tools.punch_radius + margin,
        ),
    );
    let height = WIDTH * (y.1 - y.0) / (x.1 - x.0);
    let frame = Frame {
        left: LEFT,
        top: TOP,
        right: LEFT + WIDTH,
        bottom: TOP + height,
        x,
        y,
    };
    render(LEFT + WIDTH + 30.0, TOP + height + 62.0, |canvas| {
        let sizes = &case.discretisation;
        let title = format!(
            "Model: {} x {} elements on the half sheet, punch to go down by {} mm",
            sizes.nx, sizes.ny, case.loading.stroke
        );
        canvas.text((LEFT, 28.0), &title, TITLE_SIZE, INK, HPos::Left, false)?;
        frame.grid(canvas)?;
        let die = die_outline(die, &frame);
        canvas.polygon(&clipped(&region(&die, y.0 - 1.0), &frame), DIE)?;
        let start = punch_outline(punch, 0.0, &frame);
        canvas.polygon(&clipped(&region(&start, y.1 + 1.0), &frame), PUNCH)?;
        for line in [&die, &start] {
            outline(canvas, &frame, line, FAINT_INK)?;
        }
        let lowest = punch_outline(punch, case.loading.stroke, &frame);
        outline(canvas, &frame, &lowest, MARK)?;
        mesh(canvas, &frame, case)?;
        labels(canvas, &frame, case)?;
        frame.axes(canvas, "x in mm", "y in mm")
    })
}

fn outline(
    canvas: &Canvas,
    frame: &Frame,
    line: &[[f64; 2]],
    color: plotters::style::RGBColor,
) -> Result<(), String> {
    for piece in line.windows(2) {
        let pixels = clipped(piece, frame);
        if pixels.len() > 1 {
            canvas.line(&pixels, color, 1.2)?;
        }
    }
    Ok(())
}

/// The edges of the elements on the right half, the outline on both.
fn mesh(canvas: &Canvas, frame: &Frame, case: &Case) -> Result<(), String> {
    let (half, thickness) = (case.sheet.half_length(), case.sheet.thickness);
    let sizes = &case.discretisation;
    let line = |from: [f64; 2], to: [f64; 2], width: f64| {
        canvas.line(
            &[frame.at(from[0], from[1]), frame.at(to[0], to[1])],
            INK,
            width,
        )
    };
    for i in 0..=sizes.nx {
        let x = half * i as f64 / sizes.nx as f64;
        line([x, 0.0], [x, thickness], 0.35)?;
    }
    for j in 1..sizes.ny {
        let y = thickness * j as f64 / sizes.ny as f64;
        line([0.0, y], [half, y], 0.35)?;
    }
    for y in [0.0, thickness] {
        line([-half, y], [half, y], 1.2)?;
    }
    for x in [-half, half] {
        line([x, 0.0], [x, thickness], 1.2)?;
    }
    Ok(())
}

fn labels(canvas: &Canvas, frame: &Frame, case: &Case) -> Result<(), String> {
    let tools = &case.tools;
    let say = |x: f64, y: f64, text: String, color| {
        canvas.text(
            frame.at(x, y),
            &text,
            LABEL_SIZE,
            color,
            HPos::Center,
            false,
        )
    };
    let edge = tools.die_edge();
    let above = case.sheet.half_length() / LABEL_ABOVE;
    say(
        0.0,
        0.45 * tools.punch_radius,
        format!("punch, radius {} mm", tools.punch_radius),
        INK,
    )?;
    say(
        0.0,
        -0.45 * edge,
        format!("cavity, radius {} mm", tools.die_radius),
        INK,
    )?;
    say(
        0.5 * (edge + case.sheet.half_length()),
        -0.35 * edge,
        format!("shoulder, radius {} mm", tools.die_shoulder_radius),
        INK,
    )?;
    say(
        0.5 * (edge + case.sheet.half_length()),
        case.sheet.thickness + above,
        format!("sheet, {} x {} mm", case.sheet.length, case.sheet.thickness),
        INK,
    )?;
    let deepest = case.sheet.thickness - case.loading.stroke;
    if -deepest > 0.6 * edge {
        say(
            0.0,
            deepest + 1.6 * above,
            "punch at full stroke".to_owned(),
            MARK,
        )?;
    }
    Ok(())
}
