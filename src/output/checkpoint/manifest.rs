//! The list of a checkpoint's files with their sizes and checksums: made when it is written, compared when it is read.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::output::OutputError;
use crate::output::atomic::sync;

/// The format of all files of a checkpoint together. Another one is refused.
pub const FORMAT: u32 = 2;
pub(super) const MANIFEST: &str = "manifest.txt";
pub(super) const TITLE: &str = "ssnp155 checkpoint, format ";
pub(super) const LAST_LINE: &str = "checksum ";

/// The manifest of the files in a folder, which it brings to the disk.
pub(super) fn manifest_of(folder: &Path) -> std::io::Result<String> {
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
