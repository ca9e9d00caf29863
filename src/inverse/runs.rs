//! Whole runs with other values of the parameters, each in a folder of its own.

use std::rc::Rc;
use std::time::Instant;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Session;

use super::InverseError;
use crate::case::{Case, Inverse, Sought};
use crate::output::{DerivativeTable, Monitor, OutputDir, StepRecord};
use crate::ranks::agree_in_words;
use crate::run::{Ending, Springback, conclude, simulate};
use crate::text::number;

/// Runs of a case, as many as are allowed.
pub(super) struct Runs {
    /// The case of all runs, but for the parameters and the folder; without a search of its own.
    case: Case,
    parameters: Vec<Sought>,
    most: usize,
    session: Rc<Session>,
    comm: SimpleCommunicator,
    folder: OutputDir,
    monitor: Monitor<std::io::Stdout>,
    made: usize,
    began: Instant,
}

/// A run that was solved to its end.
pub(super) struct Ran {
    pub folder: String,
    pub records: Vec<StepRecord>,
    pub springbacks: Vec<Springback>,
    /// Of those parameters that have derivatives along a run.
    pub derivatives: DerivativeTable,
}

impl Runs {
    /// Makes the folder. `case` is what every run has in common. Collective.
    ///
    /// # Errors
    /// If the folder cannot be used, or holds an interrupted run that would be lost.
    pub fn new(
        case: &Case,
        session: &Rc<Session>,
        comm: &SimpleCommunicator,
    ) -> Result<Self, InverseError> {
        let Inverse {
            parameters,
            most_runs,
            ..
        } = case.inverse.clone();
        let folder = OutputDir::create(&case.output.dir, comm)?;
        let replaced = folder.replace(None, case.resuming.overwrite, comm)?;
        let mut monitor = Monitor::new(comm.rank(), std::io::stdout(), case.loading.motion());
        let log = match comm.rank() {
            0 => folder
                .forget(None)
                .and_then(|()| monitor.log_to(&folder.log(), false)),
            _ => Ok(()),
        };
        agree_in_words(comm, log).map_err(InverseError::Agreed)?;
        if case.output.quiet {
            monitor.be_quiet();
        }
        monitor.show(&replaced);
        let mut case = case.without_search();
        case.output.sensitivity.clear();
        Ok(Self {
            case,
            parameters,
            most: most_runs,
            session: Rc::clone(session),
            comm: comm.duplicate(),
            folder,
            monitor,
            made: 0,
            began: Instant::now(),
        })
    }

    /// Shows a text to the user, once over all ranks.
    pub fn show(&mut self, text: &str) {
        self.monitor.show(text);
    }

    /// As [`Runs::show`], also to who asked for quiet.
    pub fn tell(&mut self, text: &str) {
        self.monitor.tell(text);
    }

    /// What is looked for.
    pub fn parameters(&self) -> &[Sought] {
        &self.parameters
    }

    /// Where everything is.
    pub fn folder(&self) -> &OutputDir {
        &self.folder
    }

    /// The ranks.
    pub fn comm(&self) -> &SimpleCommunicator {
        &self.comm
    }

    /// Runs made so far.
    pub fn made(&self) -> usize {
        self.made
    }

    /// Time on the clock so far, s.
    pub fn seconds(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// The values of the parameters the search starts from.
    pub fn start(&self) -> Vec<f64> {
        let value = |sought: &Sought| self.case.real(sought.name).unwrap_or(sought.lower);
        self.parameters.iter().map(value).collect()
    }

    /// The next run, with these values of the parameters on a mesh `refinement` times as fine as that of the case, and with its
    /// derivatives by those that have them if they are `wanted`. `None` if there is no such case or it is not solved to its end. Collective.
    ///
    /// # Errors
    /// If the runs are used up, the run was asked to end, or a file cannot be written; the same on every rank.
    pub fn next(
        &mut self,
        values: &[f64],
        refinement: usize,
        wanted: bool,
    ) -> Result<Option<Ran>, InverseError> {
        if self.made == self.most {
            return Err(InverseError::RunsUsedUp);
        }
        self.made += 1;
        let text: Vec<String> = self
            .parameters
            .iter()
            .zip(values)
            .map(|(sought, value)| format!("-{} {}", sought.name, number(*value)))
            .collect();
        self.show(&format!("run {:>3}  {}", self.made, text.join(" ")));
        let folder = format!("run-{:03}", self.made);
        match self.case.with(&self.named(values)) {
            Ok(mut case) => {
                case.discretisation.nx *= refinement;
                case.discretisation.ny *= refinement;
                if wanted {
                    case.output.sensitivity = self.differentiable(&case);
                }
                self.run(case, &folder)
            }
            Err(error) => {
                self.show(&format!("  no such case: {error}"));
                Ok(None)
            }
        }
    }

    fn named(&self, values: &[f64]) -> Vec<(&'static str, f64)> {
        let names = self.parameters.iter().map(|sought| sought.name);
        names.zip(values.iter().copied()).collect()
    }

    /// The parameters by which a run of the case can be differentiated.
    fn differentiable(&self, case: &Case) -> Vec<&'static str> {
        let mut alone = case.clone();
        let names = self.parameters.iter().map(|sought| sought.name);
        names
            .filter(|name| {
                alone.output.sensitivity = vec![name];
                alone.parameters().is_ok()
            })
            .collect()
    }

    fn run(&mut self, mut case: Case, folder: &str) -> Result<Option<Ran>, InverseError> {
        let path = self.folder.file(folder);
        case.output.dir = path.display().to_string();
        case.output.silent = true;
        let ran = self.run_and_conclude(&case);
        let (ending, ran) = agree_in_words(&self.comm, ran).map_err(InverseError::Agreed)?;
        match ending {
            Ending::Interrupted => Err(InverseError::Interrupted),
            _ => Ok(ran),
        }
    }

    fn run_and_conclude(&self, case: &Case) -> Result<(Ending, Option<Ran>), InverseError> {
        let Some(outcome) = simulate(case, &self.comm)? else {
            return Ok((Ending::DoesNotHold, None));
        };
        let ran = outcome.failure.is_none().then(|| Ran {
            folder: case.output.dir.clone(),
            records: outcome.recorder.records().to_vec(),
            springbacks: outcome.springbacks.clone(),
            derivatives: outcome.recorder.derivatives().clone(),
        });
        let ending = conclude(case, outcome, &self.session, &self.comm)?;
        Ok((ending, ran))
    }
}
