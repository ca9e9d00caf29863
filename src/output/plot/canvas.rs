//! What both figures are drawn with: a canvas in pixels, a frame with axes, and colours.

use plotters::coord::Shift;
use plotters::prelude::{
    DrawingArea, IntoDrawingArea, IntoFont, PathElement, Polygon, RGBColor, SVGBackend, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, WHITE};

/// The SVG backend rounds to whole units, so there are this many of them per pixel.
const FINE: f64 = 20.0;
const FONT: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

pub(super) const INK: RGBColor = RGBColor(31, 41, 55);
pub(super) const FAINT_INK: RGBColor = RGBColor(107, 114, 128);
const GRID: RGBColor = RGBColor(229, 231, 235);

pub(super) const TITLE_SIZE: f64 = 17.0;
pub(super) const LABEL_SIZE: f64 = 13.0;
pub(super) const TICK_SIZE: f64 = 12.0;

/// A point of the canvas: pixels from the upper left corner.
pub(super) type Pixel = (f64, f64);

pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Draws a figure of `width` x `height` pixels and returns it as SVG.
pub(super) fn render(
    width: f64,
    height: f64,
    draw: impl FnOnce(&Canvas) -> Result<(), String>,
) -> Result<String, String> {
    let size = (
        (width * FINE).round() as u32,
        (height * FINE).round() as u32,
    );
    let mut svg = String::new();
    {
        let canvas = Canvas {
            area: SVGBackend::with_string(&mut svg, size).into_drawing_area(),
        };
        canvas
            .area
            .fill(&WHITE)
            .map_err(|error| error.to_string())?;
        draw(&canvas)?;
        canvas.area.present().map_err(|error| error.to_string())?;
    }
    // Shown at the size meant, and without spikes where a curve turns sharply.
    let fine = format!(r#"width="{}" height="{}""#, size.0, size.1);
    let shown = format!(
        r#"width="{width:.0}" height="{height:.0}" stroke-linejoin="round" stroke-linecap="round""#
    );
    Ok(svg.replacen(&fine, &shown, 1))
}

impl Canvas<'_> {
    pub(super) fn line(&self, points: &[Pixel], color: RGBColor, width: f64) -> Result<(), String> {
        let style = color.stroke_width((width * FINE).round().max(1.0) as u32);
        self.area
            .draw(&PathElement::new(fine(points), style))
            .map_err(|error| error.to_string())
    }

    /// Fills a polygon; one with fewer than three corners is nothing.
    pub(super) fn polygon(&self, points: &[Pixel], color: RGBColor) -> Result<(), String> {
        if points.len() < 3 {
            return Ok(());
        }
        self.area
            .draw(&Polygon::new(fine(points), color.filled()))
            .map_err(|error| error.to_string())
    }

    /// `align` is where `at` lies relative to the text; the text is always centred vertically.
    pub(super) fn text(
        &self,
        at: Pixel,
        text: &str,
        size: f64,
        color: RGBColor,
        align: HPos,
        turned: bool,
    ) -> Result<(), String> {
        // The backend divides by this factor, so that `size` is the size in the end.
        let font = (FONT, 1.24 * FINE * size).into_font();
        let font = if turned {
            font.transform(FontTransform::Rotate270)
        } else {
            font
        };
        let style = font.color(&color).pos(Pos::new(align, VPos::Center));
        self.area
            .draw(&Text::new(text.to_owned(), fine(&[at])[0], style))
            .map_err(|error| error.to_string())
    }
}

fn fine(points: &[Pixel]) -> Vec<(i32, i32)> {
    points
        .iter()
        .map(|&(x, y)| ((x * FINE).round() as i32, (y * FINE).round() as i32))
        .collect()
}

/// A rectangle of the canvas with a range of values in each direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
}

impl Frame {
    /// Where the value (x, y) lies on the canvas.
    pub(super) fn at(&self, x: f64, y: f64) -> Pixel {
        let across = (x - self.x.0) / (self.x.1 - self.x.0);
        let up = (y - self.y.0) / (self.y.1 - self.y.0);
        (
            self.left + across * (self.right - self.left),
            self.bottom - up * (self.bottom - self.top),
        )
    }

    /// Light grid lines at the ticks.
    pub(super) fn grid(&self, canvas: &Canvas) -> Result<(), String> {
        for x in ticks(self.x, 8) {
            canvas.line(&[self.at(x, self.y.0), self.at(x, self.y.1)], GRID, 0.8)?;
        }
        for y in ticks(self.y, 7) {
            canvas.line(&[self.at(self.x.0, y), self.at(self.x.1, y)], GRID, 0.8)?;
        }
        Ok(())
    }

    /// Border, tick labels and titles of both axes.
    pub(super) fn axes(&self, canvas: &Canvas, x_title: &str, y_title: &str) -> Result<(), String> {
        let (low, high) = (self.at(self.x.0, self.y.0), self.at(self.x.1, self.y.1));
        let border = [low, (high.0, low.1), high, (low.0, high.1), low];
        canvas.line(&border, FAINT_INK, 1.0)?;
        for x in ticks(self.x, 8) {
            let (across, _) = self.at(x, 0.0);
            canvas.line(
                &[(across, self.bottom), (across, self.bottom + 5.0)],
                FAINT_INK,
                1.0,
            )?;
            let label = tick_label(x, self.x);
            canvas.text(
                (across, self.bottom + 16.0),
                &label,
                TICK_SIZE,
                INK,
                HPos::Center,
                false,
            )?;
        }
        for y in ticks(self.y, 7) {
            let (_, up) = self.at(0.0, y);
            canvas.line(&[(self.left - 5.0, up), (self.left, up)], FAINT_INK, 1.0)?;
            canvas.text(
                (self.left - 9.0, up),
                &tick_label(y, self.y),
                TICK_SIZE,
                INK,
                HPos::Right,
                false,
            )?;
        }
        let middle = (
            0.5 * (self.left + self.right),
            0.5 * (self.top + self.bottom),
        );
        canvas.text(
            (middle.0, self.bottom + 40.0),
            x_title,
            LABEL_SIZE,
            INK,
            HPos::Center,
            false,
        )?;
        canvas.text(
            (self.left - 50.0, middle.1),
            y_title,
            LABEL_SIZE,
            INK,
            HPos::Center,
            true,
        )
    }
}

/// Round values (1, 2 or 5 times a power of ten) within `range`, about `count` of them.
pub(super) fn ticks(range: (f64, f64), count: usize) -> Vec<f64> {
    let step = tick_step(range, count);
    let slack = 1e-9 * step;
    let (first, last) = (
        ((range.0 - slack) / step).ceil(),
        ((range.1 + slack) / step).floor(),
    );
    (0..=(last - first) as usize)
        .map(|index| (first + index as f64) * step)
        .collect()
}

/// The distance of the ticks.
pub(super) fn tick_step(range: (f64, f64), count: usize) -> f64 {
    let raw = (range.1 - range.0).abs().max(f64::MIN_POSITIVE) / count as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= raw * 0.999);
    factor.unwrap_or(10.0) * power
}

/// The tick with as many decimals as its neighbours need; a true minus sign.
pub(super) fn tick_label(value: f64, range: (f64, f64)) -> String {
    let decimals = (-tick_step(range, 7).log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", if value == 0.0 { 0.0 } else { value }).replace('-', "\u{2212}")
}

/// Width of a text in pixels, estimated: enough to place the next thing behind it.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    0.53 * size * text.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            ticks((0.0, 30.0), 8),
            [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0]
        );
        assert_eq!(
            ticks((-0.03, 0.11), 7),
            [-0.02, 0.0, 0.02, 0.04, 0.06, 0.08, 0.1]
        );
        assert_eq!(tick_label(-0.02, (-0.03, 0.11)), "\u{2212}0.02");
        assert_eq!(tick_label(-0.0, (-50.0, 50.0)), "0");
    }
}
