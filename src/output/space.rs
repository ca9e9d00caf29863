//! Room on the disk, reserved before it is written to.
//!
//! A disk that is full in the middle of a step would leave a file that nobody can read, and with MPI-IO, which once wrote the
//! fields, ranks that wait for each other. So what the next write can need is reserved first, and all ranks hear the answer.
//! What a write leaves of its reservation counts for the next one, and is not a part of the file.

use std::fs::File;
use std::path::Path;

use rustix::fs::{FallocateFlags, fallocate, statvfs};
use rustix::io::{Errno, retry_on_intr};

use super::OutputError;
use crate::text;

/// What HDF5 may add for a dataset besides its values, bytes: its header, or a node on each of three levels of its index
/// (2.6 kB each).
pub(super) const BESIDE_VALUES: u64 = 8192;

/// Sees to it that a file can grow by `bytes`. Not collective: for one of the ranks.
///
/// # Errors
/// [`OutputError::NoSpace`] if the disk or a quota does not allow it, [`OutputError::Write`] if there is no such file.
pub(super) fn reserve_behind(path: &Path, bytes: u64) -> Result<(), OutputError> {
    let data = std::fs::metadata(path).map_err(|error| OutputError::write(path, error))?;
    reserve(path, data.len(), bytes)
}

/// Sees to it that the file can be written from its byte `from` on for `bytes`, whatever it has of them.
///
/// # Errors
/// As [`reserve_behind`].
pub(super) fn reserve(path: &Path, from: u64, bytes: u64) -> Result<(), OutputError> {
    let file = File::options().write(true).open(path);
    let file = file.map_err(|error| OutputError::write(path, error))?;
    match retry_on_intr(|| fallocate(&file, FallocateFlags::KEEP_SIZE, from, bytes)) {
        Ok(()) => Ok(()),
        Err(Errno::NOSPC) => Err(lacking(path, bytes, &left(path))),
        Err(Errno::DQUOT) => Err(lacking(path, bytes, "the quota leaves less")),
        // Not every file system reserves (NFS before 4.2 does not); all of them can be asked.
        Err(_) => match free(path) {
            Some(free) if free < bytes => Err(lacking(path, bytes, &left(path))),
            _ => Ok(()),
        },
    }
}

fn lacking(path: &Path, bytes: u64, what_is_left: &str) -> OutputError {
    let reason = format!("it needs {} more, and {what_is_left}", text::size(bytes));
    OutputError::NoSpace {
        path: path.into(),
        reason,
    }
}

fn left(path: &Path) -> String {
    let size = free(path).map_or("less".to_owned(), text::size);
    format!("the disk has {size} left")
}

/// Bytes that this user may still write to the file system of `path`, if it tells.
fn free(path: &Path) -> Option<u64> {
    let found = statvfs(path).ok().filter(|found| found.f_blocks > 0)?;
    Some(found.f_bavail * found.f_frsize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_disk_holds_is_refused_and_the_file_keeps_its_size() {
        let path = std::env::temp_dir().join(format!("ssnp155-space-{}", std::process::id()));
        std::fs::write(&path, b"here").unwrap();
        reserve_behind(&path, 10_000).unwrap();
        let refused = reserve_behind(&path, 1 << 50).unwrap_err();
        assert!(matches!(refused, OutputError::NoSpace { .. }), "{refused}");
        let sentence = refused.to_string();
        for part in [path.to_str().unwrap(), "needs 1125899.9 GB more", " left;"] {
            assert!(sentence.contains(part), "{sentence}");
        }
        assert_eq!(std::fs::read(&path).unwrap(), b"here");
        std::fs::remove_file(path).unwrap();
    }
}
