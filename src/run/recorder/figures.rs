//! The figures of the sheet and the tools, from the model to the files.

use std::sync::Arc;

use crate::output::plot::{self, DeformedElement, Shape};
use crate::output::{OutputDir, OutputError};
use crate::system::{Problem, Tool};

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
    let (die, punch) = right_halves(problem);
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
pub(in crate::run) fn right_halves(problem: &Problem) -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
    let right_half = |tool: &Option<Arc<Tool>>| -> Vec<[f64; 2]> {
        let points = outline(tool.as_deref(), TOOL_SPACING);
        points
            .into_iter()
            .filter(|point| point[0] > -1e-9)
            .collect()
    };
    let mut punch = right_half(&problem.upper_tool);
    // The punch is walked from its side to its tip.
    punch.reverse();
    (right_half(&problem.lower_tool), punch)
}

/// Outline of a tool in its first position, with `spacing` (mm) between points.
pub(super) fn outline(tool: Option<&Tool>, spacing: f64) -> Vec<[f64; 2]> {
    tool.map_or_else(Vec::new, |tool| tool.profile.polyline(spacing))
}
