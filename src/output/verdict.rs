//! Does the result hold? One row per quantity: computed against reference, with its own tolerance and source.

use std::fmt::{self, Write as _};

use serde::Serialize;

use crate::text::{COLUMNS, fitted, number, wrapped};

/// How far the computed value may be from the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tolerance {
    /// A fraction of the reference: |computed - reference| <= fraction x |reference|.
    Relative(f64),
    /// A distance in the unit of the quantity: |computed - reference| <= distance.
    Absolute(f64),
    /// The reference is an upper bound.
    AtMost,
    /// The reference is a lower bound.
    AtLeast,
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Relative(fraction) => write!(f, "{} %", number(100.0 * fraction)),
            Self::Absolute(distance) => write!(f, "±{}", number(*distance)),
            Self::AtMost => f.write_str("at most"),
            Self::AtLeast => f.write_str("at least"),
        }
    }
}

/// The verdict on one row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within the tolerance.
    Holds,
    /// Outside it, or not a number.
    Fails,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::Fails => "FAILS",
        })
    }
}

/// What a row compares with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Comparison {
    /// A value from outside: another code, a document, a closed solution.
    Reference,
    /// A value of our own, measured earlier: it says whether something has changed.
    Regression,
    /// A bound.
    Limit,
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reference => "reference",
            Self::Regression => "regression",
            Self::Limit => "limit",
        })
    }
}

/// One compared quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VerdictRow {
    /// What is compared, in words.
    pub quantity: String,
    /// Our value.
    pub computed: f64,
    /// The value to compare with, or the bound.
    pub reference: f64,
    /// How they are compared.
    pub tolerance: Tolerance,
    /// Unit of both values.
    pub unit: String,
    /// What kind of value the reference is.
    pub comparison: Comparison,
    /// Where the reference comes from.
    pub source: String,
    /// The outcome; it follows from the values above.
    pub verdict: Verdict,
}

impl VerdictRow {
    /// Compares. A value that is not a number fails.
    pub fn new(
        quantity: impl Into<String>,
        computed: f64,
        reference: f64,
        tolerance: Tolerance,
        unit: impl Into<String>,
        source: impl Into<String>,
    ) -> Self {
        let difference = (computed - reference).abs();
        // A NaN makes every comparison below false.
        let holds = match tolerance {
            Tolerance::Relative(fraction) => difference <= fraction * reference.abs(),
            Tolerance::Absolute(distance) => difference <= distance,
            Tolerance::AtMost => computed <= reference,
            Tolerance::AtLeast => computed >= reference,
        };
        let verdict = if holds {
            Verdict::Holds
        } else {
            Verdict::Fails
        };
        let (quantity, unit, source) = (quantity.into(), unit.into(), source.into());
        Self {
            quantity,
            computed,
            reference,
            tolerance,
            unit,
            comparison: match tolerance {
                Tolerance::Relative(_) | Tolerance::Absolute(_) => Comparison::Reference,
                Tolerance::AtMost | Tolerance::AtLeast => Comparison::Limit,
            },
            source,
            verdict,
        }
    }

    /// The same row with a reference that is our own: see [`Comparison::Regression`].
    #[must_use]
    pub fn regression(self) -> Self {
        Self {
            comparison: Comparison::Regression,
            ..self
        }
    }

    /// The value, its unit and how far from it a result may be, as in "49.9 N ±1".
    fn wanted(&self) -> String {
        let unit = match self.unit.as_str() {
            "1" | "" => String::new(),
            unit => format!(" {unit}"),
        };
        let value = number(self.reference) + &unit;
        match self.tolerance {
            Tolerance::AtMost | Tolerance::AtLeast => format!("{} {value}", self.tolerance),
            Tolerance::Absolute(_) => format!("{value} {}", self.tolerance),
            Tolerance::Relative(_) => format!("{value} ±{}", self.tolerance),
        }
    }

    fn cells(&self) -> [String; 8] {
        [
            self.comparison.to_string(),
            self.quantity.clone(),
            number(self.computed),
            number(self.reference),
            self.tolerance.to_string(),
            self.unit.clone(),
            self.source.clone(),
            self.verdict.to_string(),
        ]
    }
}

const HEADS: [&str; 8] = [
    "compared with",
    "quantity",
    "computed",
    "value",
    "tolerance",
    "unit",
    "source",
    "verdict",
];
const RIGHT_ALIGNED: [bool; 8] = [false, false, true, true, true, false, false, false];

/// All compared quantities of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct VerdictTable {
    /// The rows, in the order they are shown.
    pub rows: Vec<VerdictRow>,
}

impl VerdictTable {
    /// Whether there is something to judge and every row holds. An empty table does not hold.
    pub fn all_hold(&self) -> bool {
        !self.rows.is_empty() && self.failures() == 0
    }

    /// Number of rows that fail.
    pub fn failures(&self) -> usize {
        self.rows
            .iter()
            .filter(|row| row.verdict == Verdict::Fails)
            .count()
    }

    /// Table for a terminal: what rows are compared with stands above them. A last line counts; ends with a line break.
    pub fn text(&self) -> String {
        let heads = ["compared quantity", "computed", "value", "verdict"];
        let mut text = terminal_line(&heads.map(str::to_owned)) + &"-".repeat(COLUMNS) + "\n";
        let mut above = String::new();
        for row in &self.rows {
            let heading = format!("{}: {}\n", row.comparison, row.source);
            if heading != above {
                text.push_str(&fitted(&heading));
                above = heading;
            }
            let cells = [
                row.quantity.clone(),
                number(row.computed),
                row.wanted(),
                row.verdict.to_string(),
            ];
            text.push_str(&terminal_line(&cells));
        }
        text.push_str(&"-".repeat(COLUMNS));
        let count = self.rows.len();
        let outcome = match (count, self.failures()) {
            (0, _) => "nothing was compared".to_owned(),
            (_, 0) => format!("all {count} hold"),
            (_, failures) => format!("{failures} of {count} FAIL"),
        };
        let _ = writeln!(text, "\n{outcome}");
        text
    }

    /// The same as a Markdown table.
    pub fn markdown(&self) -> String {
        let cells: Vec<_> = self
            .rows
            .iter()
            .map(|row| row.cells().map(|cell| cell.replace('|', "\\|")))
            .collect();
        let widths = widths(&cells);
        let row = |cells: &[String; 8]| format!("| {} |\n", line(cells, &widths));
        let mut text = row(&HEADS.map(str::to_owned));
        for (width, right) in widths.iter().zip(RIGHT_ALIGNED) {
            let _ = write!(
                text,
                "|{}{}",
                "-".repeat(width + 1),
                if right { ':' } else { '-' }
            );
        }
        text.push_str("|\n");
        cells.iter().for_each(|cells| text.push_str(&row(cells)));
        text
    }
}

fn widths(rows: &[[String; 8]]) -> [usize; 8] {
    let mut widths = HEADS.map(|head| head.chars().count());
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    widths
}

fn line(cells: &[String; 8], widths: &[usize; 8]) -> String {
    let padded = cells
        .iter()
        .zip(widths)
        .zip(RIGHT_ALIGNED)
        .map(|((cell, width), right)| {
            if right {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        });
    padded.collect::<Vec<_>>().join(" | ")
}

/// Columns of the quantity and of the value it is compared with, in a terminal; with the other two they fill it.
const QUANTITY: usize = 33;
const WANTED: usize = 23;

/// A row for a terminal: quantity, computed value, what it is compared with, verdict. A long quantity takes more lines.
fn terminal_line([quantity, computed, wanted, verdict]: &[String; 4]) -> String {
    let mut parts = wrapped(quantity, QUANTITY).into_iter();
    let first = parts.next().unwrap_or_default();
    let mut text = format!("  {first:<QUANTITY$} {computed:>11}  {wanted:<WANTED$} {verdict}\n");
    parts.for_each(|part| text.push_str(&format!("    {part}\n")));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> VerdictTable {
        let document = "SSNP155 document";
        VerdictTable {
            rows: vec![
                VerdictRow::new(
                    "DY at A, punch side",
                    -28.5,
                    -28.5,
                    Tolerance::Relative(1e-3),
                    "mm",
                    document,
                ),
                VerdictRow::new(
                    "DY at A, sheet side",
                    -29.4,
                    -29.001,
                    Tolerance::Absolute(0.05),
                    "mm",
                    "version 0.1.0",
                )
                .regression(),
                VerdictRow::new(
                    "largest penetration, also between the contact points",
                    3.2e-9,
                    1e-3,
                    Tolerance::AtMost,
                    "mm",
                    "own | limit",
                ),
            ],
        }
    }

    #[test]
    fn each_kind_of_tolerance_judges_as_it_says() {
        let judge = |computed, reference, tolerance| {
            VerdictRow::new("", computed, reference, tolerance, "", "").verdict == Verdict::Holds
        };
        assert!(judge(-28.51, -28.5, Tolerance::Relative(1e-3)));
        assert!(!judge(-28.54, -28.5, Tolerance::Relative(1e-3)));
        assert!(
            judge(1.0, 1.1, Tolerance::Absolute(0.11))
                && !judge(1.0, 1.1, Tolerance::Absolute(0.09))
        );
        assert!(judge(1.0, 2.0, Tolerance::AtMost) && !judge(2.1, 2.0, Tolerance::AtMost));
        assert!(judge(0.0, -1.0, Tolerance::AtLeast) && !judge(-2.0, -1.0, Tolerance::AtLeast));
        for tolerance in [
            Tolerance::Relative(1.0),
            Tolerance::Absolute(1.0),
            Tolerance::AtMost,
            Tolerance::AtLeast,
        ] {
            assert!(!judge(f64::NAN, 1.0, tolerance), "{tolerance} accepted NaN");
        }
    }

    #[test]
    fn an_empty_table_does_not_hold() {
        assert!(!VerdictTable::default().all_hold());
        assert!(
            VerdictTable::default()
                .text()
                .ends_with("nothing was compared\n")
        );
    }

    #[test]
    fn the_text_is_aligned_and_counts_the_failures() {
        let text = table().text();
        let expected =
            "  compared quantity                    computed  value                   verdict
--------------------------------------------------------------------------------
reference: SSNP155 document
  DY at A, punch side                     -28.5  -28.5 mm ±0.1 %         holds
regression: version 0.1.0
  DY at A, sheet side                     -29.4  -29.001 mm ±0.05        FAILS
limit: own | limit
  largest penetration, also between    3.200e-9  at most 0.001 mm        holds
    the contact points
--------------------------------------------------------------------------------
1 of 3 FAIL
";
        assert_eq!(text, expected, "{text}");
    }

    #[test]
    fn the_markdown_has_as_many_columns_in_every_row() {
        let text = table().markdown();
        for line in text.lines() {
            assert_eq!(line.replace("\\|", "").matches('|').count(), 9, "{line}");
        }
        assert!(text.contains("own \\| limit") && text.contains("FAILS"));
    }
}
