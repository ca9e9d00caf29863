//! What an identification shows and leaves behind: a table, `identification.json`, and the fit as a figure.

use super::identification::{Estimate, Identification};
use crate::case::{MeasuredPoint, ReferenceForce};
use crate::output::banner::banner;
use crate::output::summary::Status;
use crate::output::{OutputDir, OutputError, StepRecord, plot, write_json};
use crate::text::number;

const JSON: &str = "identification.json";
const FIGURE: &str = "fit.svg";
/// A share of a direction that is worth a word.
const WORTH_NAMING: f64 = 0.1;

/// The curves of the figure.
pub(super) struct Figure<'a> {
    pub best: &'a [StepRecord],
    pub start: &'a [StepRecord],
    pub measured: &'a [MeasuredPoint],
}

/// Writes the files. Not collective.
pub(super) fn write(
    folder: &OutputDir,
    found: &Identification,
    figure: &Figure<'_>,
) -> Result<(), OutputError> {
    write_json(&folder.file(JSON), found)?;
    let reference = ReferenceForce {
        name: "start of the search".to_owned(),
        curve: figure
            .start
            .iter()
            .map(|r| [r.stroke_mm, r.force_N])
            .collect(),
        points_name: "measured".to_owned(),
        points: figure
            .measured
            .iter()
            .map(|m| [m.stroke, m.force, m.uncertainty])
            .collect(),
    };
    let title = "Force of the punch, whole sheet: best fit";
    plot::force(folder.file(FIGURE), title, figure.best, &reference)
}

/// The last table and the banner.
pub(super) fn text(found: &Identification, folder: &OutputDir) -> String {
    let holds = found.verdicts.all_hold();
    let mut facts = vec![
        ("search", how_it_ended(found)),
        (
            "runs",
            format!(
                "{} in {:.1} s; the best one is {}",
                found.runs, found.seconds, found.best_run
            ),
        ),
    ];
    let at_bound = found.parameters.iter().filter(|p| p.at_bound);
    facts.extend(at_bound.map(|p| {
        let advice =
            "there: the best fit may lie beyond, and the standard errors hold without the bounds";
        (
            "note",
            format!(
                "{} is at its bound, {} {advice}",
                p.name,
                number(p.estimate)
            ),
        )
    }));
    facts.push(("results", folder.path().display().to_string()));
    let (status, headline) = if holds {
        (
            Status::Finished,
            "FINISHED: the curve determines every parameter",
        )
    } else {
        (
            Status::NotConverged,
            "FINISHED, but not every verdict holds",
        )
    };
    format!(
        "\n{}\n{}\n{}\n{}",
        estimates(&found.parameters),
        structure(found),
        found.verdicts.text(),
        banner(status, headline, &facts)
    )
}

/// The banner of a search that was asked to end.
pub(super) fn interrupted(runs: usize) -> String {
    let facts = [(
        "runs",
        format!("{runs} begun; a search is not resumed, start it from better values"),
    )];
    banner(Status::Interrupted, "INTERRUPTED", &facts)
}

fn how_it_ended(found: &Identification) -> String {
    let way = format!("{} standard errors", number(found.distance));
    match found.converged {
        true => format!("converged: {}, {way} away", found.ended),
        false => format!("not converged: {}; the best fit is {way} away", found.ended),
    }
}

fn estimates(parameters: &[Estimate]) -> String {
    let mut rows = vec![
        [
            "parameter",
            "start",
            "estimate",
            "standard error",
            "bounds",
            "unit",
        ]
        .map(str::to_owned),
    ];
    rows.extend(parameters.iter().map(|p| {
        [
            p.name.to_owned(),
            number(p.start),
            number(p.estimate),
            number(p.standard_error),
            format!("{} to {}", number(p.lower), number(p.upper)),
            p.unit.to_owned(),
        ]
    }));
    aligned(&rows)
}

/// Correlations, singular values, and the directions that the curve does not determine.
fn structure(found: &Identification) -> String {
    let names: Vec<&str> = found.parameters.iter().map(|p| p.name).collect();
    let mut text = String::new();
    if names.len() > 1 {
        let mut rows = vec![
            ["correlation".to_owned()]
                .into_iter()
                .chain(names.iter().map(|n| (*n).to_owned()))
                .collect(),
        ];
        for (name, row) in names.iter().zip(&found.correlation) {
            let cells = row.iter().map(|value| format!("{value:.3}"));
            rows.push(
                [(*name).to_owned()]
                    .into_iter()
                    .chain(cells)
                    .collect::<Vec<_>>(),
            );
        }
        text += &format!("{}\n", aligned(&rows));
    }
    let values: Vec<String> = found.singular_values.iter().map(|s| number(*s)).collect();
    let limit = number(found.least_singular_value);
    text += &format!(
        "singular values {}; a direction is determined from {limit} on\n",
        values.join(", ")
    );
    let weak = found.singular_values.iter().zip(&found.directions);
    for (_, direction) in weak.filter(|(s, _)| **s < found.least_singular_value) {
        let parts = direction
            .iter()
            .zip(&names)
            .filter(|(share, _)| share.abs() >= WORTH_NAMING);
        let parts: Vec<String> = parts
            .map(|(share, name)| format!("{share:+.2} {name}"))
            .collect();
        text += &format!(
            "not determined: {}, each as a share of its bounds\n",
            parts.join(" ")
        );
    }
    text
}

/// Columns side by side, the first to the left, the others to the right.
pub(super) fn aligned(rows: &[impl AsRef<[String]>]) -> String {
    let columns = rows.first().map_or(0, |row| row.as_ref().len());
    let widest = |column: usize| {
        rows.iter()
            .map(|row| row.as_ref()[column].chars().count())
            .max()
    };
    let widths: Vec<usize> = (0..columns)
        .map(|column| widest(column).unwrap_or(0))
        .collect();
    let line = |row: &[String]| {
        let cells = row.iter().zip(&widths).enumerate();
        let cells = cells.map(|(column, (cell, &width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("  {cell:>width$}"),
        });
        cells.collect::<String>().trim_end().to_owned() + "\n"
    };
    rows.iter().map(|row| line(row.as_ref())).collect()
}
