//! The figures of the sheet and the tools, from the model to the files.

use crate::output::plot::{self, DeformedElement, Shape};
use crate::output::{OutputDir, OutputError};
use crate::system::{Problem, Tool};
use crate::tool::Profile;

/// Spacing of the points of the drawn tools, mm: a figure is looked at closer than the fields.
const TOOL_SPACING: f64 = 0.05;

/// Draws the deformed sheet between the tools with the punch down by `depth` (mm), under the name `label`.
///
/// # Errors
/// If the figure cannot be written.
pub(super) fn shape(
    folder: &OutputDir,
    label: &str,
    depth: f64,
    elements: &[DeformedElement],
    problem: &Problem,
) -> Result<(), OutputError> {
    let tools = [&problem.lower_tool, &problem.upper_tool];
    let profiles = tools.map(|tool| tool.as_ref().map(|tool| &tool.profile));
    let [die, punch] = right_halves(profiles);
    let nodes = &problem.mesh.nodes;
    let sheet = [0, 1].map(|k| nodes.iter().map(|x| x[k]).fold(0.0, f64::max));
    let figure = Shape {
        title: &format!("{label}: punch down by {depth:.2} mm"),
        elements,
        die: &die,
        punch: &punch,
        stroke_mm: depth,
        sheet,
    };
    plot::shape(folder.shape_figure(label), &figure)
}

/// The right halves of die and punch in their first positions, from the axis outwards, mm.
pub(in crate::run) fn right_halves(tools: [Option<&Profile>; 2]) -> [Vec<[f64; 2]>; 2] {
    let [die, mut punch] = tools.map(|tool| {
        let mut points = tool.map_or_else(Vec::new, |tool| tool.polyline(TOOL_SPACING));
        points.retain(|point| point[0] > -1e-9);
        points
    });
    // The punch is walked from its side to its tip.
    punch.reverse();
    [die, punch]
}

/// Outline of a tool in its first position, with `spacing` (mm) between points.
pub(super) fn outline(tool: Option<&Tool>, spacing: f64) -> Vec<[f64; 2]> {
    tool.map_or_else(Vec::new, |tool| tool.profile.polyline(spacing))
}
