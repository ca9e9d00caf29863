//! Bad inputs and the sentence each gets: the table behind tests/bad_input.rs and docs/bad-input.md.

mod inverse;
mod laws;
mod model;
mod option_files;
mod options;
mod petsc;
mod tools;

/// How an input reaches the program.
pub enum Given {
    /// Words of the command line, with blanks between.
    Words(&'static str),
    /// The environment variable PETSC_OPTIONS.
    Environment(&'static str),
    /// An option with an empty value.
    Empty(&'static str),
    /// One word of the command line that is no text.
    Bytes(&'static [u8]),
}

/// One bad input.
pub struct Mistake {
    pub what: &'static str,
    pub given: Given,
    /// The numbers of ranks it is tried on.
    pub ranks: &'static [usize],
    /// The answer, without the program's name.
    pub sentence: &'static str,
}

const ONE: &[usize] = &[1];
/// For one example of each place where input is checked.
const BOTH: &[usize] = &[1, 2];

const fn words(
    what: &'static str,
    ranks: &'static [usize],
    given: &'static str,
    sentence: &'static str,
) -> Mistake {
    Mistake {
        what,
        given: Given::Words(given),
        ranks,
        sentence,
    }
}

/// All of them, by the place where they are found.
pub fn mistakes() -> impl Iterator<Item = &'static Mistake> {
    let parts = [
        options::MISTAKES,
        petsc::MISTAKES,
        option_files::MISTAKES,
        laws::MISTAKES,
        model::MISTAKES,
        inverse::MISTAKES,
        tools::MISTAKES,
    ];
    parts.into_iter().flatten()
}

/// Files that inputs point to, and what is in them.
pub fn files() -> impl Iterator<Item = &'static (&'static str, &'static [u8])> {
    let parts = [
        option_files::FILES,
        laws::FILES,
        model::FILES,
        inverse::FILES,
        tools::FILES,
    ];
    parts.into_iter().flatten()
}
