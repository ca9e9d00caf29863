//! The figures are drawn from plausible data and read back: what is drawn stands where the data are, by one linear map
//! from millimetres and newtons to the picture. They stay for a look in the folder `tmp` of cargo's target folder.

use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

use ssnp155::case::Case;
use ssnp155::output::plot::{self, DeformedElement, Shape};
use ssnp155::output::{SheetPart, StepRecord};
use ssnp155::system::NodeSample;

fn file(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("figures");
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn arc(center: [f64; 2], radius: f64, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..=40).map(move |i| {
        let angle = from + (to - from) * f64::from(i) / 40.0;
        [
            center[0] + radius * angle.cos(),
            center[1] + radius * angle.sin(),
        ]
    })
}

fn die() -> Vec<[f64; 2]> {
    let cavity = arc([0.0, -4.0], 25.0, -FRAC_PI_2, 0.0);
    let shoulder = arc([29.0, -4.0], 4.0, 2.0 * FRAC_PI_2, FRAC_PI_2);
    cavity.chain(shoulder).chain([[70.0, 0.0]]).collect()
}

fn punch() -> Vec<[f64; 2]> {
    arc([0.0, 24.5], 23.5, -FRAC_PI_2, 0.0)
        .chain([[23.5, 40.0]])
        .collect()
}

/// A sheet of `columns` x `rows` elements bent to an arc of radius 24.2 mm and `angle`, then straight.
fn bent_sheet(columns: usize, rows: usize, angle: f64, stroke: f64) -> Vec<DeformedElement> {
    let mut part = SheetPart::default();
    let mut samples = Vec::new();
    let radius = 24.2;
    for (column, row) in (0..columns).flat_map(|c| (0..rows).map(move |r| (c, r))) {
        let at = |i: f64, j: f64| {
            [
                60.0 * (column as f64 + i) / columns as f64,
                (row as f64 + j) / rows as f64,
            ]
        };
        let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        let sides = [at(0.5, 0.0), at(1.0, 0.5), at(0.5, 1.0), at(0.0, 0.5)];
        let base = part.coordinates.len();
        part.quads.push(std::array::from_fn(|node| base + node));
        for [x, y] in corners.into_iter().chain(sides) {
            let turn = if angle > 0.0 {
                (x / radius).min(angle)
            } else {
                0.0
            };
            let straight = if angle > 0.0 {
                (x - radius * angle).max(0.0)
            } else {
                x
            };
            let offset = y - 0.5;
            let bent = [
                radius * turn.sin() + straight * turn.cos() - offset * turn.sin(),
                0.5 - stroke
                    + radius * (1.0 - turn.cos())
                    + straight * turn.sin()
                    + offset * turn.cos(),
            ];
            let fade = 1.0 / (1.0 + ((x - radius * angle) / 1.5).exp());
            let strain = (offset.abs() / radius - 0.0028).max(0.0)
                * fade
                * if angle > 0.0 { 1.0 } else { 0.0 };
            part.coordinates.push([x, y]);
            samples.push(NodeSample {
                displacement: [bent[0] - x, bent[1] - y],
                stress: [0.0; 4],
                von_mises_stress: 0.0,
                equivalent_plastic_strain: strain,
                contact_pressure: 0.0,
                gap: 0.0,
                contact_state: None,
            });
        }
    }
    DeformedElement::of(&part, &samples)
}

fn draw(name: &str, elements: &[DeformedElement], stroke_mm: f64) -> String {
    let (die, punch) = (die(), punch());
    let title = format!("Deformed sheet at a stroke of {stroke_mm} mm");
    let shape = Shape {
        title: &title,
        elements,
        die: &die,
        punch: &punch,
        stroke_mm,
        sheet: [60.0, 1.0],
    };
    plot::shape(file(name), &shape).unwrap();
    std::fs::read_to_string(file(name)).unwrap()
}

/// The corners of the polygons or polylines of a picture, one list each, in its order.
fn drawn(svg: &str, shape: &str) -> Vec<Vec<[f64; 2]>> {
    let corner = |word: &str| -> [f64; 2] {
        let (x, y) = word.split_once(',').unwrap();
        [x, y].map(|number| number.parse().unwrap())
    };
    svg.split(&format!("<{shape} "))
        .skip(1)
        .map(|rest| {
            let points = rest.split_once("points=\"").unwrap().1;
            let points = points.split_once('"').unwrap().0;
            points.split_whitespace().map(corner).collect()
        })
        .collect()
}

/// The map from data to the picture along one axis, by the two data that are farthest apart.
struct Axis {
    scale: f64,
    origin: f64,
}

impl Axis {
    fn through(data: &[f64], picture: &[f64]) -> Self {
        let by = |a: &usize, b: &usize| data[*a].total_cmp(&data[*b]);
        let least = (0..data.len()).min_by(by).unwrap();
        let most = (0..data.len()).max_by(by).unwrap();
        let scale = (picture[most] - picture[least]) / (data[most] - data[least]);
        Self {
            scale,
            origin: picture[least] - scale * data[least],
        }
    }

    /// Whether `picture` is where `value` belongs, but for so much.
    fn has(&self, value: f64, picture: f64, tolerance: f64) -> bool {
        (self.origin + self.scale * value - picture).abs() < tolerance
    }
}

/// The numbers of a picture are whole: two of them are off by less than this.
const ROUNDED: f64 = 2.0;
/// Elements are drawn a little larger on every side, so that no seam shows between them: one pixel, 20 units, covers it
/// on both ends of an axis, and is less than an element.
const GROWN: f64 = 20.0;

/// The axes that carry `data` to `picture`, point by point.
fn axes(data: &[[f64; 2]], picture: &[[f64; 2]], tolerance: f64) -> [Axis; 2] {
    assert_eq!(data.len(), picture.len());
    let axes = [0, 1].map(|k| {
        let along = |points: &[[f64; 2]]| -> Vec<f64> { points.iter().map(|x| x[k]).collect() };
        Axis::through(&along(data), &along(picture))
    });
    every_point_fits(&axes, data, picture, tolerance);
    axes
}

fn every_point_fits(axes: &[Axis; 2], data: &[[f64; 2]], picture: &[[f64; 2]], tolerance: f64) {
    assert_eq!(data.len(), picture.len());
    for (x, drawn) in data.iter().zip(picture) {
        let fits = (0..2).all(|k| axes[k].has(x[k], drawn[k], tolerance));
        assert!(fits, "{x:?} is drawn at {drawn:?}");
    }
}

/// Every element is drawn where its corners are, with one scale in both directions, y upwards.
fn the_sheet_is_where_it_should_be(svg: &str, elements: &[DeformedElement]) {
    let polygons = drawn(svg, "polygon");
    // Die and punch come first; then each element, followed by its mirror image.
    let right_half = polygons[2..].iter().step_by(2).take(elements.len());
    let picture: Vec<[f64; 2]> = right_half.flatten().copied().collect();
    let corners = elements.iter().flat_map(|element| &element.nodes[..4]);
    let corners: Vec<[f64; 2]> = corners.copied().collect();
    let [x, y] = axes(&corners, &picture, GROWN);
    let height = corners.iter().map(|corner| corner[1]);
    let height = height.clone().fold(f64::MIN, f64::max) - height.fold(f64::MAX, f64::min);
    assert!(x.scale > 0.0 && (x.scale + y.scale).abs() * height < GROWN);
    for pair in polygons[2..].chunks_exact(2).take(elements.len()) {
        let (half, mirrored) = (pair[0][0], pair[1][0]);
        assert!((half[0] + mirrored[0] - 2.0 * x.origin).abs() < GROWN);
        assert_eq!(half[1], mirrored[1]);
    }
}

#[test]
fn the_force_figure_shows_loading_unloading_and_the_reference() {
    let force =
        |d: f64| 60.0 * (d * 0.8_f64).min(2.2) + 2.2 * d + 60.0 * (d - 26.0).max(0.0).powi(2) / 4.0;
    let mut records = Vec::new();
    for i in 0..=190 {
        let stroke_mm = 0.15 * f64::from(i);
        records.push(StepRecord {
            stroke_mm,
            force_N: force(stroke_mm),
            ..Default::default()
        });
    }
    for i in 1..=20 {
        let stroke_mm = 28.5 - 2.85 * f64::from(i) / 20.0;
        let left = (1.0 - f64::from(i) / 8.0).max(0.0);
        records.push(StepRecord {
            stroke_mm,
            force_N: force(28.5) * left * left,
            ..Default::default()
        });
    }
    plot::force(
        file("force.svg"),
        "Punch force, 170 x 5 elements, without friction",
        &records,
        &Case::reference().unwrap().reference_force().unwrap(),
    )
    .unwrap();
    let svg = std::fs::read_to_string(file("force.svg")).unwrap();
    for text in [
        "ssnp155, loading",
        "ssnp155, unloading",
        "code_aster 15.2",
        "punch stroke in mm",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    let reference = Case::reference().unwrap().reference_force().unwrap();
    let ours: Vec<[f64; 2]> = records.iter().map(|r| [r.stroke_mm, r.force_N]).collect();
    let lines = drawn(&svg, "polyline");
    // Where a line has as many points as its data, it is that line: the numbers are all different.
    let line = |data: &[[f64; 2]]| lines.iter().find(|line| line.len() == data.len()).unwrap();
    let (loading, unloading) = (&ours[..191], &ours[190..]);
    let frame = axes(loading, line(loading), ROUNDED);
    every_point_fits(&frame, unloading, line(unloading), ROUNDED);
    every_point_fits(&frame, &reference.curve, line(&reference.curve), ROUNDED);
}

#[test]
fn the_shape_figure_shows_the_sheet_at_several_instants() {
    let full = bent_sheet(170, 5, 79.8_f64.to_radians(), 28.5);
    let svg = draw("shape-loaded.svg", &full, 28.5);
    // At least both halves of every element, two tools and the stripes of the colour bar; then the close-up.
    assert!(svg.matches("<polygon").count() > 2 * 850 + 2 + 128);
    the_sheet_is_where_it_should_be(&svg, &full);
    for (name, angle, stroke) in [("half", 0.7, 14.25), ("start", 0.0, 0.0)] {
        let elements = bent_sheet(170, 5, angle, stroke);
        let svg = draw(&format!("shape-{name}.svg"), &elements, stroke);
        the_sheet_is_where_it_should_be(&svg, &elements);
    }
    // A sheet of another size fills its picture as well.
    let [small, large] = [0.5, 40.0].map(|factor: f64| {
        let scaled = |line: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
            line.into_iter().map(|x| x.map(|x| factor * x)).collect()
        };
        let elements: Vec<DeformedElement> = full
            .iter()
            .map(|element| DeformedElement {
                nodes: element.nodes.map(|x| x.map(|x| factor * x)),
                ..*element
            })
            .collect();
        let shape = Shape {
            title: "",
            elements: &elements,
            die: &scaled(die()),
            punch: &scaled(punch()),
            stroke_mm: factor * 28.5,
            sheet: [factor * 60.0, factor],
        };
        plot::shape_svg(&shape).unwrap()
    });
    let size = |svg: &str| {
        svg.lines()
            .next()
            .unwrap()
            .split('>')
            .next()
            .unwrap()
            .to_owned()
    };
    assert_eq!(size(&small), size(&large));
}

#[test]
fn a_shape_without_elements_is_an_error_with_the_path() {
    let shape = Shape {
        title: "",
        elements: &[],
        die: &[],
        punch: &[],
        stroke_mm: 0.0,
        sheet: [60.0, 1.0],
    };
    let error = plot::shape(file("never.svg"), &shape)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("never.svg") && error.contains("no elements"),
        "{error}"
    );
}
