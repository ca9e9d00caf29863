//! The parameters by which a run can be differentiated: those of the model that the solution follows without a jump.

use super::error::CaseError;
use super::hardening::constants;
use super::kind::{Kind, Problem, Real};
use super::model::Case;
use super::option::Opt;
use super::table;
use crate::text::{shortened, show_real};

/// Names of parameters with commas between; the word none means an empty list.
pub(crate) struct Parameters;

const NONE: &str = "none";

/// The options that are parameters besides the constants of the hardening laws.
static OPTIONS: [&Opt<Real>; 7] = [
    &table::PUNCH_RADIUS,
    &table::DIE_RADIUS,
    &table::DIE_SHOULDER_RADIUS,
    &table::SHEET_THICKNESS,
    &table::YOUNG_MODULUS,
    &table::FRICTION_COEFFICIENT,
    &table::CONTACT_COMPLIANCE,
];

/// A parameter of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The option's name without the dash.
    pub name: &'static str,
    /// Its unit, or nothing.
    pub unit: &'static str,
    /// Its value in the case.
    pub value: f64,
}

impl Kind for Parameters {
    type Value = Vec<&'static str>;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        let mut names = Vec::new();
        if text == NONE {
            return Ok(names);
        }
        for word in text.split(',').map(str::trim) {
            let known = OPTIONS.iter().map(|option| option.name);
            let name = known
                .chain(constants().map(|constant| constant.name))
                .find(|name| *name == word.trim_start_matches('-'))
                .ok_or("this is not a list of parameters with a derivative")?;
            if names.contains(&name) {
                return Err("a parameter is there twice");
            }
            names.push(name);
        }
        Ok(names)
    }

    fn show(&self, value: &Self::Value) -> String {
        if value.is_empty() {
            return NONE.to_owned();
        }
        value.join(",")
    }

    fn noun(&self) -> &'static str {
        "names of options with commas between and no spaces"
    }

    fn allowed(&self) -> String {
        let names: Vec<&str> = OPTIONS.iter().map(|option| option.name).collect();
        let constants: Vec<&str> = constants().map(|constant| constant.name).collect();
        format!(
            "{}, constants of the hardening law in use ({}), or {NONE}",
            names.join(", "),
            constants.join(", ")
        )
    }
}

impl Case {
    /// The parameters of `-sensitivity` with their values.
    ///
    /// # Errors
    /// [`CaseError::NoDerivative`] for a constant of another hardening law, or a parameter that is 0.
    pub fn parameters(&self) -> Result<Vec<Parameter>, CaseError> {
        let parameter = |&name: &&'static str| self.parameter(name);
        self.output.sensitivity.iter().map(parameter).collect()
    }

    fn parameter(&self, name: &'static str) -> Result<Parameter, CaseError> {
        let refuse = |reason: String| Err(CaseError::NoDerivative { name, reason });
        if let Some((owner, path)) = self.tools.replaced_by(name) {
            return refuse(format!(
                "-{owner} {} takes the place of -{name}, and a tool from a file has no parameter; leave it out",
                shortened(path)
            ));
        }
        let law = self.material.hardening_law;
        let (unit, value) = match OPTIONS.iter().find(|option| option.name == name) {
            Some(option) => (option.unit, (option.value)(self)),
            None => {
                let values = law.constants.iter().zip(&self.material.hardening_constants);
                let mut found = values.filter(|(constant, _)| constant.name == name);
                let Some((constant, value)) = found.next() else {
                    return refuse(format!(
                        "it is no constant of the law in use, -hardening {}; leave it out, or choose its law",
                        law.name
                    ));
                };
                (constant.unit, *value)
            }
        };
        if value == 0.0 {
            return refuse(format!(
                "the derivative at 0 would be one-sided, and -{name} is 0; leave it out, or use a value above 0"
            ));
        }
        Ok(Parameter { name, unit, value })
    }

    /// The same case with other values of some real options, by name without the dash, read and checked anew.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub fn with(&self, changes: &[(&str, f64)]) -> Result<Case, CaseError> {
        let mut options = self.saved();
        for (name, value) in changes {
            options.insert((*name).to_owned(), show_real(*value));
        }
        Case::read(&options)
    }

    /// The case that differs in one parameter, by this share of its value. It has no parameters itself.
    ///
    /// # Errors
    /// [`CaseError::NoDerivative`] if there is no case with that value.
    pub fn beside(&self, parameter: &Parameter, share: f64) -> Result<Case, CaseError> {
        let mut plain = self.clone();
        plain.output.sensitivity.clear();
        let changed = plain.with(&[(parameter.name, parameter.value * (1.0 + share))]);
        changed.map_err(|error| CaseError::NoDerivative {
            name: parameter.name,
            reason: format!("values on both sides of it are needed, and beside it {error}"),
        })
    }
}
