//! One run at a time in an output folder: an advisory lock, which the system releases when the process that holds it
//! ends, however it ends. The file may stay behind then; what counts is the lock on it.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;

use super::error::OutputError;

/// The file that is locked. It holds a line about who holds it.
pub(crate) const LOCK: &str = ".lock";
/// How often the file may vanish between its opening and its locking.
const ATTEMPTS: usize = 100;
const DAY: u64 = 86_400;

/// The right to write into a folder, until it is dropped.
#[derive(Debug)]
pub(super) struct FolderLock {
    path: PathBuf,
    /// Locked as long as it is open; none where the file system knows no locks.
    file: Option<File>,
}

impl FolderLock {
    /// Locks a folder.
    ///
    /// # Errors
    /// [`OutputError::InUse`] if another process holds it, [`OutputError::NotReplaceable`] if the file cannot be made.
    pub fn take(folder: &Path) -> Result<Self, OutputError> {
        let path = folder.join(LOCK);
        for _ in 0..ATTEMPTS {
            let opened = OpenOptions::new()
                .create(true)
                .truncate(false)
                .read(true)
                .write(true)
                .open(&path);
            let file = opened.map_err(|error| OutputError::NotReplaceable {
                path: path.clone(),
                reason: error.to_string(),
            })?;
            match flock(&file, FlockOperation::NonBlockingLockExclusive) {
                // The run that held it has removed it since: the lock is on a file without a name.
                Ok(()) if !is_at(&file, &path) => {}
                Ok(()) => {
                    say_who(&file);
                    let file = Some(file);
                    return Ok(Self { path, file });
                }
                Err(Errno::WOULDBLOCK) => return Err(in_use(folder, &path)),
                Err(_) => return Ok(Self { path, file: None }),
            }
        }
        Err(in_use(folder, &path))
    }

    /// Whether it keeps others out.
    pub fn holds(&self) -> bool {
        self.file.is_some()
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // While it is still locked; who opened it meanwhile finds it gone.
        let _ = fs::remove_file(&self.path);
    }
}

/// Whether the open file is the one with that path.
fn is_at(file: &File, path: &Path) -> bool {
    let place = |data: fs::Metadata| (data.dev(), data.ino());
    file.metadata().map(place).ok() == fs::metadata(path).map(place).ok()
}

/// Best effort: the line is for people, the lock is what counts.
fn say_who(mut file: &File) {
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let host = match host.trim() {
        "" => "this machine",
        name => name,
    };
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let since = utc(now.map_or(0, |time| time.as_secs()));
    let who = format!("process {} on {host} since {since}\n", std::process::id());
    let _ = file
        .set_len(0)
        .and_then(|()| file.seek(SeekFrom::Start(0)))
        .and_then(|_| file.write_all(who.as_bytes()));
}

fn in_use(folder: &Path, lock: &Path) -> OutputError {
    let who = fs::read_to_string(lock).unwrap_or_default();
    OutputError::InUse {
        path: folder.into(),
        holder: match who.trim() {
            "" => "another run".to_owned(),
            who => crate::text::shortened(who),
        },
    }
}

/// A time in seconds since 1970 as date and time of day.
fn utc(seconds: u64) -> String {
    let (mut days, second) = (seconds / DAY, seconds % DAY);
    let leap = |year: u64| year % 4 == 0 && year % 100 != 0 || year % 400 == 0;
    let mut year = 1970;
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let february = 28 + u64::from(leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    let day = days + 1;
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02} UTC")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(utc(0), "1970-01-01 00:00:00 UTC");
        assert_eq!(utc(951_782_399), "2000-02-28 23:59:59 UTC");
        assert_eq!(utc(951_782_400), "2000-02-29 00:00:00 UTC");
        assert_eq!(utc(1_767_225_599), "2025-12-31 23:59:59 UTC");
        assert_eq!(utc(4_107_542_400), "2100-03-01 00:00:00 UTC");
    }

    #[test]
    fn a_folder_has_one_holder_and_is_free_after_it() {
        let folder = std::env::temp_dir().join(format!("ssnp155-lock-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        // A file that a killed run left behind locks nothing.
        fs::write(folder.join(LOCK), "process 1 on nowhere, long ago\n").unwrap();
        let first = FolderLock::take(&folder).unwrap();
        assert!(first.holds());
        let refused = FolderLock::take(&folder).unwrap_err().to_string();
        let me = format!("in use by process {} on ", std::process::id());
        assert!(
            refused.contains(&me) && refused.contains(" since 2"),
            "{refused}"
        );
        assert!(!refused.contains("long ago"), "{refused}");
        drop(first);
        assert!(!folder.join(LOCK).exists());
        drop(FolderLock::take(&folder).unwrap());
        fs::remove_dir_all(folder).unwrap();
    }
}
