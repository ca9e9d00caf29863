//! Files that are either there in full or not at all: written under a new name, then renamed.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::OutputError;

/// Writes `bytes` to `path`, replacing what was there only once everything is on disk.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let unfinished = unfinished_name(path);
    let written = File::create(&unfinished)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&unfinished, path));
    written.map_err(|error| {
        // Best effort: the reason for the failure matters more than the leftover.
        let _ = fs::remove_file(&unfinished);
        OutputError::write(path, error)
    })
}

/// Writes a value as JSON, as [`write()`] does. Numbers that are not finite become `null`.
pub(crate) fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), OutputError> {
    let mut text =
        serde_json::to_vec_pretty(value).map_err(|error| OutputError::write(path, error))?;
    text.push(b'\n');
    write(path, &text)
}

/// Brings a file or the names in a folder to the disk.
pub(super) fn sync(path: &Path) -> std::io::Result<()> {
    File::open(path)?.sync_all()
}

fn unfinished_name(path: &Path) -> PathBuf {
    let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
    name.push(".part");
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_write_replaces_the_first_and_leaves_nothing_else() {
        let folder = std::env::temp_dir().join(format!("ssnp155-atomic-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("summary.json");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write(Path::new("/nowhere/at/all/x.svg"), b"").unwrap_err();
        assert!(
            error.to_string().contains("/nowhere/at/all/x.svg"),
            "{error}"
        );
    }
}
