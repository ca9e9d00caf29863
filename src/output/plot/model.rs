//! A sketch of the model before anything moves: sheet, tools, axis, mesh and the measures that matter.

use plotters::style::text_anchor::HPos;

use super::canvas::{Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, TITLE_SIZE, render};
use super::geometry::{clipped, region, tool_outline};
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
    let half = case.sheet.half_length();
    let margin = half / MARGIN;
    let sight = Sight::of(case, die, punch);
    let (x, y) = (
        (-half - margin, half + margin),
        (-sight.depth - margin, 0.8 * sight.height + margin),
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
        let die = tool_outline(die, 0.0, &frame);
        canvas.polygon(&clipped(&region(&die, y.0 - 1.0), &frame), DIE)?;
        let start = tool_outline(punch, 0.0, &frame);
        canvas.polygon(&clipped(&region(&start, y.1 + 1.0), &frame), PUNCH)?;
        for line in [&die, &start] {
            outline(canvas, &frame, line, FAINT_INK)?;
        }
        let lowest = tool_outline(punch, case.loading.stroke, &frame);
        outline(canvas, &frame, &lowest, MARK)?;
        mesh(canvas, &frame, case)?;
        labels(canvas, &frame, case, &sight)?;
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

/// How far down and up there is something to see, and where the die begins to hold the sheet, mm.
struct Sight {
    depth: f64,
    height: f64,
    edge: f64,
}

impl Sight {
    /// The sides of tools from files may go on for longer than the sheet.
    fn of(case: &Case, die: &[[f64; 2]], punch: &[[f64; 2]]) -> Self {
        let tools = &case.tools;
        let half = case.sheet.half_length();
        let lowest = die.iter().map(|[_, y]| -y).fold(0.0, f64::max);
        let holds = die
            .iter()
            .find(|[_, y]| *y > -1e-6)
            .map_or(half, |[x, _]| *x);
        let highest = punch.iter().map(|[_, y]| y - case.sheet.thickness);
        let (depth, edge) = match tools.die_file {
            Some(_) => (lowest.min(half), holds),
            None => (tools.die_edge(), tools.die_edge()),
        };
        let height = match tools.punch_file {
            Some(_) => highest.fold(0.0, f64::max).min(0.5 * half),
            None => tools.punch_radius,
        };
        Self {
            depth,
            height,
            edge,
        }
    }
}

fn labels(canvas: &Canvas, frame: &Frame, case: &Case, sight: &Sight) -> Result<(), String> {
    let tools = &case.tools;
    let half = case.sheet.half_length();
    let say = |x: f64, y: f64, text: String, color| {
        let place = frame.at(x, y);
        canvas.text(place, &text, LABEL_SIZE, color, HPos::Center, false)
    };
    let (edge, depth) = (sight.edge, sight.depth);
    let above = half / LABEL_ABOVE;
    let beside = 0.5 * (edge + half);
    let punch = match &tools.punch_file {
        Some(file) => format!("punch, {}", file_name(&file.path)),
        None => format!("punch, radius {} mm", tools.punch_radius),
    };
    // A nose is wide enough for its name farther up only.
    let up = if tools.punch_file.is_some() {
        0.68
    } else {
        0.45
    };
    say(0.0, up * sight.height, punch, INK)?;
    match &tools.die_file {
        Some(file) => say(
            beside,
            -0.35 * depth,
            format!("die, {}", file_name(&file.path)),
            INK,
        )?,
        None => {
            let cavity = format!("cavity, radius {} mm", tools.die_radius);
            say(0.0, -0.45 * edge, cavity, INK)?;
            let shoulder = format!("shoulder, radius {} mm", tools.die_shoulder_radius);
            say(beside, -0.35 * edge, shoulder, INK)?;
        }
    }
    let sheet = format!("sheet, {} x {} mm", case.sheet.length, case.sheet.thickness);
    say(beside, case.sheet.thickness + above, sheet, INK)?;
    let deepest = case.sheet.thickness - case.loading.stroke;
    if -deepest > 0.6 * depth {
        let text = "punch at full stroke".to_owned();
        let y = match tools.punch_file {
            Some(_) => 0.35 * deepest,
            None => deepest + 1.6 * above,
        };
        say(0.0, y, text, MARK)?;
    }
    Ok(())
}

fn file_name(path: &str) -> String {
    let name = std::path::Path::new(path).file_name();
    name.map_or_else(
        || path.to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}
