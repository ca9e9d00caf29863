//! Text from outside, read and quoted within bounds, and numbers as a person would write them.

use std::io::Read;
use std::path::Path;

/// A text file of options or points that is longer than this is not what it is taken for.
const MOST_BYTES: u64 = 1 << 20;

/// The text of a regular file of at most 1 MiB. A pipe or a device is refused, because reading it may never end.
///
/// # Errors
/// Why not, in words that fit in brackets.
pub(crate) fn read(path: &Path) -> Result<String, String> {
    let found = std::fs::metadata(path).map_err(|error| error.to_string())?;
    if found.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if !found.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err("it is longer than 1 MiB".to_owned());
    }
    if bytes.contains(&0) {
        return Err("it holds a zero byte, so it is no text".to_owned());
    }
    String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".to_owned())
}

/// The beginning of a text that may be anything, on one line.
pub(crate) fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    let plain = |c: char| {
        if c.is_control() {
            c.escape_default().to_string()
        } else {
            c.to_string()
        }
    };
    let short: String = text.chars().take(MOST).map(plain).collect();
    if text.chars().nth(MOST).is_some() {
        short + "..."
    } else {
        short
    }
}

/// Shortest text that reads back as the same number, with an exponent where that is shorter to read.
pub(crate) fn show_real(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-2..1e6).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_ends_is_not_begun() {
        assert_eq!(
            read(Path::new("/dev/zero")),
            Err("it is not a regular file".to_owned())
        );
    }

    #[test]
    fn a_quotation_stays_on_one_line_and_short() {
        assert_eq!(shortened("a\nb\u{1b}[2J"), "a\\nb\\u{1b}[2J");
        assert_eq!(shortened(&"ü".repeat(60)), "ü".repeat(60));
        assert_eq!(shortened(&"ü".repeat(61)), "ü".repeat(60) + "...");
    }
}
