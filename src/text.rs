//! Text from outside, read and quoted within bounds, and numbers as text.

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

/// The line of a row of a table with comments that begin with #: its position is before the empty lines and comments above it.
pub(crate) fn line_of(text: &str, position: &csv::Position) -> u64 {
    let first = position.line();
    let before = text.lines().skip(first.saturating_sub(1) as usize);
    let skipped = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    first + before.take_while(skipped).count() as u64
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

/// Columns of a terminal that everything shown fits.
pub(crate) const COLUMNS: usize = 80;

/// Breaks each line at spaces; a word longer than a line stays whole.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > width {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

/// The text with its lines as they are, but those that are too long for a terminal broken; what follows is set in by two
/// columns more than the line begins with.
pub(crate) fn fitted(text: &str) -> String {
    let mut fits = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let plain = line.trim_end_matches('\n');
        if plain.chars().count() <= COLUMNS {
            fits.push_str(line);
            continue;
        }
        let indent = plain.chars().take_while(|&c| c == ' ').count();
        let broken = wrapped(plain, COLUMNS.saturating_sub(indent + 2).max(20));
        for (index, part) in broken.iter().enumerate() {
            let indent = if index == 0 { indent } else { indent + 2 };
            let end = if index + 1 < broken.len() {
                "\n"
            } else {
                &line[plain.len()..]
            };
            fits.push_str(&format!("{:indent$}{part}{end}", ""));
        }
    }
    fits
}

/// A number of bytes for people.
pub(crate) fn size(bytes: u64) -> String {
    match bytes {
        0..10_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        10_000_000..10_000_000_000 => format!("{:.1} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

/// Shortest text that reads back as the same number, with an exponent where that is easier to read: a value as a person
/// would write it on the command line.
pub(crate) fn show_real(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-2..1e6).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Six significant digits without trailing zeros; powers of ten for the very small and the very large: a value in a table
/// or a sentence.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (5.0 - magnitude).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The number with this many significant digits that is nearest to `value`.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    let decimals = digits.saturating_sub(1);
    format!("{value:.decimals$e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_and_set_in() {
        let long = "word ".repeat(40);
        let text = fitted(&format!("  short   line\n  {long}\nno end"));
        assert!(text.starts_with("  short   line\n  word word"));
        assert!(text.ends_with("word\nno end"));
        assert!(text.lines().all(|line| line.chars().count() <= COLUMNS));
        assert!(text.lines().nth(2).unwrap().starts_with("    word"));
        assert_eq!(text.matches("word").count(), 40);
        assert_eq!(fitted(&"x".repeat(90)), "x".repeat(90));
    }

    #[test]
    fn numbers_keep_six_digits() {
        assert_eq!(number(180.612_345), "180.612");
        assert_eq!(number(-0.000_123_456_7), "-0.000123457");
        assert_eq!(number(1_234_567.0), "1234567");
        assert_eq!(number(2.5e-12), "2.500e-12");
        assert_eq!(number(f64::NAN), "NaN");
    }

    #[test]
    fn a_rounded_number_is_written_without_the_rest() {
        assert_eq!(show_real(3.0 * 0.1), "0.30000000000000004");
        assert_eq!(show_real(rounded(3.0 * 0.1, 6)), "0.3");
        assert_eq!(rounded(2.123_456_789, 7), 2.123_457);
        assert!(rounded(f64::NAN, 7).is_nan());
    }

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
