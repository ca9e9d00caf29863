//! The force on the punch against its stroke, ours and code_aster's.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;
use serde::Deserialize;

use super::super::StepRecord;
use super::canvas::{Canvas, Frame, INK, LABEL_SIZE, TITLE_SIZE, render, text_width, tick_step};

/// code_aster 15.2 on the same model without friction; the file says what it is.
const CODE_ASTER: &str = include_str!("../../../inputs/reference/code_aster-15.2-frictionless.csv");

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 580.0;

const LOADING: RGBColor = RGBColor(13, 84, 166);
const UNLOADING: RGBColor = RGBColor(110, 170, 225);
const REFERENCE: RGBColor = RGBColor(214, 90, 24);

#[derive(Deserialize)]
struct ReferenceRow {
    punch_mm: f64,
    #[serde(rename = "force_punch_N")]
    force: f64,
}

/// One curve of the figure: stroke in mm, force in N.
struct Curve {
    name: &'static str,
    color: RGBColor,
    width: f64,
    points: Vec<(f64, f64)>,
}

/// The figure as SVG. Our curve is split at the largest stroke into loading and unloading. Records that are not finite
/// are left out.
///
/// # Errors
/// A sentence, if the reference curve cannot be read or the drawing fails.
pub fn force_svg(title: &str, records: &[StepRecord]) -> Result<String, String> {
    let curves = curves(records)?;
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let (x, y) = (
        range(all().map(|point| point.0)),
        range(all().map(|point| point.1)),
    );
    let frame = Frame {
        left: 78.0,
        top: 84.0,
        right: WIDTH - 28.0,
        bottom: HEIGHT - 62.0,
        x,
        y,
    };
    render(WIDTH, HEIGHT, |canvas| {
        canvas.text(
            (frame.left, 28.0),
            title,
            TITLE_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
        legend(canvas, &curves, frame.left, 60.0)?;
        frame.grid(canvas)?;
        for curve in curves.iter().filter(|curve| curve.points.len() > 1) {
            let pixels: Vec<_> = curve.points.iter().map(|&(x, y)| frame.at(x, y)).collect();
            canvas.line(&pixels, curve.color, curve.width)?;
        }
        frame.axes(
            canvas,
            "punch stroke in mm",
            "punch force of the whole sheet in N",
        )
    })
}

/// In the order they are drawn: the reference lies on top of ours, being the thin line.
fn curves(records: &[StepRecord]) -> Result<Vec<Curve>, String> {
    let ours = records
        .iter()
        .map(|record| (record.stroke_mm, record.force_N));
    let ours: Vec<_> = ours
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let turn = (0..ours.len())
        .max_by(|&a, &b| ours[a].0.total_cmp(&ours[b].0))
        .unwrap_or(0);
    let loading = ours.iter().take(turn + 1).copied().collect();
    let unloading: Vec<_> = ours.iter().skip(turn).copied().collect();
    let mut curves = vec![Curve {
        name: "ssnp155, loading",
        color: LOADING,
        width: 3.0,
        points: loading,
    }];
    if unloading.len() > 1 {
        let name = "ssnp155, unloading";
        curves.insert(
            0,
            Curve {
                name,
                color: UNLOADING,
                width: 3.0,
                points: unloading,
            },
        );
    }
    let name = "code_aster 15.2, without friction";
    curves.push(Curve {
        name,
        color: REFERENCE,
        width: 1.2,
        points: reference()?,
    });
    Ok(curves)
}

fn reference() -> Result<Vec<(f64, f64)>, String> {
    let mut table = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(CODE_ASTER.as_bytes());
    let rows = table.deserialize::<ReferenceRow>();
    rows.map(|row| {
        row.map(|row| (row.punch_mm, row.force))
            .map_err(|error| error.to_string())
    })
    .collect()
}

/// From 0 (or the tick below the lowest value) to the tick above the highest.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((0.0, 0.0), |(low, high): (f64, f64), value| {
        (low.min(value), high.max(value))
    });
    let high = if high > low { high } else { low + 1.0 };
    let step = tick_step((low, high), 7);
    // A little noise below zero needs no tick of its own.
    let bottom = if low > -0.02 * high {
        low.min(0.0)
    } else {
        (low / step).floor() * step
    };
    (bottom, (high / step).ceil() * step)
}

fn legend(canvas: &Canvas, curves: &[Curve], left: f64, top: f64) -> Result<(), String> {
    let mut x = left;
    let mut entries: Vec<&Curve> = curves.iter().collect();
    entries.sort_by_key(|curve| curve.name != "ssnp155, loading");
    for curve in entries {
        canvas.line(&[(x, top), (x + 30.0, top)], curve.color, curve.width)?;
        canvas.text(
            (x + 38.0, top),
            curve.name,
            LABEL_SIZE,
            INK,
            HPos::Left,
            false,
        )?;
        x += 38.0 + text_width(curve.name, LABEL_SIZE) + 28.0;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_curve_is_compiled_in() {
        let curve = reference().unwrap();
        assert!(curve.len() > 190);
        assert!(
            curve
                .iter()
                .any(|&(stroke, force)| stroke == 28.5 && force == 268.37)
        );
    }

    #[test]
    fn the_curve_is_split_at_the_largest_stroke() {
        let strokes = [0.0, 10.0, 28.5, 27.0, 25.65];
        let records = strokes.map(|stroke_mm| StepRecord {
            stroke_mm,
            force_N: 10.0 * stroke_mm,
            ..Default::default()
        });
        let curves = curves(&records).unwrap();
        let points = |name: &str| {
            curves
                .iter()
                .find(|curve| curve.name.ends_with(name))
                .unwrap()
                .points
                .len()
        };
        assert_eq!((points(" loading"), points("unloading")), (3, 3));
        let svg = force_svg("title & more", &records).unwrap();
        assert!(
            svg.starts_with("<svg width=\"900\" height=\"580\" stroke-linejoin"),
            "{}",
            &svg[..120]
        );
        assert!(svg.contains("title &amp; more"));
    }

    #[test]
    fn a_run_without_a_single_step_still_gives_the_reference() {
        assert!(force_svg("nothing yet", &[]).is_ok());
    }
}
