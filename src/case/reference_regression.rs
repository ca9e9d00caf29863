//! What this program itself computed for the cases in inputs/: a run with exactly their options must find it again.

use std::collections::BTreeMap;

use super::error::CaseError;
use super::model::Case;
use super::reference::{ReferenceValue, parse_row, rows};

const VALUES: &str = include_str!("../../inputs/reference/regression.csv");
const HEADER: [&str; 8] = [
    "case",
    "id",
    "quantity",
    "unit",
    "value",
    "tolerance",
    "when",
    "source",
];
/// The cases with regression values: names of their option files, and what these say.
const CASES: [(&str, &str); 4] = [
    ("ssnp155", include_str!("../../inputs/ssnp155.opts")),
    (
        "ssnp155-friction",
        include_str!("../../inputs/ssnp155-friction.opts"),
    ),
    (
        "ssnp155-springback",
        include_str!("../../inputs/ssnp155-springback.opts"),
    ),
    (
        "ssnp155-friction-springback",
        include_str!("../../inputs/ssnp155-friction-springback.opts"),
    ),
];

impl Case {
    /// Our own values for this case: none unless physics, mesh and steps are exactly those of an option file in
    /// inputs/ that has some. Output may differ, and so may the linear solver and the number of ranks, which change
    /// rounding only.
    ///
    /// # Errors
    /// None unless the program's own tables are broken, which the tests exclude.
    pub fn regression_values(&self) -> Result<Vec<ReferenceValue>, CaseError> {
        for (name, options) in CASES {
            if self.is_computed_as(&Case::read(&given(options))?) {
                return values(VALUES, name);
            }
        }
        Ok(Vec::new())
    }

    /// Whether nothing differs that the computed values depend on.
    fn is_computed_as(&self, other: &Case) -> bool {
        let options = other.options().into_iter();
        let saved = options
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
        let (model, steps) = self.differences_from_saved(&saved);
        model.is_empty()
            && steps.is_empty()
            && self.material.hardening == other.material.hardening
            && self.tool_marks() == other.tool_marks()
    }
}

/// The options in an option file that holds options of ours only.
fn given(file: &str) -> BTreeMap<String, String> {
    file.lines()
        .filter_map(|line| {
            let mut words = line.split('#').next()?.split_whitespace();
            let name = words.next()?.strip_prefix('-')?;
            Some((name.to_owned(), words.next().unwrap_or_default().to_owned()))
        })
        .collect()
}

/// The values of a case.
fn values(text: &str, case: &str) -> Result<Vec<ReferenceValue>, CaseError> {
    let mut found: Vec<ReferenceValue> = Vec::new();
    for (line, record) in rows(text, &HEADER)? {
        let refuse = |problem| CaseError::ReferenceValues { line, problem };
        let fields: Vec<&str> = record.iter().collect();
        let [name, id, quantity, unit, value, tolerance, when, source] = fields[..] else {
            return Err(refuse(format!("{} columns", fields.len())));
        };
        if CASES.iter().all(|(known, _)| *known != name) {
            return Err(refuse(format!("no case is called {name}")));
        }
        let fields = [id, quantity, unit, value, tolerance, when, "own", source];
        let value = parse_row(&fields).map_err(refuse)?;
        if name != case {
            continue;
        }
        if found.iter().any(|known| known.id == value.id) {
            return Err(refuse(format!("the id {} is there twice", value.id)));
        }
        found.push(value);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::super::reference::{Instant, Origin, Tolerance};
    use super::*;

    #[test]
    fn every_case_has_values_and_they_are_tight_before_the_snap() {
        for (name, options) in CASES {
            let case = Case::read(&given(options)).unwrap();
            let values = case.regression_values().unwrap();
            assert_eq!(values, super::values(VALUES, name).unwrap());
            let tight = |value: &&ReferenceValue| match (value.when, value.tolerance) {
                (Instant::Travel(depth), Tolerance::Relative(share)) => {
                    depth <= 20.0 && share <= 1e-8
                }
                _ => false,
            };
            assert!(values.iter().filter(tight).count() >= 5, "{name}");
            for value in &values {
                assert_eq!(value.origin, Origin::Own);
                assert!(value.source.contains("ssnp155"), "{name}: {}", value.source);
            }
        }
    }

    #[test]
    fn only_a_run_with_the_very_options_has_values() {
        let reference = Case::reference().unwrap();
        let has = |change: &dyn Fn(&mut Case)| {
            let mut case = reference.clone();
            change(&mut case);
            !case.regression_values().unwrap().is_empty()
        };
        assert!(has(&|_| ()));
        assert!(has(&|case| case.output.every = 7));
        assert!(has(&|case| case.resuming.checkpoint_every = 3));
        assert!(!has(&|case| case.stepping.dt_max = 3.0));
        assert!(!has(&|case| case.stepping.report_strokes = vec![1.0]));
        assert!(!has(&|case| case.discretisation.nx = 85));
        assert!(!has(&|case| case.friction.coefficient = 0.1));
        assert!(has(&|case| case.friction.coefficient = 0.1342));
    }

    #[test]
    fn a_broken_table_is_refused_with_the_line() {
        let header = HEADER.join(",");
        let refusal = |row: &str| {
            values(&format!("{header}\n{row}"), "ssnp155")
                .unwrap_err()
                .to_string()
        };
        assert!(refusal("other,a,b,N,1,1 %,d = 1,s").contains("line 2: no case is called other"));
        assert!(refusal("ssnp155,a,b,N,x,1 %,d = 1,s").contains("'x' is not a finite number"));
        let twice = "ssnp155,a,b,N,1,1 %,d = 1,s\nssnp155,a,b,N,1,1 %,d = 1,s";
        assert!(refusal(twice).contains("line 3: the id a is there twice"));
    }
}
