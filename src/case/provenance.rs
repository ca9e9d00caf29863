//! What a case says about itself: all effective options, and how far it is from the reference case.

use std::collections::BTreeMap;

use super::error::CaseError;
use super::model::Case;
use super::option::{Described, Group};
use super::table::{self, TABLE};

/// An option whose value is not that of the reference case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Name without the dash.
    pub option: &'static str,
    /// Value of this case.
    pub value: String,
    /// Value of the reference case.
    pub reference: String,
}

/// Options whose value is a path of the model: what the file says counts, not where it lies.
const FILES: [&str; 3] = [
    table::HARDENING_FILE.name,
    table::PUNCH_PROFILE.name,
    table::DIE_PROFILE.name,
];

impl Case {
    /// Every option the case has a use for, with the value in effect, in the order of the table. Read again, they give the
    /// same case.
    pub fn options(&self) -> Vec<(&'static str, String)> {
        TABLE
            .iter()
            .filter_map(|option| Some((option.name(), option.shown(self)?)))
            .collect()
    }

    /// [`Case::options`] as a source that can be read again.
    pub(super) fn saved(&self) -> BTreeMap<String, String> {
        let options = self.options().into_iter();
        options
            .map(|(name, value)| (name.to_owned(), value))
            .collect()
    }

    /// How this case differs from another one that was saved by [`Case::options`]: where physics or mesh differ, and where
    /// only the way to the solution does. The value of the other case is called the reference. Paths of hardening tables
    /// and of tools are not compared.
    pub fn differences_from_saved(
        &self,
        saved: &BTreeMap<String, String>,
    ) -> (Vec<Difference>, Vec<Difference>) {
        let compared = |option: &&&dyn Described| {
            let group = option.group();
            (group.defines_model() || group == Group::Stepping) && !FILES.contains(&option.name())
        };
        TABLE
            .iter()
            .filter(compared)
            .filter_map(|option| {
                // Constants of another law than that of this case are not shown: the law itself differs then.
                let value = option.shown(self)?;
                // A case saved before there was the option had what is the default now.
                let then = saved
                    .get(option.name())
                    .map_or(option.default(), |then| then);
                Some((
                    option.group().defines_model(),
                    Difference {
                        option: option.name(),
                        value,
                        reference: then.to_owned(),
                    },
                ))
            })
            .filter(|(_, difference)| difference.value != difference.reference)
            .fold((Vec::new(), Vec::new()), |mut both, (model, difference)| {
                if model {
                    both.0.push(difference)
                } else {
                    both.1.push(difference)
                }
                both
            })
    }

    /// The options that make physics or mesh differ from the reference case; time steps, tolerances and output may differ
    /// freely. A hardening table counts by its curve and a tool by its outline, not by their paths.
    ///
    /// # Errors
    /// None unless the program's own table is broken, which the tests exclude.
    pub fn differences_from_reference(&self) -> Result<Vec<Difference>, CaseError> {
        let reference = Case::reference()?;
        let [die, punch] = self.benchmark_files();
        let same = |option: &str| match option {
            _ if option == table::HARDENING_FILE.name => {
                self.material.hardening == reference.material.hardening
            }
            _ if option == table::DIE_PROFILE.name => die,
            _ if option == table::PUNCH_PROFILE.name => punch,
            _ => false,
        };
        let differences = TABLE
            .iter()
            .filter(|option| option.group().defines_model())
            .filter(|option| !same(option.name()))
            .filter_map(|option| {
                Some(Difference {
                    option: option.name(),
                    value: option.shown(self)?,
                    reference: option
                        .shown(&reference)
                        .unwrap_or_else(|| "not used".to_owned()),
                })
            })
            .filter(|difference| difference.value != difference.reference);
        Ok(differences.collect())
    }
}
