//! Figures as SVG and PNG files: force against stroke, and the deformed sheet between its tools.
//!
//! In: step records; deformed elements and tool outlines. Out: one file of each kind, there in full or not at all.
//! Never: a window on the screen, or a value that is not in the input.

mod canvas;
mod color;
mod elements;
mod force;
mod geometry;
mod model;
mod png;
mod sensitivity;
mod shape;

use std::path::Path;

pub use elements::{DeformedElement, gather_elements};
pub use force::force_svg;
pub use model::model_svg;
pub use sensitivity::sensitivity_svg;
pub use shape::{Shape, shape_svg};

use super::{DerivativeTable, OutputError, StepRecord, atomic};
use crate::case::{Case, ReferenceForce};

/// Draws [`force_svg`] into a file, and as PNG beside it.
///
/// # Errors
/// [`OutputError::Figure`] if it cannot be drawn, [`OutputError::Write`] if it cannot be written.
pub fn force(
    path: impl AsRef<Path>,
    title: &str,
    records: &[StepRecord],
    reference: &ReferenceForce,
) -> Result<(), OutputError> {
    store(path.as_ref(), force_svg(title, records, reference))
}

/// Draws [`shape_svg`] into a file, and as PNG beside it.
///
/// # Errors
/// [`OutputError::Figure`] if it cannot be drawn, [`OutputError::Write`] if it cannot be written.
pub fn shape(path: impl AsRef<Path>, shape: &Shape) -> Result<(), OutputError> {
    store(path.as_ref(), shape_svg(shape))
}

/// Draws [`model_svg`] into a file, and as PNG beside it.
///
/// # Errors
/// [`OutputError::Figure`] if it cannot be drawn, [`OutputError::Write`] if it cannot be written.
pub fn model(
    path: impl AsRef<Path>,
    case: &Case,
    die: &[[f64; 2]],
    punch: &[[f64; 2]],
) -> Result<(), OutputError> {
    store(path.as_ref(), model_svg(case, die, punch))
}

/// Draws [`sensitivity_svg`] into a file, and as PNG beside it.
///
/// # Errors
/// [`OutputError::Figure`] if it cannot be drawn, [`OutputError::Write`] if it cannot be written.
pub fn sensitivity(path: impl AsRef<Path>, table: &DerivativeTable) -> Result<(), OutputError> {
    store(path.as_ref(), sensitivity_svg(table))
}

fn store(path: &Path, svg: Result<String, String>) -> Result<(), OutputError> {
    let undrawn = |reason| OutputError::Figure {
        path: path.into(),
        reason,
    };
    let svg = svg.map_err(undrawn)?;
    atomic::write(path, svg.as_bytes())?;
    let png = png::png(&svg).map_err(undrawn)?;
    atomic::write(&path.with_extension("png"), &png)
}
