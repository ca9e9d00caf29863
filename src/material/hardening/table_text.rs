//! Reads the text of a hardening table and turns it into checked points of plastic strain and stress.

use crate::text::{shortened, show_real};

/// A point of the table and the line it stands on.
pub(crate) struct Row {
    pub(crate) line: usize,
    pub(crate) strain: f64,
    pub(crate) stress: f64,
}

/// The line to blame, if there is one, and a sentence.
pub(crate) type Refusal = (Option<usize>, String);

/// A table is rounded: a first point with less plastic strain than this is on the elastic line.
const ON_THE_ELASTIC_LINE: f64 = 1e-6;

fn refuse<T>(line: usize, problem: impl Into<String>) -> Result<T, Refusal> {
    Err((Some(line), problem.into()))
}

/// The rows below the header `strain,stress`.
pub(crate) fn rows(text: &str) -> Result<Vec<Row>, Refusal> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .zip(1..)
        .map(|(content, line)| (line, content.trim()))
        .filter(|(_, content)| !content.is_empty() && !content.starts_with('#'));
    match lines.next() {
        None => {
            return Err((
                None,
                "the table is empty; it begins with the header strain,stress".to_owned(),
            ));
        }
        Some((line, header)) => {
            let words: Vec<&str> = header.split(',').map(str::trim).collect();
            if words != ["strain", "stress"] {
                return refuse(
                    line,
                    format!(
                        "the header is '{}' instead of strain,stress",
                        shortened(header)
                    ),
                );
            }
        }
    }
    lines.map(|(line, content)| row(line, content)).collect()
}

fn row(line: usize, content: &str) -> Result<Row, Refusal> {
    let fields: Vec<&str> = content.split(',').map(str::trim).collect();
    let [strain, stress] = fields[..] else {
        let columns = if fields.len() == 1 {
            "one column".to_owned()
        } else {
            format!("{} columns", fields.len())
        };
        return refuse(
            line,
            format!("{columns} instead of two, strain and stress, separated by a comma"),
        );
    };
    Ok(Row {
        line,
        strain: number(line, "strain", strain)?,
        stress: number(line, "stress", stress)?,
    })
}

fn number(line: usize, column: &str, text: &str) -> Result<f64, Refusal> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => refuse(
            line,
            format!("the {column} '{}' is not finite", shortened(text)),
        ),
        Err(_) => refuse(
            line,
            format!(
                "the {column} '{}' is not a number such as 2.75177e-3",
                shortened(text)
            ),
        ),
    }
}

/// Points (plastic strain, stress) with the first at exactly zero, strictly increasing strain and no softening.
pub(crate) fn plastic_points(rows: &[Row], young: f64) -> Result<Vec<(f64, f64)>, Refusal> {
    if rows.len() < 2 {
        return Err((
            None,
            format!(
                "points: {}; at least two are needed to make a curve",
                rows.len()
            ),
        ));
    }
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(rows.len());
    for row in rows {
        let point = plastic_point(row, young)?;
        let Some(&last) = points.last() else {
            points.push((first_point(row, point, young)?, row.stress));
            continue;
        };
        if point <= last.0 {
            return refuse(
                row.line,
                format!(
                    "the plastic strain strain - stress / E = {point:.6e} is not above the one before ({:.6e}); \
                     it must increase from line to line",
                    last.0
                ),
            );
        }
        if row.stress < last.1 {
            return refuse(
                row.line,
                format!(
                    "the stress {} MPa is below the one before ({} MPa); softening is not supported",
                    show_real(row.stress),
                    show_real(last.1)
                ),
            );
        }
        if !((row.stress - last.1) / (point - last.0)).is_finite() {
            return refuse(
                row.line,
                "the point is so near the one before that the slope is not finite",
            );
        }
        points.push((point, row.stress));
    }
    Ok(points)
}

fn plastic_point(row: &Row, young: f64) -> Result<f64, Refusal> {
    if !(row.stress > 0.0
        && row.stress <= MOST_STRESS
        && row.strain > 0.0
        && row.strain <= MOST_STRAIN)
    {
        return refuse(
            row.line,
            format!(
                "strain {} and stress {} MPa; 0 < strain <= {MOST_STRAIN} and 0 < stress <= {MOST_STRESS:e} MPa are needed",
                show_real(row.strain),
                show_real(row.stress)
            ),
        );
    }
    Ok(row.strain - row.stress / young)
}

/// Beyond any metal; a value above is a unit mistaken (percent, Pa).
const MOST_STRAIN: f64 = 100.0;
const MOST_STRESS: f64 = 1e6;

fn first_point(row: &Row, plastic_strain: f64, young: f64) -> Result<f64, Refusal> {
    if plastic_strain.abs() <= ON_THE_ELASTIC_LINE {
        return Ok(0.0);
    }
    refuse(
        row.line,
        format!(
            "the first point is not on the elastic line: strain {} - stress {} MPa / E {} MPa leaves a plastic strain of \
             {plastic_strain:.3e} instead of 0; change the point or -young_modulus",
            show_real(row.strain),
            show_real(row.stress),
            show_real(young),
        ),
    )
}
