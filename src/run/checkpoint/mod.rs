//! In: the checkpoint the options ask for. Out: the state of the run it holds, if it is whole and belongs to this case.
//! Never: how a checkpoint lies on the disk (`output::checkpoint`), or how the time stepper takes it over
//! (`simulation::resume`).

mod derivatives;
mod state;

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::error::{RestartError, RunError};
use crate::case::{Case, Difference, Restart};
use crate::material::Hardening;
use crate::output::{Arrays, OutputError, agree, checkpoint};
use crate::ranks::broadcast_bytes;
use crate::sensitivity::Kept;
use crate::system::{History, System};

pub(super) use state::RunState;

/// The file of a checkpoint that holds the numbers.
pub(super) const STATE: &str = "state.h5";

/// A checkpoint to go on from.
pub struct Resumed {
    /// Its folder.
    pub path: PathBuf,
    pub(super) state: RunState,
    /// What the user should know about it, a line each.
    pub notes: Vec<String>,
}

impl Resumed {
    /// What the runs so far have cost: time of processors and on the clock, s.
    pub(super) fn spent(&self) -> [f64; 2] {
        self.state.spent
    }

    /// Accepted steps so far.
    pub fn steps(&self) -> u64 {
        self.state.counts.steps
    }

    /// Time of the last of them, ms.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// The derivatives, if it holds any.
    pub(super) fn derivatives(&self) -> Option<&Kept> {
        self.state.derivatives.as_ref()
    }

    /// The history of the system's material and contact points.
    pub(super) fn history(&self, system: &System) -> Result<History, OutputError> {
        let restored = self.state.snapshot.restore(system);
        restored.map_err(|error| OutputError::Checkpoint {
            path: self.path.clone(),
            reason: error.to_string(),
        })
    }

    /// For each of this rank's nodes and of its contact points, the row that has it in the field files so far.
    /// Collective.
    pub(super) fn rows_so_far(&self, system: &System) -> Result<[Vec<usize>; 2], OutputError> {
        let now = system.own_file_numbers();
        let find = |now: &[usize], then: &[u64]| -> Option<Vec<usize>> {
            let rows: HashMap<u64, usize> =
                then.iter().enumerate().map(|(row, &n)| (n, row)).collect();
            now.iter()
                .map(|&n| rows.get(&(n as u64)).copied())
                .collect()
        };
        let [nodes, points] = &self.state.file_rows;
        let found = find(&now[0], nodes).zip(find(&now[1], points));
        let mine = found.map(|(nodes, points)| [nodes, points]);
        let path = self.path.clone();
        let reason = "its field files have other points".to_owned();
        agree(
            system.comm(),
            mine.ok_or(OutputError::Checkpoint { path, reason }),
        )
    }
}

/// The checkpoint the case asks for, if it asks for one. Rank 0 chooses and checks, every rank reads. Collective.
///
/// # Errors
/// If there is none, it is damaged, or it belongs to another problem; nothing has been changed then.
pub(super) fn open(case: &Case, comm: &SimpleCommunicator) -> Result<Option<Resumed>, RunError> {
    let folder = Path::new(&case.output.dir);
    let candidates = match &case.resuming.restart {
        Restart::No => return Ok(None),
        Restart::From(path) => vec![PathBuf::from(path)],
        // The folder may change while the ranks look at it: rank 0 does, and says how many there are.
        Restart::Newest => checkpoint::complete(folder),
    };
    let chosen = if comm.rank() == 0 {
        first_whole(&candidates)
    } else {
        Ok(Choice::default())
    };
    let mut choice = agree(comm, chosen)?;
    broadcast(comm, &mut choice.path);
    broadcast(comm, &mut choice.notes);
    if choice.path.is_empty() {
        let folder = folder.into();
        return Err(RestartError::None { folder }.into());
    }
    let path = PathBuf::from(choice.path);
    let read = Arrays::open(&path.join(STATE)).and_then(|file| RunState::get(&file));
    let state = agree(comm, read)?;
    derivatives::check(case, &path, &state)?;
    let mut notes: Vec<String> = choice.notes.lines().map(str::to_owned).collect();
    notes.extend(compare(case, &path, &state)?);
    Ok(Some(Resumed { path, state, notes }))
}

#[derive(Default)]
struct Choice {
    /// Empty if there is none.
    path: String,
    /// One line for each that is damaged.
    notes: String,
}

/// The first of the checkpoints that is whole. If none is, what is wrong with the first.
fn first_whole(candidates: &[PathBuf]) -> Result<Choice, OutputError> {
    let mut choice = Choice::default();
    let mut first_error = None;
    for path in candidates {
        match checkpoint::verify(path) {
            Ok(()) => {
                choice.path = path.display().to_string();
                return Ok(choice);
            }
            Err(error) => {
                choice
                    .notes
                    .push_str(&format!("{error}; the one before is taken\n"));
                first_error.get_or_insert(error);
            }
        }
    }
    first_error.map_or(Ok(choice), Err)
}

/// Rank 0's text on every rank. Collective.
fn broadcast(comm: &SimpleCommunicator, text: &mut String) {
    let bytes = broadcast_bytes(comm, 0, std::mem::take(text).into_bytes());
    *text = String::from_utf8_lossy(&bytes).into_owned();
}

/// The checksum by which a checkpoint knows the hardening curve: the shortest texts of its numbers contain all their bits.
pub(super) fn hardening_checksum(case: &Case) -> u32 {
    crc32fast::hash(format!("{:?}", case.material.hardening).as_bytes())
}

/// The checksums by which it knows the outlines of die and punch, likewise; 0 for the benchmark's.
pub(super) fn tool_checksums(case: &Case) -> [u32; 2] {
    case.tool_marks()
        .map(|mark| crc32fast::hash(mark.as_bytes()))
}

/// Refuses the checkpoint of another problem; says what else is not as it was.
fn compare(case: &Case, path: &Path, state: &RunState) -> Result<Vec<String>, RestartError> {
    let (mut problem, stepping) = case.differences_from_saved(&state.options);
    // The constants of other laws are options, so differences in them are known already.
    let tables = matches!(case.material.hardening, Hardening::Table(_))
        && !problem.iter().any(|known| known.option == "hardening");
    if tables && state.hardening != hardening_checksum(case) {
        let path = |path: Option<&String>| format!("the curve of {}", path.map_or("?", |p| p));
        problem.push(Difference {
            option: "hardening_file",
            value: path(Some(&case.material.hardening_file)),
            reference: path(state.options.get("hardening_file")),
        });
    }
    let now = tool_checksums(case);
    let paths: BTreeMap<&str, String> = case.options().into_iter().collect();
    for (index, option) in ["die_profile", "punch_profile"].into_iter().enumerate() {
        if state.tools[index] != now[index] {
            let path = |path: Option<&String>| {
                format!("the outline of {}", path.map_or("benchmark", |path| path))
            };
            problem.push(Difference {
                option,
                value: path(paths.get(option)),
                reference: path(state.options.get(option)),
            });
        }
    }
    let list = |differences: &[Difference]| {
        let one = |d: &Difference| format!("-{} was {} and is {}", d.option, d.reference, d.value);
        differences.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    if !problem.is_empty() {
        return Err(RestartError::OtherProblem {
            path: path.into(),
            differences: list(&problem),
        });
    }
    let mut notes = Vec::new();
    if !stepping.is_empty() {
        notes.push(format!(
            "from here on the steps are chosen otherwise: {}",
            list(&stepping)
        ));
    }
    let revision = env!("SSNP155_REVISION");
    if state.revision != revision {
        let then = &state.revision;
        notes.push(format!(
            "the checkpoint was written by revision {then}, this is {revision}"
        ));
    }
    Ok(notes)
}
