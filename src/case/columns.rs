//! Tables of numbers that users bring: named columns in any order, comments that begin with #, and the line to blame.

use std::path::Path;

use crate::text::{self, shortened};

/// The line to blame, if there is one, and a sentence.
pub(super) type Refusal = (Option<u64>, String);

/// What a table has to hold.
pub(super) struct Columns<const N: usize> {
    /// Names of the columns; they hold the units.
    pub names: [&'static str; N],
    /// What is said behind the names when the header is another.
    pub header: &'static str,
    /// What is said when a line has another number of columns.
    pub short_line: &'static str,
    /// Whether a column may hold a number; else what it is not, behind "is not".
    pub allows: fn(column: usize, number: f64) -> Result<(), String>,
}

/// A line of a table.
#[derive(Debug, PartialEq)]
pub(super) struct Line<const N: usize> {
    /// Its number in the file, from 1.
    pub line: u64,
    /// In the order of [`Columns::names`].
    pub numbers: [f64; N],
}

impl<const N: usize> Columns<N> {
    /// The text of the file at `path`.
    pub fn text(&self, path: &str) -> Result<String, Refusal> {
        text::read(Path::new(path)).map_err(|reason| {
            let names = self.names.join(",");
            let problem = format!(
                "the file cannot be read ({reason}); specify the path of a CSV file with the header {names}"
            );
            (None, problem)
        })
    }

    /// The lines of a table.
    pub fn lines(&self, text: &str) -> Result<Vec<Line<N>>, Refusal> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut table = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let line_of = |position: Option<&csv::Position>| position.map(|p| text::line_of(text, p));
        let malformed = |error: csv::Error| (line_of(error.position()), self.short_line.to_owned());
        let header = table.headers().map_err(malformed)?.clone();
        let places = self
            .names
            .map(|name| header.iter().position(|word| word == name));
        if header.len() != N || places.contains(&None) {
            let given = shortened(&header.iter().collect::<Vec<_>>().join(","));
            let names = self.names.join(",");
            return Err((
                None,
                format!("the header is '{given}' instead of {names}{}", self.header),
            ));
        }
        let mut lines = Vec::new();
        for row in table.records() {
            let row = row.map_err(malformed)?;
            let line = line_of(row.position());
            let mut numbers = [0.0; N];
            for (column, place) in places.into_iter().enumerate() {
                let word = place.and_then(|place| row.get(place)).unwrap_or_default();
                let number = word.parse().unwrap_or(f64::NAN);
                (self.allows)(column, number).map_err(|wanted| {
                    let name = self.names[column];
                    (
                        line,
                        format!("{name} '{}' is not {wanted}", shortened(word)),
                    )
                })?;
                numbers[column] = number;
            }
            let line = line.unwrap_or_default();
            lines.push(Line { line, numbers });
        }
        Ok(lines)
    }
}
