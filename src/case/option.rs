//! One option of ours: its name, unit, default, range, group and meaning, and how it is read from a source.

use std::collections::BTreeMap;

use super::error::CaseError;
use super::kind::Kind;
use super::model::Case;
use crate::text::shortened;

/// Where the texts of options come from: PETSc's option database, or a map in tests.
pub trait OptionSource {
    /// The text given for the option (its name without the dash): `None` when it was not given, an empty text when it
    /// was given without a value.
    ///
    /// # Errors
    /// [`CaseError::Unreadable`] if the source cannot be asked.
    fn get(&self, name: &str) -> Result<Option<String>, CaseError>;
}

impl OptionSource for BTreeMap<String, String> {
    fn get(&self, name: &str) -> Result<Option<String>, CaseError> {
        Ok(BTreeMap::get(self, name).cloned())
    }
}

/// The headings under which options are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Group {
    Sheet,
    Tools,
    Loading,
    Material,
    Friction,
    Discretisation,
    Stepping,
    Output,
    Resuming,
    Inverse,
}

impl Group {
    /// All groups in the order in which they are listed.
    pub(crate) const ALL: [Group; 10] = [
        Group::Sheet,
        Group::Tools,
        Group::Loading,
        Group::Material,
        Group::Friction,
        Group::Discretisation,
        Group::Stepping,
        Group::Output,
        Group::Resuming,
        Group::Inverse,
    ];

    /// The heading.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Group::Sheet => "Sheet",
            Group::Tools => "Tools",
            Group::Loading => "Loading",
            Group::Material => "Material",
            Group::Friction => "Friction",
            Group::Discretisation => "Discretisation",
            Group::Stepping => "Stepping",
            Group::Output => "Output",
            Group::Resuming => "Stop and resume",
            Group::Inverse => "Identification and design",
        }
    }

    /// Whether its options define the physics and the mesh, and not how the solution is reached and saved.
    pub(crate) fn defines_model(self) -> bool {
        !matches!(
            self,
            Group::Stepping | Group::Output | Group::Resuming | Group::Inverse
        )
    }
}

/// The declaration of an option.
pub(crate) struct Opt<K: Kind> {
    /// Name without the dash.
    pub(crate) name: &'static str,
    /// Unit, or nothing.
    pub(crate) unit: &'static str,
    /// Default as a person would write it; read like what a person writes.
    pub(crate) default: &'static str,
    pub(crate) group: Group,
    /// One sentence.
    pub(crate) meaning: &'static str,
    pub(crate) kind: K,
    /// Where the value is found in a case.
    pub(crate) value: fn(&Case) -> K::Value,
}

impl<K: Kind> Opt<K> {
    /// The value given by the source, or the default.
    pub(crate) fn read(&self, source: &dyn OptionSource) -> Result<K::Value, CaseError>
    where
        K: Sync,
    {
        read(self, &self.kind, source)
    }
}

/// The value of this kind given by the source for an option, or the option's default.
pub(crate) fn read<K: Kind>(
    option: &dyn Described,
    kind: &K,
    source: &dyn OptionSource,
) -> Result<K::Value, CaseError> {
    let given = source.get(option.name())?;
    let text = given.as_deref().unwrap_or(option.default()).trim();
    if text.is_empty() && !kind.value_may_be_missing() {
        return Err(CaseError::NoValue {
            option: option.name(),
            wanted: wanted(option, kind),
            default: option.default_with_unit(),
        });
    }
    kind.parse(text).map_err(|problem| CaseError::BadValue {
        option: option.name(),
        given: shortened(text),
        problem,
        wanted: wanted(option, kind),
        default: option.default_with_unit(),
    })
}

fn wanted(option: &dyn Described, kind: &impl Kind) -> String {
    let (noun, allowed, unit) = (kind.noun(), kind.allowed(), option.unit());
    if noun == "a path" {
        noun.to_owned()
    } else if unit.is_empty() {
        format!("{noun}: {allowed}")
    } else {
        format!("{noun} in {unit}: {allowed}")
    }
}

pub(crate) fn with_unit(value: &str, unit: &str) -> String {
    if unit.is_empty() {
        value.to_owned()
    } else {
        format!("{value} {unit}")
    }
}

/// An option whatever its kind, for help, documentation and provenance.
pub(crate) trait Described: Sync {
    fn name(&self) -> &'static str;
    fn unit(&self) -> &'static str;
    fn default(&self) -> &'static str;
    fn group(&self) -> Group;
    fn meaning(&self) -> &'static str;
    /// Whether its values are real numbers.
    fn is_real(&self) -> bool;
    /// Whether it is an exponent, a factor on a logarithm.
    fn is_exponent(&self) -> bool {
        false
    }
    /// The range or the choices.
    fn allowed(&self) -> String;
    /// The value a case has, as text; none if the case has no use for the option.
    fn shown(&self, case: &Case) -> Option<String>;
    /// The range or the choices, followed by the unit.
    fn allowed_with_unit(&self) -> String {
        with_unit(&self.allowed(), self.unit())
    }
    /// The default followed by the unit.
    fn default_with_unit(&self) -> String {
        with_unit(self.default(), self.unit())
    }
}

impl<K: Kind + Sync> Described for Opt<K> {
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
        self.group
    }
    fn meaning(&self) -> &'static str {
        self.meaning
    }
    fn is_real(&self) -> bool {
        self.kind.is_real()
    }
    fn allowed(&self) -> String {
        self.kind.allowed()
    }
    fn shown(&self, case: &Case) -> Option<String> {
        let in_use = case.tools.replaced_by(self.name).is_none();
        in_use.then(|| self.kind.show(&(self.value)(case)))
    }
}
