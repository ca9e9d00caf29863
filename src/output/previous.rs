//! What an earlier run has left in an output folder, and whether a new one may replace it.

use std::fs;
use std::path::{Path, PathBuf};

use super::checkpoint;
use super::error::OutputError;
use super::folder::{HISTORY, SUMMARY};

/// The run whose files are in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Previous {
    Nothing,
    Finished,
    /// It could not be solved to its end, and said so.
    Failed,
    /// It was killed, and left nothing to go on from.
    CutShort,
    /// It can go on from this checkpoint.
    Interrupted(PathBuf),
}

impl Previous {
    fn found(folder: &Path) -> Self {
        let summary = fs::read(folder.join(SUMMARY)).unwrap_or_default();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
        match summary["status"].as_str() {
            Some("finished") => return Self::Finished,
            Some("not converged") => return Self::Failed,
            _ => {}
        }
        match checkpoint::complete(folder).into_iter().next() {
            Some(newest) => Self::Interrupted(newest),
            None if folder.join(HISTORY).exists() => Self::CutShort,
            None => Self::Nothing,
        }
    }
}

/// Whether the run in a folder may be replaced by one that starts anew or goes on from the checkpoint `from`, and if so,
/// what is to be said about it: a line, or nothing. With `overwrite` it always may.
///
/// # Errors
/// [`OutputError::WouldBeLost`].
pub(super) fn replace(
    folder: &Path,
    from: Option<&Path>,
    overwrite: bool,
) -> Result<String, OutputError> {
    if from.is_some_and(|checkpoint| lies_in(checkpoint, folder)) {
        return Ok(String::new());
    }
    let what = match Previous::found(folder) {
        Previous::Nothing => return Ok(String::new()),
        Previous::Finished => "a finished run".to_owned(),
        Previous::Failed => "a run that failed".to_owned(),
        Previous::CutShort => "a run that was cut short".to_owned(),
        Previous::Interrupted(checkpoint) if overwrite => {
            format!("an interrupted run and its {}", name(&checkpoint))
        }
        Previous::Interrupted(checkpoint) => {
            return Err(OutputError::WouldBeLost {
                path: folder.into(),
                checkpoint: name(&checkpoint),
            });
        }
    };
    Ok(format!("replaces {what} in {}\n", folder.display()))
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn lies_in(checkpoint: &Path, folder: &Path) -> bool {
    let above = checkpoint.canonicalize().ok();
    let above = above.as_deref().and_then(Path::parent);
    above.is_some() && above == folder.canonicalize().ok().as_deref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_interrupted_run_is_protected() {
        let folder = std::env::temp_dir().join(format!("ssnp155-previous-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let anew = |overwrite| replace(&folder, None, overwrite);
        assert_eq!(anew(false), Ok(String::new()));
        fs::write(folder.join(HISTORY), "").unwrap();
        assert!(anew(false).unwrap().contains("cut short"));
        checkpoint::write(&folder, 12, |_| Ok(())).unwrap();
        let newest = checkpoint::path(&folder, 12);
        let refused = anew(false).unwrap_err().to_string();
        for part in ["checkpoint-000012", "-restart", "-overwrite"] {
            assert!(refused.contains(part), "{refused}");
        }
        assert!(anew(true).unwrap().contains("checkpoint-000012"));
        assert_eq!(replace(&folder, Some(&newest), false), Ok(String::new()));
        let elsewhere = Path::new("/nowhere/checkpoint-000012");
        assert!(replace(&folder, Some(elsewhere), false).is_err());
        let status = |status: &str| {
            fs::write(
                folder.join(SUMMARY),
                format!("{{\"status\": \"{status}\"}}"),
            )
            .unwrap();
        };
        status("interrupted");
        assert!(anew(false).is_err());
        status("finished");
        assert!(anew(false).unwrap().contains("a finished run"));
        status("not converged");
        assert!(anew(false).unwrap().contains("failed"));
        fs::remove_dir_all(folder).unwrap();
    }
}
