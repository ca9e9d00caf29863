//! `comparison.html`: two runs side by side on one page, from what they left in their folders.
//!
//! In: the folders of two runs that have ended. Out: a page in the manner of the report, and a table for the terminal.
//! Never: a judgement which of the two is right.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::folder::{HISTORY, SUMMARY};
use super::report::{columns, page};
use super::{OutputError, StepRecord, atomic, history};
use crate::text::{number, shortened};

const PAGE: &str = include_str!("report/page/comparison.html");
const SCRIPTS: [&str; 3] = [
    include_str!("report/page/tools.js"),
    include_str!("report/page/chart.js"),
    include_str!("report/page/comparison.js"),
];

/// Two runs.
pub struct TwoRuns {
    runs: [Run; 2],
}

/// What a run left.
struct Run {
    folder: PathBuf,
    summary: Value,
    records: Vec<StepRecord>,
}

/// What the script reads of a run.
#[derive(Serialize)]
struct Shown<'a> {
    folder: String,
    summary: &'a Value,
    history: BTreeMap<String, Vec<Value>>,
}

impl TwoRuns {
    /// Reads both runs.
    ///
    /// # Errors
    /// [`OutputError::NoRun`] where there is no summary, [`OutputError::Read`] where a file is damaged.
    pub fn read(folders: [&Path; 2]) -> Result<Self, OutputError> {
        let [one, other] = folders;
        Ok(Self {
            runs: [Run::read(one)?, Run::read(other)?],
        })
    }

    /// Writes the page.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let runs = self.runs.each_ref().map(|run| Shown {
            folder: run.folder.display().to_string(),
            summary: &run.summary,
            history: columns(&run.records),
        });
        let json = serde_json::to_string(&runs).map_err(|error| OutputError::write(path, error))?;
        atomic::write(path, page(PAGE, &SCRIPTS, &json).as_bytes())
    }

    /// The main numbers beside each other, and the options that differ, for a terminal.
    pub fn text(&self) -> String {
        let [one, other] = &self.runs;
        let mut text = format!(
            "A = {}\nB = {}\n\n",
            one.folder.display(),
            other.folder.display()
        );
        let mut row = |name: &str, values: [String; 3]| {
            let [a, b, difference] = values;
            text.push_str(format!("{name:<34} {a:>14} {b:>14} {difference:>14}").trim_end());
            text.push('\n');
        };
        row("", ["A", "B", "B - A"].map(str::to_owned));
        let status = self.runs.each_ref().map(Run::status);
        let [a, b] = status;
        row("status", [a, b, String::new()]);
        let [a, b] = self.runs.each_ref().map(Run::failing);
        row("verdicts that fail", [a, b, String::new()]);
        for (name, values) in self.numbers() {
            let shown = values.map(|value| value.map_or_else(|| "-".to_owned(), number));
            let difference = match values {
                [Some(a), Some(b)] => number(b - a),
                _ => String::new(),
            };
            let [a, b] = shown;
            row(&name, [a, b, difference]);
        }
        text.push_str("\noptions that differ\n");
        let differing = self.differing_options();
        if differing.is_empty() {
            text.push_str("  none\n");
        }
        for (name, [a, b]) in differing {
            let shown =
                |value: Option<&str>| value.map_or_else(|| "not used".to_owned(), shortened);
            text.push_str(&format!("  -{name}: {} and {}\n", shown(a), shown(b)));
        }
        text
    }

    /// Names of numbers that both or one of the runs have, with their values.
    fn numbers(&self) -> Vec<(String, [Option<f64>; 2])> {
        let both = |of: &dyn Fn(&Run) -> Option<f64>| self.runs.each_ref().map(of);
        let count =
            |path: &'static str| both(&move |run: &Run| run.summary.pointer(path)?.as_f64());
        let mut rows = vec![
            ("steps".to_owned(), count("/counts/steps")),
            ("solves refused".to_owned(), count("/counts/refused_solves")),
            (
                "Newton iterations".to_owned(),
                count("/counts/newton_iterations"),
            ),
            ("processor time, s".to_owned(), count("/timing/cpu_s")),
            (
                "greatest force, N".to_owned(),
                both(&|run| run.records.iter().map(|r| r.force_N).reduce(f64::max)),
            ),
        ];
        let angles: BTreeSet<&String> = self
            .runs
            .iter()
            .filter_map(|run| run.summary["angles_deg"].as_object())
            .flat_map(|angles| angles.keys())
            .collect();
        for name in angles {
            let angle = both(&|run: &Run| run.summary["angles_deg"][name].as_f64());
            rows.push((format!("deg, {name}"), angle));
        }
        rows
    }

    /// Options with other values, but for the folder; none where a run has no use for one.
    fn differing_options(&self) -> Vec<(&str, [Option<&str>; 2])> {
        let options = self
            .runs
            .each_ref()
            .map(|run| run.summary["provenance"]["options"].as_object());
        let names: BTreeSet<&String> = options
            .iter()
            .copied()
            .flatten()
            .flat_map(|options| options.keys())
            .collect();
        names
            .into_iter()
            .map(|name| {
                let [a, b] = options.map(|run| run.and_then(|run| run.get(name)?.as_str()));
                (name.as_str(), [a, b])
            })
            .filter(|(name, [a, b])| a != b && *name != "output_dir")
            .collect()
    }
}

impl Run {
    fn read(folder: &Path) -> Result<Self, OutputError> {
        let none = |reason: String| OutputError::NoRun {
            path: folder.into(),
            reason,
        };
        match std::fs::metadata(folder) {
            Err(error) => return Err(none(error.to_string())),
            Ok(found) if !found.is_dir() => return Err(none("it is not a folder".to_owned())),
            Ok(_) => {}
        }
        let path = folder.join(SUMMARY);
        let text = match std::fs::read_to_string(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(none(format!("{SUMMARY}, a run's last file, is not there")));
            }
            read => read.map_err(|error| OutputError::read(&path, error))?,
        };
        let summary: Value =
            serde_json::from_str(&text).map_err(|error| OutputError::read(&path, error))?;
        if !summary["verdicts"].is_array() {
            return Err(OutputError::read(&path, "it is not the summary of a run"));
        }
        Ok(Self {
            records: history::read(folder.join(HISTORY))?,
            folder: folder.into(),
            summary,
        })
    }

    fn status(&self) -> String {
        self.summary["status"].as_str().unwrap_or("-").to_owned()
    }

    /// Verdicts that fail, of all.
    fn failing(&self) -> String {
        let verdicts = self.summary["verdicts"].as_array();
        let all = verdicts.map_or(0, Vec::len);
        let holding = verdicts
            .into_iter()
            .flatten()
            .filter(|row| row["verdict"] == "holds")
            .count();
        format!("{} of {all}", all - holding)
    }
}
