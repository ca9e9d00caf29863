//! In: accepted steps and what is known of them. Out: monitor, history, fields, figures and checkpoints, through the
//! writers of the output.
//! Never: how a file is written, or a choice of the run.

mod derivatives;
mod figures;

use std::io::stdout;
use std::path::{Path, PathBuf};

use mpi::traits::Communicator;

use super::checkpoint::{Resumed, RunState, STATE};
use crate::case::{Case, ReferenceForce};
use crate::output::folder::{CONTACT, FIELDS, HISTORY, TOOLS};
use crate::output::plot::{self, DeformedElement, gather_elements};
use crate::output::{
    Arrays, ContactFile, DerivativeFile, DerivativeTable, History, Monitor, OutputDir, OutputError,
    SheetFile, SheetPart, StepRecord, ToolsFile, agree, checkpoint, history,
};
use crate::system::{ContactPointSample, NodeSample, System};
use crate::tool::PunchMotion;
use figures::outline;
pub(super) use figures::right_halves;

/// Spacing of the points of the tools in the fields, mm.
const TOOL_SPACING: f64 = 0.25;

/// All files of a run. They close when it is dropped, which must be before MPI ends.
pub struct Recorder {
    folder: OutputDir,
    monitor: Monitor<std::io::Stdout>,
    /// On rank 0 only.
    history: Option<History>,
    sheet: SheetFile,
    tools: ToolsFile,
    contact: ContactFile,
    part: SheetPart,
    motion: PunchMotion,
    every: usize,
    records: Vec<StepRecord>,
    derivatives: DerivativeTable,
    /// On rank 0 of a run with derivatives only.
    derivative_file: Option<DerivativeFile>,
}

impl Recorder {
    /// Opens the files in a folder that may be written. Collective.
    ///
    /// # Errors
    /// If a file cannot be made; the same on every rank.
    pub fn new(
        case: &Case,
        system: &System,
        resumed: Option<&Resumed>,
        folder: OutputDir,
    ) -> Result<Self, OutputError> {
        let comm = system.comm();
        let rows = resumed.map(|earlier| earlier.rows_so_far(system));
        let rows = rows.transpose()?;
        let mine = if comm.rank() == 0 {
            folder.forget(resumed.map(Resumed::steps))
        } else {
            Ok(())
        };
        agree(comm, mine)?;
        let local = system.local();
        let problem = local.problem();
        let mine = match (comm.rank(), resumed) {
            (0, None) => History::create(folder.history()).map(Some),
            (0, Some(earlier)) => {
                History::resume(folder.history(), &earlier.path.join(HISTORY)).map(Some)
            }
            _ => Ok(None),
        };
        let history = agree(comm, mine)?;
        let mut monitor = Monitor::new(comm.rank(), stdout(), case.loading.motion());
        if case.output.silent {
            monitor.silence();
        } else if case.output.quiet {
            monitor.be_quiet();
        }
        let mine = match comm.rank() {
            0 => monitor.log_to(&folder.log(), resumed.is_some()),
            _ => Ok(()),
        };
        agree(comm, mine)?;
        let points = local.contact_references();
        let part = SheetPart {
            coordinates: local.node_coordinates().to_vec(),
            quads: local.element_nodes().to_vec(),
            rank: comm.rank(),
        };
        let mut this = Self {
            monitor,
            history,
            sheet: SheetFile::create(folder.fields(), comm, &part)?,
            part,
            tools: ToolsFile::create(
                folder.tools(),
                comm,
                &outline(problem.lower_tool.as_deref(), TOOL_SPACING),
                &outline(problem.upper_tool.as_deref(), TOOL_SPACING),
            )?,
            contact: ContactFile::create(folder.contact(), comm, &points)?,
            motion: case.loading.motion(),
            every: case.output.every,
            folder,
            records: Vec::new(),
            derivatives: DerivativeTable::default(),
            derivative_file: None,
        };
        this.open_derivatives(case, resumed, comm)?;
        if let (Some(earlier), Some([nodes, points])) = (resumed, rows) {
            let earlier = &earlier.path;
            this.records = agree(comm, history::read(earlier.join(HISTORY)))?;
            this.sheet.replay(&earlier.join(FIELDS), &nodes)?;
            this.tools.replay(&earlier.join(TOOLS))?;
            this.contact.replay(&earlier.join(CONTACT), &points)?;
        }
        Ok(this)
    }

    /// Writes a checkpoint: the state of the run, which is complete on rank 0, and the tables and fields so far.
    /// Collective.
    ///
    /// # Errors
    /// If it cannot be written, for example when the disk is full; the same on every rank.
    pub(super) fn checkpoint(
        &self,
        system: &System,
        state: &RunState,
    ) -> Result<PathBuf, OutputError> {
        let step = state.counts.steps;
        let fill = |to: &Path| {
            let arrays = Arrays::create(&to.join(STATE))?;
            state.put(&arrays)?;
            arrays.close()?;
            // Every writer has put the last step into its file.
            for name in [HISTORY, FIELDS, TOOLS, CONTACT] {
                let path = to.join(name);
                std::fs::copy(self.folder.file(name), &path)
                    .map_err(|error| OutputError::write(&path, error))?;
            }
            self.copy_derivatives(to)
        };
        let mine = match self.history {
            Some(_) => checkpoint::write(self.folder.path(), step, fill),
            None => Ok(()),
        };
        agree(system.comm(), mine)?;
        Ok(checkpoint::path(self.folder.path(), step))
    }

    /// Where the files are.
    pub fn folder(&self) -> &OutputDir {
        &self.folder
    }

    /// The rows so far.
    pub fn records(&self) -> &[StepRecord] {
        &self.records
    }

    /// Closes the files; what is left is where they are, and the rows. Collective.
    pub fn close(self) -> (OutputDir, Vec<StepRecord>) {
        (self.folder, self.records)
    }

    /// Shows from where the run goes on, if it does, and the header of the step lines.
    pub fn begin(&mut self, resumed: Option<&Resumed>) {
        if let Some(earlier) = resumed {
            let (path, steps, t) = (earlier.path.display(), earlier.steps(), earlier.time());
            self.show(&format!("resumed from {path}: step {steps}, t = {t} ms\n"));
            for note in &earlier.notes {
                self.show(&format!("note: {note}\n"));
            }
        }
        self.monitor.header(resumed.map_or(0.0, Resumed::time));
    }

    /// Shows a text to the user, once over all ranks.
    pub fn show(&mut self, text: &str) {
        self.monitor.show(text);
    }

    /// As [`Recorder::show`], also to who asked for quiet: warnings, verdicts and last words.
    pub fn tell(&mut self, text: &str) {
        self.monitor.tell(text);
    }

    /// Takes an accepted step. Collective.
    ///
    /// # Errors
    /// If the history, which rank 0 writes, cannot be written; the same on every rank.
    pub fn step(
        &mut self,
        record: &StepRecord,
        comm: &impl Communicator,
    ) -> Result<(), OutputError> {
        self.monitor.step(record);
        self.records.push(*record);
        let mine = match &mut self.history {
            Some(history) => history.append(record),
            None => Ok(()),
        };
        agree(comm, mine)
    }

    /// Whether the fields of the last step are due; the ends of loading and unloading always are.
    pub fn fields_due(&self, is_end: bool) -> bool {
        is_end || (self.every > 0 && self.records.len() % self.every == 0)
    }

    /// Writes the fields at time `t` (ms). Collective.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn fields(
        &mut self,
        t: f64,
        nodes: &[NodeSample],
        points: &[ContactPointSample],
    ) -> Result<(), OutputError> {
        self.sheet.write(t, nodes)?;
        self.tools.write(t, self.motion.depth(t))?;
        self.contact.write(t, points)
    }

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
        let elements = gather_elements(system.comm(), &DeformedElement::of(&self.part, nodes));
        if self.history.is_none() {
            return Ok(());
        }
        let (depth, local) = (self.motion.depth(t), system.local());
        figures::shape(&self.folder, label, depth, &elements, local.problem())
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
