//! One option of ours: its name, unit, default, range, group and meaning, and how it is read from a source.

use super::error::CaseError;
use super::kind::Kind;
use super::model::{Case, OptionSource};
use crate::text::shortened;

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
}

impl Group {
    /// All groups in the order in which they are listed.
    pub(crate) const ALL: [Group; 9] = [
        Group::Sheet,
        Group::Tools,
        Group::Loading,
        Group::Material,
        Group::Friction,
        Group::Discretisation,
        Group::Stepping,
        Group::Output,
        Group::Resuming,
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
        }
    }

    /// Whether its options define the physics and the mesh, as opposed to how the solution is reached and saved.
    pub(crate) fn defines_model(self) -> bool {
        !matches!(self, Group::Stepping | Group::Output | Group::Resuming)
    }
}

/// The declaration of an option.
pub(crate) struct Opt<K: Kind> {
    /// Name without the dash.
    pub(crate) name: &'static str,
    /// Unit, or nothing.
    pub(crate) unit: &'static str,
    /// Default as a person would write it; read in the same way as what a person writes.
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
    pub(crate) fn read(&self, source: &dyn OptionSource) -> Result<K::Value, CaseError> {
        let given = source.get(self.name);
        let text = given.as_deref().unwrap_or(self.default).trim();
        let default = with_unit(self.default, self.unit);
        if text.is_empty() && !self.kind.value_may_be_missing() {
            return Err(CaseError::NoValue {
                option: self.name,
                wanted: self.wanted(),
                default,
            });
        }
        self.kind
            .parse(text)
            .map_err(|problem| CaseError::BadValue {
                option: self.name,
                given: shortened(text),
                problem,
                wanted: self.wanted(),
                default,
            })
    }

    fn wanted(&self) -> String {
        let (noun, allowed) = (self.kind.noun(), self.kind.allowed());
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(" in {}", self.unit)
        };
        if noun == "a path" {
            noun.to_owned()
        } else {
            format!("{noun}{unit}: {allowed}")
        }
    }
}

fn with_unit(value: &str, unit: &str) -> String {
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
    /// The range or the choices.
    fn allowed(&self) -> String;
    /// The value a case has, as text.
    fn shown(&self, case: &Case) -> String;
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
    fn allowed(&self) -> String {
        self.kind.allowed()
    }
    fn shown(&self, case: &Case) -> String {
        self.kind.show(&(self.value)(case))
    }
}
