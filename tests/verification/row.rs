//! What a case is, and the rows it answers with.

use std::error::Error;

use mpi::topology::SimpleCommunicator;

/// What goes wrong in a case is reported, not handled.
pub type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A case of the suite.
pub struct Case {
    /// Name on the command line.
    pub name: &'static str,
    /// Heading in the document.
    pub title: &'static str,
    /// What is computed, and against what.
    pub text: &'static str,
    /// Whether it runs with the other tests.
    pub quick: bool,
    /// Whether it also runs on two ranks.
    pub two_ranks: bool,
    /// Runs it.
    pub run: fn(&SimpleCommunicator) -> Result<Answer>,
}

/// What a case has to show.
#[derive(Default)]
pub struct Answer {
    /// Computed and reference values.
    pub rows: Vec<Row>,
    /// Pictures as SVG: name of the file without ending, caption, content.
    pub pictures: Vec<(&'static str, &'static str, String)>,
}

impl From<Vec<Row>> for Answer {
    fn from(rows: Vec<Row>) -> Self {
        Self {
            rows,
            pictures: Vec::new(),
        }
    }
}

/// Share of a value by which it may differ between numbers of ranks. Largest found: 1e-9, in bending; what Newton's
/// method leaves depends on the machine.
const SAME: f64 = 1e-7;
/// Below this a value that should be zero is rounding, which differs from machine to machine.
pub const ROUNDING: f64 = 1e-9;

/// A computed value beside its reference.
pub struct Row {
    /// What it is, with its unit.
    pub quantity: String,
    /// Ours.
    pub computed: f64,
    /// Theirs.
    pub reference: f64,
    /// How far the two may be apart.
    pub tolerance: f64,
    /// Whether the distance is divided by the reference.
    pub relative: bool,
    /// Author, year, equation; or how the reference was found.
    pub source: &'static str,
}

impl Row {
    /// A value that may differ by `tolerance` times the reference.
    pub fn relative(
        quantity: impl Into<String>,
        computed: f64,
        reference: f64,
        tolerance: f64,
        source: &'static str,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            computed,
            reference,
            tolerance,
            relative: true,
            source,
        }
    }

    /// A value that may differ by `tolerance` in its own unit.
    pub fn absolute(
        quantity: impl Into<String>,
        computed: f64,
        reference: f64,
        tolerance: f64,
        source: &'static str,
    ) -> Self {
        Self {
            relative: false,
            ..Self::relative(quantity, computed, reference, tolerance, source)
        }
    }

    /// Distance of the two values, as a share of the reference if the row is relative.
    pub fn error(&self) -> f64 {
        let scale = if self.relative { self.reference } else { 1.0 };
        ((self.computed - self.reference) / scale).abs()
    }

    /// Whether the error is within the tolerance; a NaN is not.
    pub fn holds(&self) -> bool {
        self.error() <= self.tolerance
    }

    /// Whether a value found with another number of ranks is the same: to [`SAME`] of its size. An error in absolute
    /// terms has no size of its own; it may differ by rounding, or by 1e-5 of its tolerance.
    pub fn is_also(&self, other: f64) -> bool {
        let size = self.computed.abs().max(self.reference.abs());
        let least = if self.relative {
            0.0
        } else {
            ROUNDING.min(self.tolerance).max(1e-5 * self.tolerance)
        };
        (self.computed - other).abs() <= (SAME * size).max(least)
    }

    /// The row for a machine.
    pub fn line(&self, case: &str) -> String {
        format!(
            "{case};{};{:e};{:e};{:.2e};{:.1e};{};{}",
            self.quantity,
            self.computed,
            self.reference,
            self.error(),
            self.tolerance,
            if self.relative {
                "relative"
            } else {
                "absolute"
            },
            if self.holds() { "ok" } else { "FAILED" },
        )
    }
}
