//! The figures of a run: deformed shapes, and force against stroke.

use std::sync::Arc;

use super::{Recorder, field_sample};
use crate::case::ReferenceForce;
use crate::output::plot::{self, DeformedElement, Shape, View, gather_elements};
use crate::output::{FieldSample, OutputError};
use crate::system::{NodeSample, Problem, System, Tool};

/// Spacing of the points of the drawn tools, mm: a figure is looked at closer than the fields.
const TOOL_SPACING: f64 = 0.05;

impl Recorder {
    /// Draws the deformed sheet between the tools at time `t` (ms), under the name `label`. Collective.
    ///
    /// # Errors
    /// If the figure cannot be written.
    pub fn shape(
        &self,
        label: &str,
        t: f64,
        nodes: &[NodeSample],
        system: &System,
    ) -> Result<(), OutputError> {
        let samples: Vec<FieldSample> = nodes.iter().map(field_sample).collect();
        let elements = gather_elements(system.comm(), &DeformedElement::of(&self.part, &samples));
        if self.history.is_none() {
            return Ok(());
        }
        let local = system.local();
        let problem = local.problem();
        let depth = self.motion.depth(t);
        let (die, punch) = right_halves(problem);
        let figure = Shape {
            title: &format!("{label}: punch down by {depth:.2} mm"),
            elements: &elements,
            die: &die,
            punch: &punch,
            stroke_mm: depth,
            plastic_strain_max: None,
            view: View::Whole,
        };
        let name = format!("shape-{}.svg", label.replace(' ', "-"));
        plot::shape(self.folder.file(&name), &figure)
    }

    /// Draws force against stroke beside the reference, on rank 0.
    ///
    /// # Errors
    /// If the figure cannot be written.
    pub fn force_figure(&self, reference: &ReferenceForce) -> Result<(), OutputError> {
        if self.history.is_none() || self.records.is_empty() {
            return Ok(());
        }
        plot::force(
            self.folder.force_figure(),
            "Force of the punch, whole sheet",
            &self.records,
            reference,
        )
    }
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
