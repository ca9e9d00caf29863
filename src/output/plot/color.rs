//! The colours of the plastic strain and the bar that explains them.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::canvas::{Canvas, FAINT_INK, Frame, INK, LABEL_SIZE, TICK_SIZE, tick_label, ticks};

/// The colour map "viridis" (van der Walt and Smith 2015, CC0) at nine places, linear between them; perceptually
/// uniform and readable in grey and by the colour-blind. `share` runs from 0 to 1.
pub(super) fn viridis(share: f64) -> RGBColor {
    const MAP: [[f64; 3]; 9] = [
        [68.0, 1.0, 84.0],
        [72.0, 40.0, 120.0],
        [62.0, 74.0, 137.0],
        [49.0, 104.0, 142.0],
        [38.0, 130.0, 142.0],
        [31.0, 158.0, 137.0],
        [53.0, 183.0, 121.0],
        [110.0, 206.0, 88.0],
        [253.0, 231.0, 37.0],
    ];
    let place = if share.is_finite() {
        share.clamp(0.0, 1.0) * (MAP.len() - 1) as f64
    } else {
        0.0
    };
    let index = (place.floor() as usize).min(MAP.len() - 2);
    let [r, g, b] = std::array::from_fn(|channel| {
        let (low, high) = (MAP[index][channel], MAP[index + 1][channel]);
        (low + (place - index as f64) * (high - low)).round() as u8
    });
    RGBColor(r, g, b)
}

/// A bar from 0 to `top`, as high as the frame `plot`, to the right of the pixel `beside`.
pub(super) fn color_bar(
    canvas: &Canvas,
    beside: f64,
    plot: &Frame,
    top: f64,
) -> Result<(), String> {
    const STRIPES: usize = 128;
    let (left, right) = (beside + 24.0, beside + 40.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colour_map_has_its_two_ends_and_stands_nonsense() {
        assert_eq!(
            (viridis(0.0), viridis(1.0)),
            (RGBColor(68, 1, 84), RGBColor(253, 231, 37))
        );
        assert_eq!(viridis(f64::NAN), viridis(-3.0));
        assert_eq!(viridis(7.0), viridis(1.0));
    }
}
