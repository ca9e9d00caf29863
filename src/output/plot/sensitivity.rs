//! Which parameter moves the force where: the derivative times the parameter against the stroke.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::super::derivatives::{DerivativeRow, DerivativeTable};
use super::canvas::{Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, TITLE_SIZE, render, text_width};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 580.0;
/// The largest value shown, as a multiple of the largest force: where the sheet snaps through, derivatives are far larger.
const SHOWN: f64 = 1.0;

/// One a parameter, then again.
const COLORS: [RGBColor; 8] = [
    RGBColor(13, 84, 166),
    RGBColor(214, 90, 24),
    RGBColor(21, 128, 61),
    RGBColor(126, 34, 206),
    RGBColor(190, 18, 60),
    RGBColor(14, 116, 144),
    RGBColor(133, 100, 4),
    RGBColor(75, 85, 99),
];

/// The figure as SVG. The path down is drawn thick, the path back thin; values beyond the largest force lie on the frame.
///
/// # Errors
/// A sentence, if the drawing fails.
pub fn sensitivity_svg(table: &DerivativeTable) -> Result<String, String> {
    let largest = |of: fn(&DerivativeRow) -> f64| {
        let values = table.rows.iter().map(|row| of(row).abs());
        values
            .filter(|value| value.is_finite())
            .fold(1e-9, f64::max)
    };
    let (stroke, force) = (largest(|row| row.stroke_mm), largest(|row| row.force_N));
    let limit = SHOWN * force;
    let lines = legend_lines(table);
    let frame = Frame {
        left: 78.0,
        top: 64.0 + 22.0 * lines.len() as f64,
        right: WIDTH - 28.0,
        bottom: HEIGHT - 62.0,
        x: (0.0, stroke),
        y: (-limit, limit),
    };
    let turn = table
        .rows
        .iter()
        .position(|row| row.stroke_mm >= stroke)
        .unwrap_or(0);
    render(WIDTH, HEIGHT, |canvas| {
        let title = "Derivatives of the punch force, each times its parameter";
        canvas.text(
            (frame.left, 28.0),
            title,
            TITLE_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
        for (line, entries) in lines.iter().enumerate() {
            let mut x = frame.left;
            for &index in entries {
                let (name, y) = (table.parameters[index].name, 60.0 + 22.0 * line as f64);
                canvas.line(&[(x, y), (x + 30.0, y)], color(index), 3.0)?;
                canvas.text((x + 38.0, y), name, LABEL_SIZE, INK, HPos::Left, false)?;
                x += entry_width(name);
            }
        }
        frame.grid(canvas)?;
        canvas.line(&[frame.at(0.0, 0.0), frame.at(stroke, 0.0)], FAINT_INK, 1.0)?;
        for index in 0..table.parameters.len() {
            let (down, back) = (&table.rows[..=turn], &table.rows[turn..]);
            draw(canvas, &frame, table, index, down, 2.4)?;
            draw(canvas, &frame, table, index, back, 1.0)?;
        }
        frame.axes(
            canvas,
            "punch stroke in mm",
            "parameter times derivative of the force in N",
        )
    })
}

fn draw(
    canvas: &Canvas,
    frame: &Frame,
    table: &DerivativeTable,
    index: usize,
    rows: &[DerivativeRow],
    width: f64,
) -> Result<(), String> {
    let value = table.parameters[index].value;
    let points = rows.iter().filter_map(|row| {
        let scaled = value * row.by_parameter.get(index)?.force;
        let shown = scaled.clamp(frame.y.0, frame.y.1);
        shown.is_finite().then(|| frame.at(row.stroke_mm, shown))
    });
    let points: Vec<_> = points.collect();
    if points.len() < 2 {
        return Ok(());
    }
    canvas.line(&points, color(index), width)
}

/// The parameters of each line of the legend.
fn legend_lines(table: &DerivativeTable) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = Vec::new();
    let mut right = f64::INFINITY;
    for (index, parameter) in table.parameters.iter().enumerate() {
        let width = entry_width(parameter.name);
        right += width;
        match lines.last_mut() {
            Some(line) if right <= WIDTH - 20.0 => line.push(index),
            _ => {
                lines.push(vec![index]);
                right = 78.0 + width;
            }
        }
    }
    lines
}

fn entry_width(name: &str) -> f64 {
    54.0 + text_width(name, LABEL_SIZE)
}

fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Parameter;
    use crate::sensitivity::Slopes;

    #[test]
    fn every_parameter_has_a_line_and_none_leaves_the_frame() {
        let parameter = |name| Parameter {
            name,
            unit: "MPa",
            value: 2.0,
        };
        let row = |stroke_mm: f64, slope: f64| DerivativeRow {
            stroke_mm,
            force_N: 10.0,
            by_parameter: vec![
                Slopes {
                    force: slope,
                    ..Slopes::default()
                };
                2
            ],
            ..DerivativeRow::default()
        };
        let mut table = DerivativeTable::new(vec![parameter("young_modulus"), parameter("voce_q")]);
        table.rows = vec![row(1.0, 1.0), row(2.0, 1e9), row(1.5, f64::NAN)];
        let svg = sensitivity_svg(&table).unwrap();
        assert!(svg.contains("young_modulus") && svg.contains("voce_q"));
        // Polylines of both parameters begin and end at the same places: one scaled value, one on the frame.
        let frame_top = 20.0 * (64.0 + 22.0);
        assert!(svg.contains(&format!(",{frame_top}")), "{svg}");
    }
}
