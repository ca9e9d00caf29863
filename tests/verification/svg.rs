//! A plain picture: a curve and points over a frame with axes.

use std::fmt::Write;

/// What is drawn.
pub struct Chart<'a> {
    pub title: &'a str,
    pub x_label: &'a str,
    pub y_label: &'a str,
    /// Largest x and y; both axes begin at zero.
    pub end: [f64; 2],
    /// Distance of the ticks.
    pub tick: [f64; 2],
    /// Name and points of the line.
    pub curve: (&'a str, Vec<[f64; 2]>),
    /// Name and places of the dots.
    pub dots: (&'a str, Vec<[f64; 2]>),
}

const SIZE: [f64; 2] = [720.0, 420.0];
/// Left, top, right, bottom of the frame.
const FRAME: [f64; 4] = [70.0, 50.0, 700.0, 365.0];

impl Chart<'_> {
    /// The picture as SVG.
    pub fn svg(&self) -> String {
        let [left, top, right, bottom] = FRAME;
        let px = |x: f64| left + (right - left) * x / self.end[0];
        let py = |y: f64| bottom - (bottom - top) * y / self.end[1];
        let mut body = String::new();
        let mut draw = |text: String| body.push_str(&format!("{text}\n"));
        for k in 0..=(self.end[0] / self.tick[0] + 1e-9) as usize {
            let value = self.tick[0] * k as f64;
            let x = px(value);
            draw(format!(
                r##"<path d="M{x:.1} {top}V{bottom}" stroke="#e5e7eb"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{}</text>"##,
                bottom + 20.0,
                label(value)
            ));
        }
        for k in 0..=(self.end[1] / self.tick[1] + 1e-9) as usize {
            let value = self.tick[1] * k as f64;
            let y = py(value);
            draw(format!(
                r##"<path d="M{left} {y:.1}H{right}" stroke="#e5e7eb"/><text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"##,
                left - 8.0,
                y + 4.0,
                label(value)
            ));
        }
        let mut line = String::new();
        for (k, [x, y]) in self.curve.1.iter().enumerate() {
            let pen = if k == 0 { 'M' } else { 'L' };
            let _ = write!(line, "{pen}{:.1} {:.1}", px(*x), py(*y));
        }
        draw(format!(
            r##"<path d="{line}" fill="none" stroke="#1f2937" stroke-width="1.5"/>"##
        ));
        for [x, y] in &self.dots.1 {
            draw(format!(
                r##"<circle cx="{:.1}" cy="{:.1}" r="2.2" fill="#2563eb"/>"##,
                px(*x),
                py(*y)
            ));
        }
        let (key, middle) = (right - 210.0, 0.5 * (left + right));
        draw(format!(
            r##"<path d="M{key} 68H{:.0}" stroke="#1f2937" stroke-width="1.5"/><text x="{:.0}" y="72">{}</text>"##,
            key + 24.0,
            key + 32.0,
            self.curve.0
        ));
        draw(format!(
            r##"<circle cx="{:.0}" cy="88" r="2.2" fill="#2563eb"/><text x="{:.0}" y="92">{}</text>"##,
            key + 12.0,
            key + 32.0,
            self.dots.0
        ));
        draw(format!(
            r#"<text x="{middle}" y="28" text-anchor="middle" font-size="16">{}</text>"#,
            self.title
        ));
        draw(format!(
            r#"<text x="{middle}" y="405" text-anchor="middle">{}</text>"#,
            self.x_label
        ));
        let centre = 0.5 * (top + bottom);
        draw(format!(
            r#"<text x="22" y="{centre}" text-anchor="middle" transform="rotate(-90 22 {centre})">{}</text>"#,
            self.y_label
        ));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#1f2937\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"white\"/>\n{body}</svg>\n",
            w = SIZE[0],
            h = SIZE[1]
        )
    }
}

fn label(value: f64) -> String {
    format!("{:.2}", value)
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}
