//! The reference values a run is compared with, from tables in inputs/reference, which are part of the program.

use super::error::CaseError;
use super::model::Case;
use super::table;

const FRICTIONLESS: &str = include_str!("../../inputs/reference/values.csv");
const WITH_FRICTION: &str = include_str!("../../inputs/reference/values-friction.csv");
/// Coefficient of friction of the benchmark.
const BENCHMARK_FRICTION: f64 = 0.1342;
const HEADER: [&str; 8] = [
    "id",
    "quantity",
    "unit",
    "value",
    "tolerance",
    "when",
    "origin",
    "source",
];

/// Who a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Another code, a document, a closed solution.
    Independent,
    /// This program, on this mesh or a finer one: agreement says that little has changed, or how fine this mesh is, no more.
    Own,
}

/// How far a result may be from the reference value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// In the unit of the value.
    Absolute(f64),
    /// As a share of the value's size.
    Relative(f64),
}

/// When in the run a value is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instant {
    /// While the punch goes down, when it has travelled so far, mm.
    Travel(f64),
    /// At full stroke.
    FullStroke,
    /// The largest value while the punch goes down.
    LargestWhileLoading,
    /// At the end of unloading by a tenth of the stroke.
    EndOfUnloading,
    /// When the punch is all the way out.
    Withdrawn,
}

/// A value to compare with, and its source.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceValue {
    /// Short name by which a result is matched with it.
    pub id: String,
    /// What it is, in words.
    pub quantity: String,
    /// Unit of value and absolute tolerance.
    pub unit: String,
    /// The value.
    pub value: f64,
    /// How far a result may be from it.
    pub tolerance: Tolerance,
    /// When it is taken.
    pub when: Instant,
    /// Whether it is a check from outside or a regression.
    pub origin: Origin,
    /// Who says so.
    pub source: String,
}

impl ReferenceValue {
    /// The tolerance in the unit of the value.
    pub fn allowed_deviation(&self) -> f64 {
        match self.tolerance {
            Tolerance::Absolute(deviation) => deviation,
            Tolerance::Relative(share) => share * self.value.abs(),
        }
    }

    /// Whether a result agrees within the tolerance; NaN never does.
    pub fn agrees(&self, result: f64) -> bool {
        // A result on the very edge must not fail by rounding.
        (result - self.value).abs() <= self.allowed_deviation() * (1.0 + 1e-12)
    }
}

impl Case {
    /// The reference values that belong to this case: none unless geometry, material and mesh are the benchmark's, with
    /// or without the benchmark's friction; those after unloading only for the unloading they were taken at.
    ///
    /// # Errors
    /// None unless the program's own tables are broken, which the tests exclude.
    pub fn reference_values(&self) -> Result<Vec<ReferenceValue>, CaseError> {
        let friction = self.friction.coefficient;
        let unloading = [table::UNLOAD_FRACTION.name, table::TIME_UNLOAD.name];
        let (mut same_model, mut same_unloading) = (true, true);
        for difference in self.differences_from_reference()? {
            if unloading.contains(&difference.option) {
                same_unloading = false;
            } else if difference.option != table::FRICTION_COEFFICIENT.name
                || friction != BENCHMARK_FRICTION
            {
                same_model = false;
            }
        }
        if !same_model {
            return Ok(Vec::new());
        }
        let withdrawn = self.loading.unload_fraction == 1.0;
        let mut values = parse(if friction == 0.0 {
            FRICTIONLESS
        } else {
            WITH_FRICTION
        })?;
        values.retain(|value| match value.when {
            Instant::Travel(_) | Instant::FullStroke | Instant::LargestWhileLoading => true,
            Instant::EndOfUnloading => same_unloading,
            Instant::Withdrawn => withdrawn,
        });
        Ok(values)
    }
}

fn parse(text: &str) -> Result<Vec<ReferenceValue>, CaseError> {
    let rows = rows(text, &HEADER)?;
    let mut values: Vec<ReferenceValue> = Vec::new();
    for (line, record) in rows {
        let refuse = |problem| CaseError::ReferenceValues { line, problem };
        let fields: Vec<&str> = record.iter().collect();
        let value = parse_row(&fields).map_err(refuse)?;
        if values.iter().any(|known| known.id == value.id) {
            return Err(refuse(format!("the id {} is there twice", value.id)));
        }
        values.push(value);
    }
    Ok(values)
}

/// The rows of a table with this header, each with its line. Lines that begin with # are comments.
pub(super) fn rows(
    text: &str,
    header: &[&str],
) -> Result<Vec<(u64, csv::StringRecord)>, CaseError> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut found = None;
    for record in reader.records() {
        let record = record.map_err(|error| CaseError::ReferenceValues {
            line: error.position().map_or(0, csv::Position::line),
            problem: error.to_string(),
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let refuse = |problem| Err(CaseError::ReferenceValues { line, problem });
        let Some(rows) = &mut found else {
            if record != header[..] {
                return refuse(format!("the header is not {}", header.join(",")));
            }
            found = Some(Vec::new());
            continue;
        };
        if record.len() != header.len() {
            let (given, wanted) = (record.len(), header.len());
            return refuse(format!("{given} columns instead of {wanted}"));
        }
        rows.push((line, record));
    }
    found.ok_or_else(|| CaseError::ReferenceValues {
        line: 1,
        problem: "no header".to_owned(),
    })
}

/// A value from its fields, in the order of the header.
pub(super) fn parse_row(fields: &[&str]) -> Result<ReferenceValue, String> {
    let [id, quantity, unit, value, tolerance, when, origin, source] = *fields else {
        return Err(format!("{} fields", fields.len()));
    };
    Ok(ReferenceValue {
        id: id.to_owned(),
        quantity: quantity.to_owned(),
        unit: unit.to_owned(),
        value: number(value)?,
        tolerance: match tolerance.strip_suffix('%') {
            Some(percent) => Tolerance::Relative(positive(percent.trim())? / 100.0),
            None => Tolerance::Absolute(positive(tolerance)?),
        },
        when: instant(when)?,
        origin: match origin {
            "independent" => Origin::Independent,
            "own" => Origin::Own,
            _ => return Err(format!("'{origin}' is neither independent nor own")),
        },
        source: source.to_owned(),
    })
}

/// The instant a column "when" names.
fn instant(text: &str) -> Result<Instant, String> {
    Ok(match text {
        "full stroke" => Instant::FullStroke,
        "end of unloading" => Instant::EndOfUnloading,
        "largest while loading" => Instant::LargestWhileLoading,
        "tools withdrawn" => Instant::Withdrawn,
        _ => match text.strip_prefix("d =") {
            Some(travel) => Instant::Travel(positive(travel.trim())?),
            None => {
                return Err(format!(
                    "'{text}' is none of: d = number, full stroke, largest while loading, end of unloading, tools withdrawn"
                ));
            }
        },
    })
}

fn number(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| format!("'{text}' is not a finite number"))
}

fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|value| {
        if value > 0.0 {
            Ok(value)
        } else {
            Err(format!("'{text}' is not positive"))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{any, proptest};

    fn refusal(rows: &str) -> String {
        parse(&format!("# comment\n{}\n{rows}", HEADER.join(",")))
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn malformed_tables_are_refused_with_the_line() {
        assert_eq!(
            refusal("a,b,N,1,1"),
            "reference values, line 3: 5 columns instead of 8"
        );
        assert!(
            refusal("a,b,N,x,1,full stroke,own,s").contains("line 3: 'x' is not a finite number")
        );
        assert!(refusal("a,b,N,1,-1,full stroke,own,s").contains("'-1' is not positive"));
        assert!(refusal("a,b,N,1,1,noon,own,s").contains("'noon' is none of"));
        assert!(
            refusal("a,b,N,1,1,d = 2,they,s").contains("'they' is neither independent nor own")
        );
        assert!(
            refusal("a,b,N,1,1,d = 2,own,s\na,b,N,1,1,d = 2,own,s")
                .contains("line 4: the id a is there twice")
        );
        assert!(parse("").is_err());
        assert!(
            parse("id,value\n")
                .unwrap_err()
                .to_string()
                .contains("header")
        );
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in any::<String>()) {
            let _ = parse(&text);
            let _ = parse(&format!("{}\n{text}", HEADER.join(",")));
        }
    }
}
