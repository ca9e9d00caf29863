//! What is looked for by several runs: parameters within bounds, by a measured curve or for a wanted angle.

use super::error::CaseError;
use super::kind::{Kind, Problem, Real};
use super::model::{Case, Inverse, Restart};
use super::option::{Described, Group};
use super::table::{self, TABLE};
use crate::text::{shortened, show_real};

const NONE: &str = "none";
/// Most parameters of a design: two numbers cannot be had from one angle but by a rule which change is the least.
const MOST_DESIGNED: usize = 2;

/// A parameter that is looked for, and between what. Its start is the value of the option.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sought {
    /// Name of the option without the dash.
    pub name: &'static str,
    /// Unit of the option, or nothing.
    pub unit: &'static str,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Whether it is an exponent, a factor on a logarithm.
    pub is_exponent: bool,
}

/// Parameters with their bounds.
pub(crate) struct SoughtList;

fn parameter(name: &str) -> Option<&'static dyn Described> {
    let name = name.trim_start_matches('-');
    TABLE
        .iter()
        .copied()
        .find(|option| option.name() == name && option.is_real() && option.group().defines_model())
}

fn sought(text: &str) -> Result<Sought, Problem> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [name, lower, upper] = parts[..] else {
        return Err("each parameter is written name:lower:upper, as in hollomon_k:300:900");
    };
    let option =
        parameter(name).ok_or("a name is none of the model's options with a real number")?;
    let bound = |text: &str| text.parse().ok().filter(|bound: &f64| bound.is_finite());
    let (Some(lower), Some(upper)) = (bound(lower), bound(upper)) else {
        return Err("a bound is not a finite number");
    };
    if lower >= upper {
        return Err("a lower bound is not below its upper bound");
    }
    Ok(Sought {
        name: option.name(),
        unit: option.unit(),
        lower,
        upper,
        is_exponent: option.is_exponent(),
    })
}

impl Kind for SoughtList {
    type Value = Vec<Sought>;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        if text == NONE {
            return Ok(Vec::new());
        }
        let list = text.split(',').map(sought).collect::<Result<Vec<_>, _>>()?;
        let twice =
            |(place, one): (usize, &Sought)| list[..place].iter().any(|o| o.name == one.name);
        if list.iter().enumerate().any(twice) {
            return Err("a parameter is there twice");
        }
        Ok(list)
    }

    fn show(&self, value: &Self::Value) -> String {
        let one = |s: &Sought| format!("{}:{}:{}", s.name, show_real(s.lower), show_real(s.upper));
        match value[..] {
            [] => NONE.to_owned(),
            _ => value.iter().map(one).collect::<Vec<_>>().join(","),
        }
    }

    fn noun(&self) -> &'static str {
        "options with their bounds"
    }

    fn allowed(&self) -> String {
        format!("name:lower:upper with commas between and no spaces, or {NONE}")
    }
}

/// A path, or none.
pub(crate) struct OptionalPath;

impl Kind for OptionalPath {
    type Value = Option<String>;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        match text {
            NONE => Ok(None),
            _ if text.contains('\0') => Err("a path cannot contain a zero byte"),
            path => Ok(Some(path.to_owned())),
        }
    }

    fn show(&self, value: &Self::Value) -> String {
        value.clone().unwrap_or_else(|| NONE.to_owned())
    }

    fn noun(&self) -> &'static str {
        "a path"
    }

    fn allowed(&self) -> String {
        format!("path, or {NONE}")
    }
}

/// A real number, or none.
pub(crate) struct OptionalReal(pub(crate) Real);

impl Kind for OptionalReal {
    type Value = Option<f64>;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        match text {
            NONE => Ok(None),
            text => self.0.parse(text).map(Some),
        }
    }

    fn show(&self, value: &Self::Value) -> String {
        value.map_or_else(|| NONE.to_owned(), show_real)
    }

    fn noun(&self) -> &'static str {
        "a real number"
    }

    fn allowed(&self) -> String {
        format!("{}, or {NONE}", self.0.allowed())
    }
}

impl Inverse {
    /// Whether anything is looked for.
    pub fn is_asked(&self) -> bool {
        self.identify.is_some() || self.design.is_some()
    }
}

impl Case {
    /// The same case with nothing to be looked for.
    pub fn without_search(&self) -> Case {
        let mut case = self.clone();
        case.inverse.identify = None;
        case.inverse.design = None;
        case.inverse.parameters.clear();
        case
    }

    /// The value of an option with a real number, if this case has a use for it.
    pub fn real(&self, name: &str) -> Option<f64> {
        parameter(name)?.shown(self)?.parse().ok()
    }
}

fn refuse(problem: String) -> Result<(), CaseError> {
    let option = table::PARAMETERS.name;
    Err(CaseError::Inverse { option, problem })
}

/// Whether what is looked for fits the case.
pub(super) fn check(case: &Case) -> Result<(), CaseError> {
    let Inverse {
        identify,
        design,
        parameters,
        ..
    } = &case.inverse;
    let problem = match (identify, design, &parameters[..]) {
        (None, None, []) => return Ok(()),
        (None, None, _) => {
            "it has no effect without -identify or -design; add one of them, or leave it out"
        }
        (Some(_), Some(_), _) => {
            "-identify and -design cannot be given together; make one after the other"
        }
        (_, _, []) => {
            "there is none; name what is looked for with its bounds, as in -parameters hollomon_k:300:900"
        }
        (_, Some(_), list) if list.len() > MOST_DESIGNED => {
            "-design takes one or two; leave the others at their values"
        }
        _ if case.resuming.restart != Restart::No => {
            "-restart goes on with a single run; leave it out, the search begins anew"
        }
        _ => "",
    };
    if !problem.is_empty() {
        return refuse(problem.to_owned());
    }
    parameters.iter().try_for_each(|one| check_one(case, one))
}

fn check_one(case: &Case, sought: &Sought) -> Result<(), CaseError> {
    let Sought {
        name, lower, upper, ..
    } = *sought;
    let loading = parameter(name).is_some_and(|option| option.group() == Group::Loading);
    if loading && case.inverse.identify.is_some() {
        return refuse(format!(
            "{name} is how the test was made, and cannot be identified from it; leave it out, and set -{name}"
        ));
    }
    if let Some((owner, path)) = case.tools.replaced_by(name) {
        return refuse(format!(
            "{name} has no effect: -{owner} {} takes its place; leave one of the two out",
            shortened(path)
        ));
    }
    let Some(start) = case.real(name) else {
        return refuse(format!(
            "{name} has no effect with -hardening {}; leave it out, or choose the law it belongs to",
            case.material.hardening_law.name
        ));
    };
    if !(lower..=upper).contains(&start) {
        return refuse(format!(
            "the search starts from -{name} {}, which is not between its bounds {} and {}; change one of the three",
            show_real(start),
            show_real(lower),
            show_real(upper)
        ));
    }
    // Both ends must make a case; without what is looked for, or this would be asked again for ever.
    let plain = case.without_search();
    for bound in [lower, upper] {
        if let Err(error) = plain.with(&[(name, bound)]) {
            return refuse(format!(
                "the bound {} of {name} cannot be used: {error}",
                show_real(bound)
            ));
        }
    }
    Ok(())
}
