//! What the user gave of PETSc's options: what is refused, and what is said of the others at the start of a run.

use petsc::options;

use super::doubtful::{self, value};
use super::known::{Fate, Refusal, While, fate};
use super::{defaults, linear};
use crate::case::{Case, CaseError, condensed_option as condensed, is_own};
use crate::run::error::RunError;

/// Families of PETSc's options whose effect on a run is known; the others (logging, viewers, PETSc itself) change no result.
const FAMILIES: &[&str] = &["ts_", "snes_", "ksp_", "pc_", "mat_"];

/// How the options of solvers within solvers begin.
const INNER: &[&str] = &["sub_", "redundant_", "all_"];

/// Whose option it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SolveOf {
    /// PETSc's solve of the whole system, or what is around it.
    Whole,
    /// The solver of the condensed system.
    Condensed,
    /// A solver within one of the two.
    Inner,
}

impl SolveOf {
    /// Whose option this is, and its name without the prefix.
    pub(super) fn split(name: &str) -> (Self, &str) {
        let (mut of, mut rest) = match name.strip_prefix(condensed!("")) {
            Some(rest) => (Self::Condensed, rest),
            None => (Self::Whole, name),
        };
        while let Some(inner) = INNER.iter().find_map(|start| rest.strip_prefix(start)) {
            (of, rest) = (Self::Inner, inner);
        }
        (of, rest)
    }
}

/// The options of PETSc's families in its database, with their values: those of the user and those set here.
fn of_petsc() -> petsc::Result<Vec<(String, String)>> {
    let mut found: Vec<(String, String)> = Vec::new();
    for word in options::all()?.split_whitespace() {
        let name = word
            .strip_prefix('-')
            .filter(|name| name.starts_with(|c: char| c.is_ascii_alphabetic()));
        match (name, found.last_mut()) {
            (Some(name), _) => found.push((name.to_owned(), String::new())),
            (None, Some((_, value))) if value.is_empty() => *value = word.to_owned(),
            (None, Some((_, value))) => *value = format!("{value} {word}"),
            (None, None) => {}
        }
    }
    found.retain(|(name, _)| {
        !is_own(name)
            && FAMILIES
                .iter()
                .any(|start| SolveOf::split(name).1.starts_with(start))
    });
    Ok(found)
}

/// PETSc's options that have not the value that is set here where the user gives none.
pub(in crate::run) fn by_the_user(case: &Case) -> petsc::Result<Vec<(String, String)>> {
    let mut given = of_petsc()?;
    given.retain(|(name, value)| {
        let set_here = defaults::of_case(case)
            .iter()
            .any(|(ours, set)| ours == name && set == value);
        let value = Some(value.as_str());
        !set_here && !defaults::is_default(name, value) && !linear::is_default(name, value)
    });
    Ok(given)
}

/// Refuses the first option that is not the user's to choose.
///
/// # Errors
/// Which one, why, and what to do.
pub(super) fn refuse() -> Result<(), RunError> {
    for (option, given) in of_petsc()? {
        let refusal = match fate(&option) {
            Some(Fate::Refused(refusal)) => refusal,
            Some(Fate::RefusedWhile(while_, refusal, _))
                if !left_alone(&option)? && holds(while_, &option)? =>
            {
                refusal
            }
            Some(Fate::Drawn) if !has_display() => NO_DISPLAY,
            _ => continue,
        };
        if refusal.allowed != Some(&given) && !is_off(&given) {
            return Err(CaseError::Reserved {
                option,
                given,
                reason: refusal.reason,
                allowed: refusal.allowed,
                instead: refusal.instead,
            }
            .into());
        }
    }
    Ok(())
}

const NO_DISPLAY: Refusal = Refusal {
    allowed: None,
    reason: "it draws on a display, and DISPLAY names none",
    instead: "look at report.html",
};

fn has_display() -> bool {
    std::env::var_os("DISPLAY").is_some_and(|display| !display.is_empty())
}

fn is_off(value: &str) -> bool {
    matches!(value.to_ascii_lowercase().as_str(), "false" | "no" | "off")
}

/// A line for each option that is known to do harm, to have no effect, or that is not known, at the start of a run.
pub(in crate::run) fn report(case: &Case) -> petsc::Result<String> {
    let mut text = String::new();
    for (option, effect) in doubtful::given()? {
        text.push_str(&format!("warning: option {option}: {effect}\n"));
    }
    for (option, _) in by_the_user(case)? {
        let said = match fate(&option) {
            None => Some((
                "note",
                "is not known to this program: look whether it does what you want".to_owned(),
            )),
            Some(Fate::NoEffect(why)) => Some(("warning", format!("has no effect, {why}"))),
            Some(Fate::Unless(While::OtherPackage, _) | Fate::RefusedWhile(..))
                if left_alone(&option)? =>
            {
                Some((
                    "warning",
                    format!("has no effect {}", in_words(While::OwnSolve, "", &option)),
                ))
            }
            Some(Fate::Unless(while_, why)) => holds(while_, &option)?.then(|| {
                (
                    "warning",
                    format!("has no effect {}", in_words(while_, why, &option)),
                )
            }),
            Some(Fate::Rare(what) | Fate::RefusedWhile(_, _, what)) => {
                Some(("note", format!("matters only where {what}")))
            }
            Some(Fate::Works | Fate::Drawn | Fate::Refused(_)) => None,
        };
        if let Some((kind, said)) = said {
            text.push_str(&format!("{kind}: option -{option} {said}\n"));
        }
    }
    Ok(text)
}

fn in_words(while_: While, why: &str, option: &str) -> String {
    match while_ {
        While::OwnSolve => format!(
            "on the program's own linear solve, which reads -condensed_{option}; with -pc_type lu PETSc's solve reads it"
        ),
        _ => why.to_owned(),
    }
}

/// Whether no solver reads the option, as the linear solve is the program's own.
fn left_alone(option: &str) -> petsc::Result<bool> {
    holds(While::OwnSolve, option)
}

/// Whether what keeps an option from having an effect is the case.
fn holds(while_: While, option: &str) -> petsc::Result<bool> {
    let (of, _) = SolveOf::split(option);
    Ok(match while_ {
        While::OwnSolve => !option.starts_with(condensed!("")) && !linear::left_to_petsc()?,
        While::Direct => match of {
            SolveOf::Whole => linear::is_direct()?,
            SolveOf::Condensed => is_direct(condensed!("ksp_type"))?,
            SolveOf::Inner => {
                let solver = option.split("ksp_").next().unwrap_or_default();
                is_direct(&format!("{solver}ksp_type"))?
            }
        },
        While::OwnLineSearch => value("snes_linesearch_type")?.is_none(),
        While::NotCondensed => of != SolveOf::Condensed,
        While::OtherPackage => other_package(option)?,
        While::Without(other) => value(other)?.is_none(),
    })
}

/// Whether the solver with this option leaves the factorisation to another package, MUMPS by default.
fn other_package(option: &str) -> petsc::Result<bool> {
    let solver = option.split("pc_factor_").next().unwrap_or_default();
    let (of, _) = SolveOf::split(option);
    let exact = value(&format!("{solver}pc_type"))?
        .is_none_or(|method| matches!(method.as_str(), "lu" | "cholesky"));
    match value(&format!("{solver}pc_factor_mat_solver_type"))? {
        Some(package) => Ok(package != "petsc"),
        None => Ok(exact && of != SolveOf::Inner && petsc::has_external_package("mumps")?),
    }
}

fn is_direct(option: &str) -> petsc::Result<bool> {
    Ok(value(option)?.is_none_or(|method| method == "preonly"))
}

/// What becomes of an option of PETSc's, by its name without the dash, in a word or two; none if it is not known. For the
/// test that lists them.
pub fn fate_of_petsc_option(name: &str) -> Option<&'static str> {
    Some(match fate(name)? {
        Fate::Works | Fate::Drawn => "works",
        Fate::Rare(_) => "works, rarely",
        Fate::NoEffect(_) => "no effect",
        Fate::Unless(..) | Fate::RefusedWhile(..) => "works, by the solver",
        Fate::Refused(_) => "refused",
    })
}
