//! A tool that gives the released sheet a wanted angle, with the least change from the start; on the mesh of the case first, then
//! on a finer one.
//!
//! Minimised is the sum of the squares of the changes, each as a share of the width of its bounds; the angle is linear in
//! them to first order, with slopes that every run makes better (Broyden 1965, Math. Comp. 19, 577-593; with one parameter
//! the secant method). Two runs on both sides of the angle safeguard it.

use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Session;
use serde::Serialize;

use super::runs::{Ran, Runs};
use super::search::width;
use super::statistics::dot;
use super::{InverseError, design_report, least_change};
use crate::case::{Case, Inverse, Sought};
use crate::ranks::{agree_in_words, from_first};
use crate::run::{Ending, refuse_bad_options};
use crate::text::{number, rounded};

/// First change of a parameter whose slope is not known yet, as a share of the width of its bounds.
const FIRST_CHANGE: f64 = 0.1;
/// A run that does not bring the angle nearer by this factor leaves the choice to the runs on both sides.
const PROGRESS: f64 = 0.5;
/// Shares of the way between these two runs that are not left.
const INNER: [f64; 2] = [0.1, 0.9];
/// On the mesh of the case the angle need not be nearer than this many tolerances if a finer one follows.
const NEAR_ENOUGH: f64 = 10.0;
/// Two points closer than this (as a share of the bounds) are the same.
const SAME: f64 = 1e-9;
/// Digits of a value that is tried.
const DIGITS: usize = 9;

/// A run of the search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Trial {
    /// Changes from the start, as shares of the widths of the bounds.
    #[serde(skip)]
    change: Vec<f64>,
    /// Derivatives of the angle by them, degrees, where the run has them.
    #[serde(skip)]
    slopes: Vec<Option<f64>>,
    /// How much finer than that of the case the mesh is.
    pub refinement: usize,
    pub values: Vec<f64>,
    pub angle_deg: f64,
    pub folder: String,
}

/// How the search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Found {
    Within,
    OutOfReach,
    RunsUsedUp,
}

/// What a design is looked for with.
struct Search {
    runs: Runs,
    wanted: f64,
    tolerance: f64,
    start: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// How much finer than that of the case the mesh is now.
    refinement: usize,
    /// How much finer it is in the end.
    finest: usize,
    /// By how much the finer mesh moves the angle, by the linear model, degrees.
    of_the_mesh: Option<f64>,
    trials: Vec<Trial>,
}

/// Changes the parameters of a case until the sheet, after the whole way back of the punch, has the angle `wanted`
/// (degrees). Collective.
///
/// # Errors
/// If a run is refused, or a file cannot be written; the same on every rank.
pub(super) fn design(
    case: &Case,
    wanted: f64,
    session: &Rc<Session>,
    comm: &SimpleCommunicator,
) -> Result<Ending, InverseError> {
    refuse_bad_options(case, comm)?;
    let runs = Runs::new(&withdrawn(case)?, session, comm)?;
    let mut search = Search::new(runs, wanted, &case.inverse);
    let found = match search.look() {
        Ok(found) => found,
        Err(InverseError::Interrupted) => {
            let made = search.runs.made();
            search.runs.tell(&super::report::interrupted(made));
            return Ok(Ending::Interrupted);
        }
        Err(error) => return Err(error),
    };
    let Some(best) = search.best().cloned() else {
        let folder = search.runs.folder().file("run-001").display().to_string();
        return Err(InverseError::NoStart { folder });
    };
    let design = design_report::Design {
        wanted_deg: wanted,
        tolerance_deg: search.tolerance,
        found,
        runs: search.runs.made(),
        seconds: search.runs.seconds(),
        parameters: search
            .runs
            .parameters()
            .iter()
            .map(|sought| sought.name)
            .collect(),
        start: search.start.clone(),
        best,
        refinement: search.refinement,
        of_the_mesh_deg: search.of_the_mesh,
        trials: search.trials.clone(),
    };
    let mine = match comm.rank() {
        0 => design.write(search.runs.folder()),
        _ => Ok(()),
    };
    agree_in_words(comm, mine).map_err(InverseError::Agreed)?;
    let text = design.text(search.runs.parameters(), search.runs.folder());
    search.runs.tell(&text);
    Ok(match found {
        Found::Within => Ending::Holds,
        Found::OutOfReach | Found::RunsUsedUp => Ending::DoesNotHold,
    })
}

/// The case with the whole way back, at the speed of the part of it that was asked for.
fn withdrawn(case: &Case) -> Result<Case, InverseError> {
    let loading = &case.loading;
    let time = match loading.unload_fraction {
        0.0 => loading.time_load,
        fraction => loading.time_unload / fraction,
    };
    let mut case = case.with(&[("unload_fraction", 1.0), ("time_unload", time)])?;
    case.output.every = 0;
    Ok(case)
}

impl Search {
    fn new(runs: Runs, wanted: f64, options: &Inverse) -> Self {
        let start = runs.start();
        let share = |bound: fn(&Sought) -> f64| -> Vec<f64> {
            let parameters = runs.parameters().iter().zip(&start);
            parameters
                .map(|(sought, value)| (bound(sought) - value) / width(sought))
                .collect()
        };
        Self {
            lower: share(|sought| sought.lower),
            upper: share(|sought| sought.upper),
            start,
            wanted,
            tolerance: options.tolerance,
            refinement: 1,
            finest: options.refinement,
            of_the_mesh: None,
            trials: Vec::new(),
            runs,
        }
    }

    /// Degrees above the wanted angle.
    fn miss(&self, trial: &Trial) -> f64 {
        trial.angle_deg - self.wanted
    }

    /// The runs on the present mesh.
    fn here(&self) -> impl Iterator<Item = &Trial> {
        let finer = self.refinement;
        self.trials
            .iter()
            .filter(move |trial| trial.refinement == finer)
    }

    /// The run on the finest mesh there is that came nearest.
    fn best(&self) -> Option<&Trial> {
        let finest = self.trials.last()?.refinement;
        let on_finest = self
            .trials
            .iter()
            .filter(|trial| trial.refinement == finest);
        on_finest.min_by(|a, b| self.miss(a).abs().total_cmp(&self.miss(b).abs()))
    }

    fn is_found(&self) -> bool {
        let tolerance = match self.refinement < self.finest {
            true => NEAR_ENOUGH * self.tolerance,
            false => self.tolerance,
        };
        self.best()
            .is_some_and(|best| self.miss(best).abs() <= tolerance)
    }

    fn look(&mut self) -> Result<Found, InverseError> {
        match self.steps() {
            Err(InverseError::RunsUsedUp) => Ok(Found::RunsUsedUp),
            ended => ended,
        }
    }

    fn steps(&mut self) -> Result<Found, InverseError> {
        let (found, slopes) = self.on_first_mesh()?;
        let Some(best) = self.best().cloned() else {
            return Ok(found);
        };
        if found != Found::Within || self.finest == 1 {
            return Ok(found);
        }
        let (change, _) = self.next(&best, &slopes);
        self.refinement = self.finest;
        let Some(there) = self.run(&change)? else {
            return Ok(Found::RunsUsedUp);
        };
        let step: Vec<f64> = there
            .change
            .iter()
            .zip(&best.change)
            .map(|(a, b)| a - b)
            .collect();
        self.of_the_mesh = Some(there.angle_deg - best.angle_deg - dot(&slopes, &step));
        Ok(self.approach(there, slopes)?.0)
    }

    /// Also the slopes of the angle.
    fn on_first_mesh(&mut self) -> Result<(Found, Vec<f64>), InverseError> {
        let n = self.start.len();
        let mut slopes = vec![0.0; n];
        let Some(here) = self.run(&vec![0.0; n])? else {
            return Ok((Found::RunsUsedUp, slopes));
        };
        for k in 0..n {
            if self.is_found() {
                break;
            }
            if let Some(slope) = here.slopes[k] {
                slopes[k] = slope;
                continue;
            }
            let mut change = vec![0.0; n];
            change[k] = if self.upper[k] >= FIRST_CHANGE {
                FIRST_CHANGE
            } else {
                -FIRST_CHANGE
            };
            let there = self.run_nearer(change, &here)?;
            slopes[k] = (there.angle_deg - here.angle_deg) / there.change[k];
        }
        // The model goes through the start; with one parameter the last run is as good.
        self.approach(here, slopes)
    }

    /// From a run on the present mesh to the angle. Also the slopes in the end.
    fn approach(
        &mut self,
        mut here: Trial,
        mut slopes: Vec<f64>,
    ) -> Result<(Found, Vec<f64>), InverseError> {
        while !self.is_found() {
            let (change, reachable) = self.next(&here, &slopes);
            let known = |trial: &Trial| distance(&trial.change, &change) < SAME;
            if self.here().any(known) {
                let found = match reachable {
                    true => Found::RunsUsedUp,
                    false => Found::OutOfReach,
                };
                return Ok((found, slopes));
            }
            let there = self.run_nearer(change, &here)?;
            let step: Vec<f64> = there
                .change
                .iter()
                .zip(&here.change)
                .map(|(a, b)| a - b)
                .collect();
            let unforeseen = there.angle_deg - here.angle_deg - dot(&slopes, &step);
            for (slope, part) in slopes.iter_mut().zip(&step) {
                *slope += unforeseen * part / dot(&step, &step);
            }
            for (slope, known) in slopes.iter_mut().zip(&there.slopes) {
                *slope = known.unwrap_or(*slope);
            }
            here = there;
        }
        Ok((Found::Within, slopes))
    }

    /// Where to go by the linear model at `here`, and whether it reaches the angle within the bounds; between the two
    /// nearest runs on both sides of the angle if the model has not come nearer, or leaves them.
    fn next(&self, here: &Trial, slopes: &[f64]) -> (Vec<f64>, bool) {
        let wanted = dot(slopes, &here.change) - self.miss(here);
        let (change, reachable) = least_change(slopes, wanted, &self.lower, &self.upper);
        let nearest = |side: f64| {
            let on_side = self.here().filter(|trial| self.miss(trial) * side > 0.0);
            on_side.min_by(|a, b| self.miss(a).abs().total_cmp(&self.miss(b).abs()))
        };
        let (Some(below), Some(above)) = (nearest(-1.0), nearest(1.0)) else {
            return (change, reachable);
        };
        let leaves =
            |k: usize| (change[k] - below.change[k]) * (change[k] - above.change[k]) >= 0.0;
        let stalls = match &self.here().collect::<Vec<_>>()[..] {
            [.., before, last] => self.miss(last).abs() > PROGRESS * self.miss(before).abs(),
            _ => false,
        };
        let alone = slopes.len() == 1 && leaves(0);
        if !(alone || stalls && slopes.len() > 1 || !reachable) {
            return (change, reachable);
        }
        let share = self.miss(below) / (self.miss(below) - self.miss(above));
        let share = share.clamp(INNER[0], INNER[1]);
        let pairs = below.change.iter().zip(&above.change);
        (pairs.map(|(a, b)| a + share * (b - a)).collect(), true)
    }

    /// A run with this change; where it cannot be solved, half as far from `here`, and so on.
    fn run_nearer(&mut self, mut change: Vec<f64>, here: &Trial) -> Result<Trial, InverseError> {
        loop {
            if let Some(trial) = self.run(&change)? {
                return Ok(trial);
            }
            for (part, base) in change.iter_mut().zip(&here.change) {
                *part = 0.5 * (*part + base);
            }
        }
    }

    fn run(&mut self, change: &[f64]) -> Result<Option<Trial>, InverseError> {
        let parameters = self.runs.parameters().iter().zip(&self.start).zip(change);
        let value = |((sought, start), part): ((&Sought, &f64), &f64)| {
            rounded(start + part * width(sought), DIGITS).clamp(sought.lower, sought.upper)
        };
        let values: Vec<f64> = parameters.map(value).collect();
        let ran = self.runs.next(&values, self.refinement, true)?;
        let Some((ran, angle_deg)) = ran.and_then(|ran| self.angle(&ran).map(|angle| (ran, angle)))
        else {
            self.runs.show("  not solved to its end\n");
            return Ok(None);
        };
        self.runs
            .show(&format!("  angle {} deg\n", number(angle_deg)));
        let trial = Trial {
            slopes: self.slopes(&ran),
            refinement: self.refinement,
            change: change.to_vec(),
            values,
            angle_deg,
            folder: ran.folder,
        };
        self.trials.push(trial.clone());
        Ok(Some(trial))
    }

    /// Derivatives of the angle at the end of the way back by the scaled parameters, where the run has them. Collective.
    fn slopes(&self, ran: &Ran) -> Vec<Option<f64>> {
        let table = &ran.derivatives;
        let slope = |sought: &Sought| {
            let place = table
                .parameters
                .iter()
                .position(|known| known.name == sought.name)?;
            let mut slope = [table.rows.last()?.by_parameter.get(place)?.angle * width(sought)];
            from_first(self.runs.comm(), &mut slope);
            Some(slope[0])
        };
        self.runs.parameters().iter().map(slope).collect()
    }

    /// The angle at the end of the way back once the tools have vanished, the same on every rank. Collective.
    fn angle(&self, ran: &Ran) -> Option<f64> {
        let mut angle = [ran.springbacks.last()?.released_angle_deg];
        from_first(self.runs.comm(), &mut angle);
        Some(angle[0])
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}
