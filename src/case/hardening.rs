//! The hardening laws as options: the choice of a law, and the constants of all of them.
//!
//! The laws and their constants are declared in `src/material/hardening/`; options follow from there.

use super::kind::{Kind, Problem, Real};
use super::model::{Case, Material};
use super::option::{self, Described, Group};
use crate::material::hardening::{Constant, Declaration, Hardening, LAWS, law_named};
use crate::text::show_real;

/// One of the hardening laws by its name.
pub(crate) struct Law;

impl Kind for Law {
    type Value = &'static Declaration;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        law_named(text).ok_or("this is none of the choices")
    }

    fn show(&self, value: &Self::Value) -> String {
        value.name.to_owned()
    }

    fn noun(&self) -> &'static str {
        "one of the words"
    }

    fn allowed(&self) -> String {
        let names: Vec<&str> = LAWS.iter().map(|law| law.name).collect();
        names.join(" or ")
    }
}

/// The constants of all laws, each once: laws may share some.
pub(crate) fn constants() -> impl Iterator<Item = &'static Constant> {
    let with_law = LAWS
        .iter()
        .enumerate()
        .flat_map(|(index, law)| law.constants.iter().map(move |constant| (index, constant)));
    with_law
        .filter(|(index, constant)| !LAWS[..*index].iter().any(|law| has(law, constant)))
        .map(|(_, constant)| constant)
}

/// Whether a law has this constant.
pub(crate) fn has(law: &Declaration, constant: &Constant) -> bool {
    law.constants.iter().any(|own| own.name == constant.name)
}

impl Described for Constant {
    fn name(&self) -> &'static str {
        self.name
    }
    fn unit(&self) -> &'static str {
        self.unit
    }
    fn default(&self) -> &'static str {
        self.default
    }
    fn group(&self) -> Group {
        Group::Material
    }
    fn meaning(&self) -> &'static str {
        self.meaning
    }
    fn is_real(&self) -> bool {
        true
    }
    fn is_exponent(&self) -> bool {
        self.is_exponent
    }
    fn allowed(&self) -> String {
        self.kind().allowed()
    }
    fn shown(&self, case: &Case) -> Option<String> {
        let Material {
            hardening_law: law,
            hardening_constants: values,
            ..
        } = &case.material;
        let place = law.constants.iter().position(|own| own.name == self.name)?;
        Some(show_real(*values.get(place)?))
    }
}

impl Constant {
    /// What values it can have.
    pub(crate) fn kind(&self) -> Real {
        Real(self.range.0, self.range.1)
    }
}

impl Material {
    /// The hardening law in words: its formula and constants, or the table with its pieces.
    pub fn hardening_in_words(&self) -> String {
        let law = self.hardening_law;
        if let Hardening::Table(table) = &self.hardening {
            let (pieces, last) = table.pieces();
            let factor = match self.hardening_constants[..] {
                [1.0] | [] => String::new(),
                [factor, ..] => format!(", its stresses times {}", show_real(factor)),
            };
            return format!(
                "table {} of {pieces} pieces, with its last slope beyond a plastic strain of {last:.3}{factor}",
                self.hardening_file
            );
        }
        let constants: Vec<String> = law
            .constants
            .iter()
            .zip(&self.hardening_constants)
            .map(|(constant, value)| {
                let value = option::with_unit(&show_real(*value), constant.unit);
                format!("-{} {value}", constant.name)
            })
            .collect();
        format!(
            "{}, sigma = {}, with {}",
            law.name,
            law.formula,
            constants.join(", ")
        )
    }
}
