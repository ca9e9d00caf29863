//! A plain picture: a curve and points over a frame with axes; it is read back before it is handed out.

use std::fmt::Write;

use crate::row::Result;

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
    ///
    /// # Errors
    /// If what was drawn, measured by its own ticks, is not what was to be drawn.
    pub fn svg(&self) -> Result<String> {
        let svg = self.drawn();
        self.check(&svg)?;
        // A check that cannot fail is none: the picture with a dot or the line elsewhere must be refused.
        let dot = svg.replacen(r#"<circle cx=""#, r#"<circle cx="1"#, 1);
        let end = svg.find(LINE_ENDS).unwrap_or(0);
        let start = svg[..end].rfind('M').unwrap_or(0);
        let line = format!("{}M9{}", &svg[..start], &svg[start + 1..]);
        for moved in [dot, line] {
            if moved == svg || self.check(&moved).is_ok() {
                return Err("the picture is not looked at".into());
            }
        }
        Ok(svg)
    }

    fn drawn(&self) -> String {
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

    /// Reads the picture as somebody with a ruler would: a place counts by the ticks beside it.
    fn check(&self, svg: &str) -> Result<()> {
        resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default())?;
        for text in [
            self.title,
            self.x_label,
            self.y_label,
            self.curve.0,
            self.dots.0,
        ] {
            if !svg.contains(&format!(">{text}</text>")) {
                return Err(format!("the picture lacks the text '{text}'").into());
            }
        }
        let [along, up] = [ruler(svg, "x", "middle")?, ruler(svg, "y", "end")?];
        // A tenth of the picture's unit is what its numbers are rounded to; labels stand a little below their ticks.
        let baseline = 4.0;
        let read = |x: f64, y: f64| [along.value(x), up.value(y + baseline)];
        let slack = [0.1 * along.per_unit.abs(), 0.1 * up.per_unit.abs()];
        let same = |name: &str, found: Vec<[f64; 2]>, wanted: &[[f64; 2]]| {
            let close =
                |a: &[f64; 2], b: &[f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() <= slack[k]);
            if found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| close(a, b)) {
                Ok(())
            } else {
                Err(format!("{name} is not drawn where its numbers are"))
            }
        };
        let dots = svg.matches("<circle").count();
        let circles = svg.split("<circle").skip(1).take(dots - 1);
        let places = circles.map(|tag| Ok(read(attribute(tag, "cx")?, attribute(tag, "cy")?)));
        same(self.dots.0, places.collect::<Result<_>>()?, &self.dots.1)?;
        let line = svg.split(LINE_ENDS).next().unwrap_or_default();
        let line = line.rsplit('"').next().unwrap_or_default();
        let places = line.split(['M', 'L']).skip(1).map(|pair| {
            let (x, y) = pair.split_once(' ').ok_or("a point without y")?;
            Ok(read(x.parse()?, y.parse()?))
        });
        same(self.curve.0, places.collect::<Result<_>>()?, &self.curve.1)?;
        Ok(())
    }
}

/// What stands behind the points of the line, and nowhere else.
const LINE_ENDS: &str = r#"" fill="none""#;

/// An axis as its labelled ticks say: value and place of the first tick, and value per unit of the picture.
struct Ruler {
    first: [f64; 2],
    per_unit: f64,
}

impl Ruler {
    fn value(&self, place: f64) -> f64 {
        self.first[0] + (place - self.first[1]) * self.per_unit
    }
}

/// The axis whose labels are numbers anchored at `anchor`.
fn ruler(svg: &str, axis: &str, anchor: &str) -> Result<Ruler> {
    let mut ticks: Vec<[f64; 2]> = Vec::new();
    for tag in svg.split("<text").skip(1) {
        let label = tag.split(['>', '<']).nth(1).unwrap_or_default();
        if let (true, Ok(value)) = (
            tag.contains(&format!(r#"text-anchor="{anchor}""#)),
            label.parse(),
        ) {
            ticks.push([value, attribute(tag, axis)?]);
        }
    }
    let [first, .., last] = ticks[..] else {
        return Err(format!("fewer than two ticks along {axis}").into());
    };
    let per_unit = (last[0] - first[0]) / (last[1] - first[1]);
    let ruler = Ruler { first, per_unit };
    let off = |tick: &[f64; 2]| (ruler.value(tick[1]) - tick[0]).abs() > 0.1 * per_unit.abs();
    if ticks.iter().any(off) {
        return Err(format!("the ticks along {axis} are not even").into());
    }
    Ok(ruler)
}

fn attribute(tag: &str, name: &str) -> Result<f64> {
    let start = format!(r#" {name}=""#);
    let value = tag.split(start.as_str()).nth(1);
    let value = value.and_then(|rest| rest.split('"').next());
    Ok(value.ok_or("an attribute is missing")?.parse()?)
}

fn label(value: f64) -> String {
    format!("{:.2}", value)
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}
