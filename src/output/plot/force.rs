//! The force on the punch against its stroke, ours and what is known from elsewhere.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::super::StepRecord;
use super::canvas::{Canvas, Frame, INK, LABEL_SIZE, TITLE_SIZE, render, text_width, tick_step};
use crate::case::ReferenceForce;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 580.0;

const LOADING: RGBColor = RGBColor(13, 84, 166);
const UNLOADING: RGBColor = RGBColor(110, 170, 225);
const REFERENCE: RGBColor = RGBColor(214, 90, 24);

/// One curve of the figure: stroke in mm, force in N.
struct Curve<'a> {
    name: &'a str,
    color: RGBColor,
    width: f64,
    points: Vec<(f64, f64)>,
}

/// The figure as SVG. Our curve is split at the largest stroke into loading and unloading. Records that are not finite
/// are left out.
///
/// # Errors
/// A sentence, if the drawing fails.
pub fn force_svg(
    title: &str,
    records: &[StepRecord],
    reference: &ReferenceForce,
) -> Result<String, String> {
    let curves = curves(records, reference);
    let single = reference.points.iter().map(|&[x, y, _]| (x, y));
    let single: Vec<_> = single.collect();
    let all = || curves.iter().flat_map(|curve| &curve.points).chain(&single);
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
        tolerances(canvas, &frame, reference)?;
        frame.axes(
            canvas,
            "punch stroke in mm",
            "punch force of the whole sheet in N",
        )
    })
}

/// In the order they are drawn: the reference lies on top of ours, being the thin line.
fn curves<'a>(records: &[StepRecord], reference: &'a ReferenceForce) -> Vec<Curve<'a>> {
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
    if !reference.curve.is_empty() {
        curves.push(Curve {
            name: &reference.name,
            color: REFERENCE,
            width: 1.2,
            points: reference.curve.iter().map(|&[x, y]| (x, y)).collect(),
        });
    }
    if !reference.points.is_empty() {
        // Drawn as bars, not as a line; here for the legend.
        curves.push(Curve {
            name: &reference.points_name,
            color: REFERENCE,
            width: 2.0,
            points: Vec::new(),
        });
    }
    curves
}

/// A bar over the tolerance of each single value, with its ends.
fn tolerances(canvas: &Canvas, frame: &Frame, reference: &ReferenceForce) -> Result<(), String> {
    const HALF_WIDTH: f64 = 4.0;
    for &[depth, force, tolerance] in &reference.points {
        let (x, low) = frame.at(depth, force - tolerance);
        let (_, high) = frame.at(depth, force + tolerance);
        let (_, middle) = frame.at(depth, force);
        canvas.line(&[(x, low), (x, high)], REFERENCE, 2.0)?;
        for y in [low, middle, high] {
            canvas.line(&[(x - HALF_WIDTH, y), (x + HALF_WIDTH, y)], REFERENCE, 1.5)?;
        }
    }
    Ok(())
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
        x += 38.0 + text_width(curve.name, LABEL_SIZE) + 16.0;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_split_at_the_largest_stroke() {
        let strokes = [0.0, 10.0, 28.5, 27.0, 25.65];
        let records = strokes.map(|stroke_mm| StepRecord {
            stroke_mm,
            force_N: 10.0 * stroke_mm,
            ..Default::default()
        });
        let none = ReferenceForce::default();
        let curves = curves(&records, &none);
        let points = |name: &str| {
            curves
                .iter()
                .find(|curve| curve.name.ends_with(name))
                .unwrap()
                .points
                .len()
        };
        assert_eq!((points(" loading"), points("unloading")), (3, 3));
        let svg = force_svg("title & more", &records, &none).unwrap();
        assert!(
            svg.starts_with("<svg width=\"900\" height=\"580\" stroke-linejoin"),
            "{}",
            &svg[..120]
        );
        assert!(svg.contains("title &amp; more"));
    }

    #[test]
    fn the_reference_is_drawn_only_if_there_is_one() {
        let reference = ReferenceForce {
            name: "somebody".into(),
            curve: vec![[0.0, 0.0], [1.0, 50.0]],
            points_name: "tested values".into(),
            points: vec![[0.5, 25.0, 1.0]],
        };
        let with = force_svg("nothing yet", &[], &reference).unwrap();
        assert!(with.contains("somebody") && with.contains("tested values"));
        let without = force_svg("nothing yet", &[], &ReferenceForce::default()).unwrap();
        assert!(!without.contains("somebody") && !without.contains("tested values"));
    }
}
