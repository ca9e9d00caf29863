//! What becomes of each option of PETSc's that the objects of a run list with `-help`: the one table of it, in three parts.
//!
//! Names are patterns: a star at an end stands for anything there. The first pattern that fits counts. A version of PETSc may lack an
//! option; one that lists a new option makes `tests/petsc_options.rs` fail until it has a row here.

mod linear;
mod nonlinear;
mod stepper;

use super::given::SolveOf;

/// Patterns and what becomes of the options that fit one. Behind the prefixes of solvers within solvers, such as
/// `condensed_` and `sub_`, names are the same.
type Row = (&'static [&'static str], Fate);

/// In the order in which they are searched.
const KNOWN: [&[Row]; 3] = [stepper::ROWS, nonlinear::ROWS, linear::ROWS];

/// What becomes of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It does what PETSc's manual says.
    Works,
    /// It does, but only where something happens that a run may never see: in words behind "matters only where".
    Rare(&'static str),
    /// PETSc reads it and nothing follows: in words behind "has no effect".
    NoEffect(&'static str),
    /// As [`Fate::NoEffect`] while this holds; it works otherwise.
    Unless(While, &'static str),
    /// It draws on a display, and is refused where there is none.
    Drawn,
    /// It is not the user's to choose.
    Refused(Refusal),
    /// As [`Fate::Refused`] while this holds; as [`Fate::Rare`] otherwise.
    RefusedWhile(While, Refusal, &'static str),
}

/// What can keep an option from having an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum While {
    /// The solver is direct: one application of the preconditioner.
    Direct,
    /// The program eliminates the contact unknowns itself.
    OwnSolve,
    /// The line search is the program's own.
    OwnLineSearch,
    /// Another package than PETSc factorises.
    OtherPackage,
    /// It is not an option of the condensed system's solver.
    NotCondensed,
    /// Another option is not given.
    Without(&'static str),
}

/// Why an option is refused, and what to do instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    /// The only value that does no harm; none does without.
    pub allowed: Option<&'static str>,
    /// In words that fit behind "option -name value:".
    pub reason: &'static str,
    /// In words that fit behind "leave it out, and".
    pub instead: &'static str,
}

const fn refused(reason: &'static str, instead: &'static str) -> Fate {
    Fate::Refused(Refusal {
        allowed: None,
        reason,
        instead,
    })
}

const REFUSED_SOLVES: Fate = refused(
    "a solve that does not converge is done again with a shorter step, and a run that fails says why",
    "watch the solves with -monitor_iterations",
);
const NO_GRID: Fate = refused(
    "it needs a grid of PETSc's, and the sheet's mesh is none",
    "look at the fields with ParaView",
);
const EIGENVALUES: Fate = refused(
    "the rows that are solved for change with the contacts, so there is no one matrix whose values it could show",
    "use -ksp_monitor_singular_value with -pc_type lu -ksp_type gmres",
);
const DIRECT: Fate = Fate::Unless(
    While::Direct,
    "as the solve is direct, which -ksp_type preonly stands for",
);

/// What becomes of an option, by its name without the dash; none if it is not known. Prefixes of inner solvers do not matter.
pub(super) fn fate(name: &str) -> Option<Fate> {
    let name = SolveOf::split(name).1;
    KNOWN
        .iter()
        .flat_map(|rows| rows.iter())
        .find(|(patterns, _)| patterns.iter().any(|pattern| fits(pattern, name)))
        .map(|(_, fate)| *fate)
}

fn fits(pattern: &str, name: &str) -> bool {
    match (pattern.strip_prefix('*'), pattern.strip_suffix('*')) {
        (Some(end), _) => name.ends_with(end),
        (None, Some(start)) => name.starts_with(start),
        (None, None) => name == pattern,
    }
}
