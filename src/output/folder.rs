//! The output folder: made once, checked once, the same answer on every rank.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use mpi::traits::Communicator;

use super::error::{OutputError, agree};
use super::lock::FolderLock;
use super::{checkpoint, previous};
use crate::ranks::broadcast_bytes;

/// The table of steps.
pub(crate) const HISTORY: &str = "history.csv";
/// The fields of the sheet.
pub(crate) const FIELDS: &str = "fields.vtkhdf";
/// The tools.
pub(crate) const TOOLS: &str = "tools.vtkhdf";
/// The contact points.
pub(crate) const CONTACT: &str = "contact.vtkhdf";
/// The derivatives of the steps.
pub(crate) const SENSITIVITY: &str = "sensitivity.csv";
/// The figure of them.
const SENSITIVITY_FIGURE: &str = "sensitivity.svg";
/// How the run ended.
pub(super) const SUMMARY: &str = "summary.json";
/// The page about the run.
const REPORT: &str = "report.html";
/// The page about two runs.
const COMPARISON: &str = "comparison.html";
/// Force against stroke.
const FORCE: &str = "force.svg";
/// What the run has shown.
const LOG: &str = "run.log";
/// The model, drawn by a dry run.
const MODEL: &str = "model.svg";

/// What every run writes under the same name. All of it must be replaceable.
const FILES: [&str; 8] = [HISTORY, FIELDS, TOOLS, CONTACT, SUMMARY, REPORT, FORCE, LOG];

/// A folder that exists and takes files, as far as rank 0 could check, and into which no other run writes.
#[derive(Debug, Clone)]
pub struct OutputDir {
    path: PathBuf,
    /// On rank 0 only.
    lock: Option<Rc<FolderLock>>,
}

impl OutputDir {
    /// Makes the folder (and those above it) if needed, tries to write in it, and locks it until the last clone is
    /// dropped. Collective over `comm`: rank 0 does the work, all ranks return the same result.
    ///
    /// # Errors
    /// [`OutputError::NotAFolder`], [`OutputError::CannotCreateFolder`], [`OutputError::NotReplaceable`],
    /// [`OutputError::NotWritable`] or [`OutputError::InUse`].
    pub fn create(path: impl AsRef<Path>, comm: &impl Communicator) -> Result<Self, OutputError> {
        let path = path.as_ref();
        let mine = if comm.rank() == 0 {
            prepare(path).and_then(|()| FolderLock::take(path).map(|lock| Some(Rc::new(lock))))
        } else {
            Ok(None)
        };
        let lock = agree(comm, mine)?;
        Ok(Self {
            path: path.into(),
            lock,
        })
    }

    /// As [`OutputDir::create`] if there is something with that path; none otherwise, and nothing is made. Collective.
    ///
    /// # Errors
    /// As [`OutputDir::create`].
    pub fn existing(
        path: impl AsRef<Path>,
        comm: &impl Communicator,
    ) -> Result<Option<Self>, OutputError> {
        let path = path.as_ref();
        let found = u8::from(comm.rank() == 0 && fs::metadata(path).is_ok());
        if broadcast_bytes(comm, 0, vec![found]) == [0] {
            return Ok(None);
        }
        Self::create(path, comm).map(Some)
    }

    /// Whether the files of an earlier run may be replaced by a run that starts anew or goes on from the checkpoint
    /// `from`; if so, what is to be said first, on rank 0: lines, or nothing. Collective.
    ///
    /// # Errors
    /// [`OutputError::WouldBeLost`] unless `overwrite`.
    pub fn replace(
        &self,
        from: Option<&Path>,
        overwrite: bool,
        comm: &impl Communicator,
    ) -> Result<String, OutputError> {
        let mine = match &self.lock {
            Some(lock) => previous::replace(&self.path, from, overwrite).map(|said| {
                let warning = "warning: this file system has no locks: do not start a second run into this folder\n";
                said + if lock.holds() { "" } else { warning }
            }),
            None => Ok(String::new()),
        };
        agree(comm, mine)
    }

    /// Removes what an earlier run said about its end, its derivatives, which not every run writes, and its checkpoints newer than `step` (all, with none): a run
    /// that is killed must not leave another one's good end behind. Not collective.
    ///
    /// # Errors
    /// [`OutputError::Write`] if something cannot be removed.
    pub fn forget(&self, step: Option<u64>) -> Result<(), OutputError> {
        checkpoint::remove_newer(&self.path, step)?;
        let figure = self.sensitivity_figure();
        let png = figure.with_extension("png");
        for path in [self.summary(), self.sensitivity(), figure, png] {
            match fs::remove_file(&path) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(OutputError::write(&path, error));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file of this folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// `history.csv`, see [`super::History`].
    pub fn history(&self) -> PathBuf {
        self.file(HISTORY)
    }

    /// `fields.vtkhdf`, see [`super::SheetFile`].
    pub fn fields(&self) -> PathBuf {
        self.file(FIELDS)
    }

    /// `tools.vtkhdf`, see [`super::ToolsFile`].
    pub fn tools(&self) -> PathBuf {
        self.file(TOOLS)
    }

    /// `contact.vtkhdf`, see [`super::ContactFile`].
    pub fn contact(&self) -> PathBuf {
        self.file(CONTACT)
    }

    /// `run.log`, see [`super::Monitor::log_to`].
    pub fn log(&self) -> PathBuf {
        self.file(LOG)
    }

    /// `summary.json`, see [`super::Summary`].
    pub fn summary(&self) -> PathBuf {
        self.file(SUMMARY)
    }

    /// `report.html`, see [`super::Report`].
    pub fn report(&self) -> PathBuf {
        self.file(REPORT)
    }

    /// `comparison.html`, see [`super::TwoRuns`].
    pub fn comparison(&self) -> PathBuf {
        self.file(COMPARISON)
    }

    /// `force.svg`, see [`super::plot::force`].
    pub fn force_figure(&self) -> PathBuf {
        self.file(FORCE)
    }

    /// `sensitivity.csv`, see [`super::derivatives`].
    pub fn sensitivity(&self) -> PathBuf {
        self.file(SENSITIVITY)
    }

    /// `sensitivity.svg`, see [`super::plot::sensitivity`].
    pub fn sensitivity_figure(&self) -> PathBuf {
        self.file(SENSITIVITY_FIGURE)
    }

    /// `shape-*.svg` with the name of an instant in it, see [`super::plot::shape`].
    pub fn shape_figure(&self, label: &str) -> PathBuf {
        self.file(&format!("shape-{}.svg", label.replace(' ', "-")))
    }

    /// `model.svg`, see [`super::plot::model`].
    pub fn model_figure(&self) -> PathBuf {
        self.file(MODEL)
    }
}

/// The check itself, without MPI.
fn prepare(path: &Path) -> Result<(), OutputError> {
    match fs::metadata(path) {
        Ok(found) if !found.is_dir() => return Err(OutputError::NotAFolder { path: path.into() }),
        Ok(_) => {}
        Err(_) => fs::create_dir_all(path).map_err(|error| OutputError::CannotCreateFolder {
            path: path.into(),
            reason: error.to_string(),
        })?,
    }
    for name in FILES {
        let file = path.join(name);
        let free = match fs::metadata(&file) {
            Err(_) => Ok(()),
            Ok(found) if !found.is_file() => Err("it is not a file".to_owned()),
            Ok(_) => fs::OpenOptions::new()
                .append(true)
                .open(&file)
                .map(|_| ())
                .map_err(|error| error.to_string()),
        };
        free.map_err(|reason| OutputError::NotReplaceable { path: file, reason })?;
    }
    // Permission bits are not reliable on every file system: trying is.
    let probe = path.join(format!(".probe-{}", std::process::id()));
    let tried = File::create(&probe).and_then(|_| fs::remove_file(&probe));
    tried.map_err(|error| OutputError::NotWritable {
        path: path.into(),
        reason: error.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("ssnp155-folder-{name}-{}", std::process::id()))
    }

    #[test]
    fn a_new_folder_is_made_with_those_above_it() {
        let top = scratch("new");
        prepare(&top.join("a/b")).unwrap();
        prepare(&top.join("a/b")).unwrap();
        assert!(top.join("a/b").is_dir());
        assert_eq!(fs::read_dir(top.join("a/b")).unwrap().count(), 0);
        fs::remove_dir_all(top).unwrap();
    }

    #[test]
    fn a_file_of_that_name_is_reported() {
        let file = scratch("file");
        fs::write(&file, "").unwrap();
        assert_eq!(
            prepare(&file),
            Err(OutputError::NotAFolder { path: file.clone() })
        );
        let below = prepare(&file.join("run")).unwrap_err();
        assert!(
            matches!(below, OutputError::CannotCreateFolder { .. }),
            "{below}"
        );
        fs::remove_file(file).unwrap();
    }

    #[test]
    fn a_folder_that_takes_no_files_is_reported() {
        // /proc refuses new files to everybody, including root.
        assert!(matches!(
            prepare(Path::new("/proc")),
            Err(OutputError::NotWritable { .. })
        ));
    }
}
