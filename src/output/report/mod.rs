//! `report.html`: the whole run on one page that needs nothing but a browser.
//!
//! In: summary, rows and model, and the field files of the run, closed. Out: one file with text, style, script and data
//! in it. Never: anything from the network, or a number that is not in the other files of the run.

mod states;

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::{OutputDir, OutputError, StepRecord, Summary, atomic};
use crate::case::{Case, ReferenceForce};
use crate::text::rounded;
use states::States;

const PAGE: &str = include_str!("page/report.html");
const SCRIPTS: [&str; 6] = [
    include_str!("page/tools.js"),
    include_str!("page/data.js"),
    include_str!("page/chart.js"),
    include_str!("page/sheet.js"),
    include_str!("page/tables.js"),
    include_str!("page/page.js"),
];

/// Significant digits of the numbers in the page.
const DIGITS: usize = 7;

/// What the page shows besides the field files.
pub struct Report<'a> {
    /// The case.
    pub case: &'a Case,
    /// How the run ended and what made it.
    pub summary: &'a Summary,
    /// The rows of all accepted steps.
    pub records: &'a [StepRecord],
    /// Forces to show beside ours.
    pub reference: &'a ReferenceForce,
    /// Outlines of die and punch in their first positions for x >= 0, from the axis outwards, mm.
    pub tools: [Vec<[f64; 2]>; 2],
}

/// What the script reads.
#[derive(Serialize)]
struct Data<'a> {
    headline: String,
    summary: &'a Summary,
    history: BTreeMap<String, Vec<Value>>,
    model: Model,
    reference: &'a ReferenceForce,
    defaults: BTreeMap<&'static str, String>,
    states: States,
}

/// The case in the few numbers that are drawn.
#[derive(Serialize)]
struct Model {
    half_length: f64,
    thickness: f64,
    /// Right halves of the outlines, punch in its first position; they go straight on beyond their ends.
    die: Vec<[f64; 2]>,
    punch: Vec<[f64; 2]>,
    stroke: f64,
    unload_fraction: f64,
    time_load: f64,
    time_unload: f64,
    friction: f64,
    elements: [usize; 2],
}

impl Report<'_> {
    /// Writes the page into the folder of the run. Reads the field files there, which must be closed on all ranks.
    ///
    /// # Errors
    /// If a field file cannot be read or the page cannot be written.
    pub fn write(&self, folder: &OutputDir) -> Result<(), OutputError> {
        let path = folder.report();
        let data = Data {
            headline: self.summary.headline(),
            summary: self.summary,
            history: columns(self.records),
            model: self.model(),
            reference: self.reference,
            defaults: defaults(),
            states: States::read(folder)?,
        };
        let json =
            serde_json::to_string(&data).map_err(|error| OutputError::write(&path, error))?;
        atomic::write(&path, page(PAGE, &SCRIPTS, &json).as_bytes())
    }

    fn model(&self) -> Model {
        let Case {
            sheet,
            loading,
            discretisation,
            ..
        } = self.case;
        Model {
            half_length: sheet.half_length(),
            thickness: sheet.thickness,
            die: short(&self.tools[0]),
            punch: short(&self.tools[1]),
            stroke: loading.stroke,
            unload_fraction: loading.unload_fraction,
            time_load: loading.time_load,
            time_unload: loading.time_unload,
            friction: self.case.friction.coefficient,
            elements: [discretisation.nx, discretisation.ny],
        }
    }
}

/// The points of an outline, rounded.
fn short(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    line.iter()
        .map(|point| point.map(|x| rounded(x, DIGITS)))
        .collect()
}

/// The options of the reference case; none if the program's own table were broken, which the tests exclude.
fn defaults() -> BTreeMap<&'static str, String> {
    Case::reference()
        .map(|case| case.options().into_iter().collect())
        .unwrap_or_default()
}

/// A page with style, scripts and data in their places. Data cannot end the element they stand in.
pub(super) fn page(template: &str, scripts: &[&str], json: &str) -> String {
    template
        .replace("{{style}}", include_str!("page/style.css"))
        .replace("{{script}}", &scripts.join("\n"))
        .replace("{{data}}", &json.replace('<', "\\u003c"))
}

/// The rows as columns, rounded: a picture shows less, and the table in full is history.csv.
pub(super) fn columns(records: &[StepRecord]) -> BTreeMap<String, Vec<Value>> {
    let mut columns = BTreeMap::<String, Vec<Value>>::new();
    for record in records {
        let Ok(Value::Object(row)) = serde_json::to_value(record) else {
            continue;
        };
        for (name, value) in row {
            let short = match value.as_f64() {
                Some(number) if value.is_f64() => Value::from(rounded(number, DIGITS)),
                _ => value,
            };
            columns.entry(name).or_default().push(short);
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_holds_everything_and_data_cannot_break_out() {
        let page = page(PAGE, &SCRIPTS, r#"{"name":"</script><b>"}"#);
        assert!(!page.contains("{{"), "a place was not filled");
        assert!(page.contains(r#"{"name":"\u003c/script>\u003cb>"}"#));
        for word in ["http://", "https://", "src=", "@import", "url("] {
            let found = page.replace("http://www.w3.org/2000/svg", "");
            assert!(!found.contains(word), "the page asks for {word}");
        }
    }

    #[test]
    fn rows_become_columns_of_rounded_numbers() {
        let rows = [1.0, 2.0].map(|t_ms| StepRecord {
            t_ms,
            force_N: if t_ms > 1.0 { 2.123_456_789 } else { 1.1 },
            gap_A_mm: f64::NAN,
            newton_iterations: 7,
            ..StepRecord::default()
        });
        let columns = columns(&rows);
        assert_eq!(
            serde_json::to_string(&columns["force_N"]).unwrap(),
            "[1.1,2.123457]"
        );
        assert_eq!(columns["newton_iterations"], [7, 7].map(Value::from));
        assert!(columns["gap_A_mm"][0].is_null());
    }
}
