//! Checkpoints on disk: a folder `checkpoint-<step>` is there in full or not at all, and what is in it is what was
//! written, to the last bit.
//!
//! A new one is made under another name, its files are brought to the disk, then it is renamed; the two newest are
//! kept. `manifest.txt` names the format, and every file with its size and CRC-32; its last line is the CRC-32 of the
//! lines above it. What the files hold is not known here. Nothing here is collective.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use super::OutputError;

/// The format of all files of a checkpoint together. Another one is refused.
pub const FORMAT: u32 = 1;
/// How many are kept.
const KEPT: usize = 2;
const PREFIX: &str = "checkpoint-";
const UNFINISHED: &str = ".part";
const REPLACED: &str = ".old";
const MANIFEST: &str = "manifest.txt";
const TITLE: &str = "ssnp155 checkpoint, format ";
const LAST_LINE: &str = "checksum ";

/// Makes the checkpoint of `step` in `folder`: `fill` writes its files into the folder it is given. Older ones than
/// the two newest are removed.
///
/// # Errors
/// Whatever `fill` gives, or [`OutputError::Write`], for example when the disk is full; nothing but complete
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
        let _ = fs::remove_dir_all(old);
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
    super::atomic::write(&unfinished.join(MANIFEST), manifest.as_bytes())?;
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

fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}

/// Brings a file or the names in a folder to the disk.
fn sync(path: &Path) -> std::io::Result<()> {
    File::open(path)?.sync_all()
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
    let newer = named(folder, |name| match name.parse::<u64>() {
        Ok(number) => step.is_none_or(|step| number > step),
        Err(_) => name.ends_with(UNFINISHED) || name.ends_with(REPLACED),
    });
    for path in newer {
        fs::remove_dir_all(&path).map_err(|error| OutputError::write(&path, error))?;
    }
    Ok(())
}

fn manifest_of(folder: &Path) -> std::io::Result<String> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    let mut text = format!("{TITLE}{FORMAT}\n");
    for path in paths {
        sync(&path)?;
        let (size, sum) = size_and_checksum(&path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        text.push_str(&format!("{sum:08x} {size:>12} {name}\n"));
    }
    let sum = crc32fast::hash(text.as_bytes());
    text.push_str(&format!("{LAST_LINE}{sum:08x}\n"));
    Ok(text)
}

fn size_and_checksum(path: &Path) -> std::io::Result<(u64, u32)> {
    let mut file = File::open(path)?;
    let (mut hasher, mut size) = (crc32fast::Hasher::new(), 0);
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok((size, hasher.finalize())),
            count => {
                hasher.update(&buffer[..count]);
                size += count as u64;
            }
        }
    }
}

/// Checks that a checkpoint is of this format and holds what was written.
///
/// # Errors
/// [`OutputError::Checkpoint`] with what is wrong, in one sentence.
pub fn verify(path: &Path) -> Result<(), OutputError> {
    let refuse = |reason: String| OutputError::Checkpoint {
        path: path.into(),
        reason,
    };
    let text = fs::read(path.join(MANIFEST))
        .map_err(|error| refuse(format!("its {MANIFEST} cannot be read ({error})")))?;
    let text = String::from_utf8(text)
        .map_err(|_| refuse(format!("its {MANIFEST} is damaged: it is not text")))?;
    let damaged = || {
        refuse(format!(
            "its {MANIFEST} is damaged: the checksum is another one"
        ))
    };
    let end = text.rfind(LAST_LINE).ok_or_else(damaged)?;
    let (lines, last) = text.split_at(end);
    if last != format!("{LAST_LINE}{:08x}\n", crc32fast::hash(lines.as_bytes())) {
        return Err(damaged());
    }
    let mut lines = lines.lines();
    let format = lines.next().and_then(|line| line.strip_prefix(TITLE));
    if format != Some(&FORMAT.to_string()) {
        return Err(refuse(format!(
            "it has format {}, and this program reads format {FORMAT}",
            format.unwrap_or("unknown")
        )));
    }
    for line in lines {
        let mut words = line.split_whitespace();
        let (Some(sum), Some(size), Some(name)) = (words.next(), words.next(), words.next()) else {
            return Err(damaged());
        };
        let (found_size, found_sum) = size_and_checksum(&path.join(name))
            .map_err(|error| refuse(format!("its file {name} cannot be read ({error})")))?;
        if found_size.to_string() != size {
            return Err(refuse(format!(
                "its file {name} is damaged: it has {found_size} bytes instead of {size}"
            )));
        }
        if format!("{found_sum:08x}") != sum {
            return Err(refuse(format!(
                "its file {name} is damaged: the checksum is another one"
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [(&str, usize); 3] = [("state.h5", 5000), ("history.csv", 700), ("empty", 0)];

    fn scratch(name: &str) -> PathBuf {
        let name = format!("ssnp155-checkpoint-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Numbers without a pattern (Marsaglia's xorshift).
    struct Random(u64);

    impl Random {
        fn below(&mut self, end: usize) -> usize {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 % end as u64) as usize
        }
    }

    fn make(folder: &Path, step: u64) -> PathBuf {
        let mut random = Random(step + 1);
        write(folder, step, |to| {
            for (name, size) in FILES {
                let bytes: Vec<u8> = (0..size).map(|_| random.below(256) as u8).collect();
                fs::write(to.join(name), bytes).unwrap();
            }
            Ok(())
        })
        .unwrap();
        path(folder, step)
    }

    #[test]
    fn the_two_newest_are_kept() {
        let folder = scratch("kept");
        for step in [7, 999_999, 1_000_000, 1_000_002] {
            make(&folder, step);
        }
        let kept = [1_000_002, 1_000_000].map(|step| path(&folder, step));
        assert_eq!(complete(&folder), kept);
        make(&folder, 1_000_002);
        assert_eq!(complete(&folder), kept);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::create_dir(folder.join("checkpoint-2000000.part")).unwrap();
        assert_eq!(complete(&folder), kept);
        remove_newer(&folder, Some(1_000_000)).unwrap();
        assert_eq!(complete(&folder), kept[1..]);
        remove_newer(&folder, None).unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_could_not_be_filled_leaves_the_earlier_ones() {
        let folder = scratch("unfilled");
        let first = make(&folder, 3);
        let error = OutputError::write(&folder, "No space left on device");
        let written = write(&folder, 5, |to| {
            fs::write(to.join("state.h5"), "half").unwrap();
            Err(error.clone())
        });
        assert_eq!(written, Err(error));
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        verify(&first).unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_flipped_bit_or_a_missing_end_is_found_wherever_it_is() {
        let folder = scratch("flips");
        let made = make(&folder, 12);
        verify(&made).unwrap();
        let mut random = Random(155);
        for name in ["state.h5", "history.csv", MANIFEST] {
            let file = made.join(name);
            let whole = fs::read(&file).unwrap();
            let refused = |bytes: &[u8], what: &str| {
                fs::write(&file, bytes).unwrap();
                let error = verify(&made).unwrap_err().to_string();
                assert!(error.starts_with("the checkpoint "), "{what}: {error}");
                assert!(
                    error.contains(name) || error.contains("format"),
                    "{what}: {error}"
                );
            };
            // Every bit of the manifest, and some of the others.
            let flips: Vec<usize> = if name == MANIFEST {
                (0..8 * whole.len()).collect()
            } else {
                (0..400).map(|_| random.below(8 * whole.len())).collect()
            };
            for bit in flips {
                let mut bytes = whole.clone();
                bytes[bit / 8] ^= 1 << (bit % 8);
                refused(&bytes, &format!("{name}, bit {bit}"));
            }
            for _ in 0..100 {
                let end = random.below(whole.len());
                refused(&whole[..end], &format!("{name}, {end} bytes"));
            }
            fs::write(&file, [&whole[..], b" "].concat()).unwrap();
            assert!(verify(&made).is_err());
            fs::remove_file(&file).unwrap();
            assert!(verify(&made).is_err());
            fs::write(&file, &whole).unwrap();
        }
        verify(&made).unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn another_format_is_said_so() {
        let folder = scratch("format");
        let made = make(&folder, 1);
        let lines = format!("{TITLE}{}\n", FORMAT + 1);
        let sum = crc32fast::hash(lines.as_bytes());
        fs::write(
            made.join(MANIFEST),
            format!("{lines}{LAST_LINE}{sum:08x}\n"),
        )
        .unwrap();
        let error = verify(&made).unwrap_err().to_string();
        assert!(
            error.contains("it has format 2, and this program reads format 1"),
            "{error}"
        );
        fs::remove_dir_all(folder).unwrap();
    }
}
