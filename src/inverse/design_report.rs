//! What a design shows and leaves behind: a table of its runs, and `design.json`.

use serde::Serialize;

use super::design::{Found, Trial};
use super::report::aligned;
use crate::case::Sought;
use crate::output::banner::banner;
use crate::output::summary::Status;
use crate::output::{OutputDir, OutputError, write_json};
use crate::text::number;

const JSON: &str = "design.json";

/// The content of `design.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Design {
    pub wanted_deg: f64,
    pub tolerance_deg: f64,
    pub found: Found,
    pub runs: usize,
    pub seconds: f64,
    pub parameters: Vec<&'static str>,
    pub start: Vec<f64>,
    pub best: Trial,
    /// How much finer than that of the case the mesh of the last runs is.
    pub refinement: usize,
    /// By how much it moves the angle.
    pub of_the_mesh_deg: Option<f64>,
    pub trials: Vec<Trial>,
}

impl Design {
    /// Writes the file. Not collective.
    pub fn write(&self, folder: &OutputDir) -> Result<(), OutputError> {
        write_json(&folder.file(JSON), self)
    }

    /// The last table and the banner.
    pub fn text(&self, sought: &[Sought], folder: &OutputDir) -> String {
        let mut rows = vec![self.heads(sought)];
        rows.extend(self.trials.iter().map(|trial| self.row(trial)));
        let (status, headline) = match self.found {
            Found::Within => (Status::Finished, "FINISHED: the angle is reached"),
            Found::OutOfReach => (
                Status::NotConverged,
                "FINISHED, but the angle cannot be reached within the bounds",
            ),
            Found::RunsUsedUp => (
                Status::NotConverged,
                "FINISHED, but the angle was not reached",
            ),
        };
        let values = self.parameters.iter().zip(&self.best.values).zip(sought);
        let values: Vec<String> = values
            .map(|((name, value), sought)| format!("-{name} {} {}", number(*value), sought.unit))
            .collect();
        let mut facts = vec![
            (
                "wanted",
                format!(
                    "{} deg, within {}",
                    number(self.wanted_deg),
                    number(self.tolerance_deg)
                ),
            ),
            (
                "nearest",
                format!(
                    "{:.3} deg with {}",
                    self.best.angle_deg,
                    values.join(", ").trim_end()
                ),
            ),
            ("runs", format!("{} in {:.1} s", self.runs, self.seconds)),
        ];
        if let Some(angle) = self.of_the_mesh_deg {
            let finer = self.refinement;
            facts.push((
                "of the mesh",
                format!("{angle:+.3} deg from that of the case to one {finer} times as fine"),
            ));
        }
        if self.found == Found::RunsUsedUp {
            facts.push((
                "try",
                "more runs with -most_runs, or a start that is nearer".to_owned(),
            ));
        }
        facts.push(("results", folder.path().display().to_string()));
        format!("\n{}\n{}", aligned(&rows), banner(status, headline, &facts))
    }

    fn heads(&self, sought: &[Sought]) -> Vec<String> {
        let with_unit = |s: &Sought| format!("{} {}", s.name, s.unit).trim_end().to_owned();
        let mut heads = vec!["run".to_owned(), "mesh".to_owned()];
        heads.extend(sought.iter().map(with_unit));
        heads.extend(["angle deg", "miss deg"].map(str::to_owned));
        heads
    }

    fn row(&self, trial: &Trial) -> Vec<String> {
        let mut row = vec![
            trial
                .folder
                .rsplit('/')
                .next()
                .unwrap_or_default()
                .to_owned(),
            format!("x {}", trial.refinement),
        ];
        row.extend(trial.values.iter().map(|value| number(*value)));
        row.push(format!("{:.3}", trial.angle_deg));
        row.push(format!("{:+.3}", trial.angle_deg - self.wanted_deg));
        row
    }
}
