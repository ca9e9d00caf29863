//! A table of points, with straight pieces between them.

use std::ops::Bound;
use std::path::Path;

use super::table_text::{self, Row};
use super::{Constant, Declaration, Hardening, Law, PlasticStep};
use crate::text;

pub(super) static LAW: Declaration = Declaration {
    name: "table",
    formula: "linear between the points of -hardening_file",
    constants: &[Constant {
        name: "table_factor",
        unit: "",
        default: "1",
        range: (Bound::Excluded(0.0), Bound::Included(1e3)),
        is_exponent: false,
        meaning: "With -hardening table: factor on the table's flow stresses at the same plastic strains.",
    }],
    build: None,
};

/// The benchmark's traction curve (SSNP155 document, section 1.2).
const BENCHMARK: &str = include_str!("../../../inputs/reference/hardening.csv");

/// Why a hardening table is refused, as one sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HardeningError {
    /// The file cannot be read as text.
    #[error(
        "hardening table {origin} cannot be read ({reason}); specify the path of a text file with the columns strain,stress"
    )]
    Unreadable {
        /// The path.
        origin: String,
        /// Why.
        reason: String,
    },
    /// The table, or a line of it, cannot be used.
    #[error("hardening table {origin}{}: {problem}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Malformed {
        /// Where the table comes from.
        origin: String,
        /// Line of the file from 1, if one is to blame.
        line: Option<usize>,
        /// What is wrong, and what is expected.
        problem: String,
    },
}

/// The straight piece that begins at plastic strain `start`; it ends where the next one begins.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    start: f64,
    /// Flow stress at the start, MPa.
    stress: f64,
    /// MPa per plastic strain, not negative.
    slope: f64,
    /// Plastic work from zero to the start, MPa.
    work: f64,
}

impl Segment {
    /// Flow stress and slope at `p` on the line through the segment.
    #[inline]
    fn at(&self, p: f64) -> (f64, f64) {
        (self.stress + self.slope * (p - self.start), self.slope)
    }
}

/// Linear between the points, beyond the last with the last slope.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// At least one; the first begins at p = 0.
    segments: Vec<Segment>,
}

impl Hardening {
    /// The law of the benchmark's table, which is part of the program. `young`: Young's modulus, MPa.
    ///
    /// # Errors
    /// The table's first point is not on the elastic line of this modulus.
    pub fn benchmark(young: f64) -> Result<Self, HardeningError> {
        Self::from_csv(BENCHMARK, "of the benchmark", young)
    }

    /// Reads a table from a file; see [`Hardening::from_csv`].
    ///
    /// # Errors
    /// The file is missing, not a regular file, longer than 1 MiB or not UTF-8 text, or the table cannot be used.
    pub fn from_file(path: &Path, young: f64) -> Result<Self, HardeningError> {
        let origin = path.display().to_string();
        match text::read(path) {
            Ok(text) => Self::from_csv(&text, &origin, young),
            Err(reason) => Err(HardeningError::Unreadable { origin, reason }),
        }
    }

    /// Reads a table `strain,stress` of total logarithmic strain and true stress (MPa) under a header of these two words;
    /// lines that begin with `#` are comments. The plastic strain of a point is strain - stress / `young` (MPa); the first
    /// point is the yield point, where it is zero. `origin` says in errors where the text comes from.
    ///
    /// # Errors
    /// A malformed table, a first point off the elastic line, plastic strains that do not increase, or a stress that
    /// decreases; each with the line.
    pub fn from_csv(text: &str, origin: &str, young: f64) -> Result<Self, HardeningError> {
        let refuse = |(line, problem)| HardeningError::Malformed {
            origin: origin.to_owned(),
            line,
            problem,
        };
        table_text::rows(text)
            .and_then(|rows| table_text::plastic_points(&rows, young))
            .map(|points| Self::Table(Table::through(&points)))
            .map_err(refuse)
    }

    /// The same from points (total logarithmic strain, true stress in MPa) in memory.
    ///
    /// # Errors
    /// As [`Hardening::from_csv`]; the line is the number of the point.
    pub fn from_points(points: &[(f64, f64)], young: f64) -> Result<Self, HardeningError> {
        let refuse = |(line, problem)| HardeningError::Malformed {
            origin: "of points".to_owned(),
            line,
            problem,
        };
        let rows: Vec<Row> = points
            .iter()
            .zip(1..)
            .map(|(&(strain, stress), line)| Row {
                line,
                strain,
                stress,
            })
            .collect();
        table_text::plastic_points(&rows, young)
            .map(|points| Self::Table(Table::through(&points)))
            .map_err(refuse)
    }
}

impl Hardening {
    /// The law with all flow stresses of a table times this factor; another law as it is.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        if let Self::Table(Table { segments }) = &mut self {
            for segment in segments {
                segment.stress *= factor;
                segment.slope *= factor;
                segment.work *= factor;
            }
        }
        self
    }
}

impl Table {
    /// Through at least two checked points (plastic strain, stress).
    fn through(points: &[(f64, f64)]) -> Self {
        let mut work = 0.0;
        let segments = points
            .windows(2)
            .map(|pair| {
                let ((start, stress), (end, end_stress)) = (pair[0], pair[1]);
                let segment = Segment {
                    start,
                    stress,
                    slope: (end_stress - stress) / (end - start),
                    work,
                };
                work += 0.5 * (stress + end_stress) * (end - start);
                segment
            })
            .collect();
        Self { segments }
    }

    /// Index of the segment that holds `p`; at a kink the one that begins there.
    #[inline]
    fn segment_at(&self, p: f64) -> usize {
        self.segments
            .partition_point(|segment| segment.start <= p)
            .saturating_sub(1)
    }

    /// Number of straight pieces, and the plastic strain at which the last of them begins.
    pub fn pieces(&self) -> (usize, f64) {
        let count = self.segments.len();
        (count, self.segments[count - 1].start)
    }
}

impl Law for Table {
    fn flow_stress(&self, p: f64) -> (f64, f64) {
        self.segments[self.segment_at(p)].at(p)
    }

    fn plastic_work(&self, p: f64) -> f64 {
        let segment = &self.segments[self.segment_at(p)];
        let along = p - segment.start;
        segment.work + along * (segment.stress + 0.5 * segment.slope * along)
    }

    /// Exact: the segments are walked one by one until the return ends within one.
    #[inline]
    fn return_map(&self, q_trial: f64, p_n: f64, three_g: f64) -> PlasticStep {
        let mut index = self.segment_at(p_n);
        let (yield_stress, slope) = self.segments[index].at(p_n);
        if q_trial <= yield_stress {
            return PlasticStep {
                dp: 0.0,
                yield_stress,
                slope,
            };
        }
        loop {
            let segment = &self.segments[index];
            let (yield_at_p_n, slope) = segment.at(p_n);
            let dp = (q_trial - yield_at_p_n) / (three_g + slope);
            match self.segments.get(index + 1) {
                Some(next) if p_n + dp >= next.start => index += 1,
                _ => {
                    return PlasticStep {
                        dp,
                        yield_stress: yield_at_p_n + slope * dp,
                        slope,
                    };
                }
            }
        }
    }
}
