//! Which hardening law the sheet follows, and the constants it takes from the options.
//!
//! The laws and their constants are declared in `src/material/hardening/`; options follow from there.

use super::error::CaseError;
use super::kind::{Kind, Problem, Real};
use super::model::{Case, Material, OptionSource};
use super::option::{self, Described, Group};
use super::table;
use crate::material::hardening::{Constant, Declaration, Hardening, LAWS, law_named};
use crate::text::{shortened, show_real};

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

fn has(law: &Declaration, constant: &Constant) -> bool {
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
    fn kind(&self) -> Real {
        Real(self.range.0, self.range.1)
    }
}

/// Law, values of its constants, path of the table, and the law itself.
pub(crate) type Read = (&'static Declaration, Vec<f64>, String, Hardening);

/// Reads what the law in use needs, and refuses what belongs to another law.
pub(crate) fn read(options: &dyn OptionSource, young_modulus: f64) -> Result<Read, CaseError> {
    let law = table::HARDENING.read(options)?;
    let file = table::HARDENING_FILE.read(options)?;
    let benchmark = file == table::BENCHMARK_TABLE;
    if law.build.is_some() && !benchmark {
        return Err(CaseError::OtherLaw {
            option: table::HARDENING_FILE.name,
            given: shortened(&file),
            owner: LAWS
                .iter()
                .filter(|law| law.build.is_none())
                .map(|law| law.name)
                .collect(),
            law: law.name,
        });
    }
    for constant in constants().filter(|constant| !has(law, constant)) {
        if let Some(given) = options.get(constant.name) {
            let owners: Vec<&str> = LAWS
                .iter()
                .filter(|law| has(law, constant))
                .map(|law| law.name)
                .collect();
            return Err(CaseError::OtherLaw {
                option: constant.name,
                given: shortened(&given),
                owner: owners.join(" or "),
                law: law.name,
            });
        }
    }
    let values = law
        .constants
        .iter()
        .map(|constant| option::read(constant, &constant.kind(), options))
        .collect::<Result<Vec<f64>, CaseError>>()?;
    let hardening = match law.build {
        Some(build) => build(&values, young_modulus)?,
        None if benchmark => Hardening::benchmark(young_modulus)?,
        None => Hardening::from_file(std::path::Path::new(&file), young_modulus)?,
    };
    Ok((law, values, file, hardening))
}

impl Material {
    /// The hardening law in words: its formula and constants, or the table with its pieces.
    pub fn hardening_in_words(&self) -> String {
        let law = self.hardening_law;
        if let Hardening::Table(table) = &self.hardening {
            let (pieces, last) = table.pieces();
            return format!(
                "table {} of {pieces} pieces, with its last slope beyond a plastic strain of {last:.3}",
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
