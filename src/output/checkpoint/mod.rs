//! Checkpoints on disk: a folder `checkpoint-<step>` is there in full or not at all, and what is in it is what was
//! written, to the last bit.
//!
//! A new one is made under another name, its files are brought to the disk, then it is renamed; the two newest are
//! kept. `manifest.txt` names the format, and every file with its size and CRC-32; its last line is the CRC-32 of the
//! lines above it. What the files hold is not known here. Nothing here is collective.

mod manifest;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::atomic::{self, sync};
pub use manifest::{FORMAT, verify};
use manifest::{MANIFEST, manifest_of};

/// How many are kept.
const KEPT: usize = 2;
const PREFIX: &str = "checkpoint-";
const UNFINISHED: &str = ".part";
const REPLACED: &str = ".old";

/// Makes the checkpoint of `step` in `folder`: `fill` writes its files into the folder it is given. Older ones than
/// the two newest are removed.
///
/// # Errors
/// Whatever `fill` returns, or [`OutputError::Write`], for example when the disk is full; nothing but complete
/// checkpoints is left then, and the earlier ones are as they were.
pub fn write(
    folder: &Path,
    step: u64,
    fill: impl FnOnce(&Path) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let path = path(folder, step);
    let unfinished = with_ending(&path, UNFINISHED);
    let made = fill_and_rename(&path, &unfinished, fill);
    if made.is_err() {
        // Best effort: the reason for the failure matters more than the leftover.
        let _ = fs::remove_dir_all(&unfinished);
    }
    made?;
    for old in complete(folder).into_iter().skip(KEPT) {
        // One too many does no harm.
        let _ = discard(&old);
    }
    Ok(())
}

/// Where the checkpoint of `step` is.
pub fn path(folder: &Path, step: u64) -> PathBuf {
    folder.join(format!("{PREFIX}{step:06}"))
}

fn fill_and_rename(
    path: &Path,
    unfinished: &Path,
    fill: impl FnOnce(&Path) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let failed = |error: std::io::Error| OutputError::write(path, error);
    let _ = fs::remove_dir_all(unfinished);
    fs::create_dir(unfinished).map_err(failed)?;
    fill(unfinished)?;
    let manifest = manifest_of(unfinished).map_err(failed)?;
    atomic::write(&unfinished.join(MANIFEST), manifest.as_bytes())?;
    let rename = || {
        sync(unfinished)?;
        let replaced = with_ending(path, REPLACED);
        if path.exists() {
            let _ = fs::remove_dir_all(&replaced);
            fs::rename(path, &replaced)?;
        }
        fs::rename(unfinished, path)?;
        let _ = fs::remove_dir_all(replaced);
        path.parent().map_or(Ok(()), sync)
    };
    rename().map_err(failed)
}

/// Removes a checkpoint under another name: a kill in between must not leave half of it under its own.
fn discard(path: &Path) -> std::io::Result<()> {
    let replaced = with_ending(path, REPLACED);
    let _ = fs::remove_dir_all(&replaced);
    fs::rename(path, &replaced)?;
    fs::remove_dir_all(replaced)
}

fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}

/// The checkpoints of `folder`, complete or damaged later, the newest first.
pub fn complete(folder: &Path) -> Vec<PathBuf> {
    let mut found = named(folder, |name| {
        name.len() >= 6 && name.bytes().all(|byte| byte.is_ascii_digit())
    });
    // The numbers may be longer than the zeros in front of them reach.
    found.sort_by_key(|path| (path.as_os_str().len(), path.clone()));
    found.reverse();
    found
}

fn named(folder: &Path, fits: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .filter(|entry| {
            let name = entry.file_name();
            let number = name.to_str().and_then(|name| name.strip_prefix(PREFIX));
            number.is_some_and(&fits)
        })
        .map(|entry| entry.path())
        .collect()
}

/// Removes the checkpoints of `folder` that are newer than `step`, and all unfinished ones: they belong to a run that
/// is being replaced. With none, all are removed.
///
/// # Errors
/// [`OutputError::Write`] if one cannot be removed.
pub fn remove_newer(folder: &Path, step: Option<u64>) -> Result<(), OutputError> {
    let leftover = |name: &str| name.ends_with(UNFINISHED) || name.ends_with(REPLACED);
    let newer = |name: &str| {
        let number = name.parse::<u64>();
        number.is_ok_and(|number| step.is_none_or(|step| number > step))
    };
    for path in named(folder, leftover) {
        fs::remove_dir_all(&path).map_err(|error| OutputError::write(&path, error))?;
    }
    for path in named(folder, newer) {
        discard(&path).map_err(|error| OutputError::write(&path, error))?;
    }
    Ok(())
}
