//! The command line and the environment before PETSc sees them: it drops stray words silently, and stops hard on an option
//! file it cannot read.

use std::ffi::OsString;

use super::error::CaseError;
use super::option_file::{self, is_option, words};
use crate::text;

/// The environment variable that PETSc reads options from.
pub const ENVIRONMENT: &str = "PETSC_OPTIONS";

/// The arguments as text.
///
/// # Errors
/// [`CaseError::ArgumentNotText`].
pub fn arguments_as_text(
    args: impl IntoIterator<Item = OsString>,
) -> Result<Vec<String>, CaseError> {
    let as_text = |argument: OsString| {
        argument
            .into_string()
            .map_err(|argument| CaseError::ArgumentNotText {
                argument: text::shortened(&argument.to_string_lossy()),
            })
    };
    args.into_iter().map(as_text).collect()
}

/// Checks the words of a command line (without the program's name): every word is an option or the value of one, and
/// every option file can be read.
///
/// # Errors
/// The first stray word, or as [`check_options_file`].
pub fn check_arguments(args: &[String]) -> Result<(), CaseError> {
    let mut value_may_follow = false;
    for argument in args {
        let option = is_option(argument);
        if !option && !value_may_follow {
            return Err(CaseError::StrayArgument {
                argument: text::shortened(argument),
            });
        }
        value_may_follow = option;
    }
    check_options_file(args)
}

/// Checks the options in the environment variable [`ENVIRONMENT`] like those of a command line.
///
/// # Errors
/// [`CaseError::Environment`].
pub fn check_environment(options: Option<OsString>) -> Result<(), CaseError> {
    let check = |options: OsString| {
        let options = arguments_as_text([options])?.concat();
        let words = words(&options).map_err(|problem| CaseError::OpenQuote { problem })?;
        check_arguments(
            &words
                .iter()
                .map(|&word| word.to_owned())
                .collect::<Vec<_>>(),
        )
    };
    options
        .map_or(Ok(()), check)
        .map_err(|error| CaseError::Environment(Box::new(error)))
}

/// Checks that every `-options_file` of a command line has a path, and that the file there is an option file.
///
/// # Errors
/// [`CaseError::OptionsFileTwoDashes`], [`CaseError::OptionsFileWithoutPath`], [`CaseError::OptionsFileUnreadable`],
/// [`CaseError::OptionsFileLine`].
pub fn check_options_file(args: &[String]) -> Result<(), CaseError> {
    for (index, argument) in args.iter().enumerate() {
        if argument.eq_ignore_ascii_case("--options_file") {
            return Err(CaseError::OptionsFileTwoDashes);
        }
        if argument.eq_ignore_ascii_case("-options_file") {
            match args.get(index + 1) {
                Some(path) if !path.starts_with('-') && !path.is_empty() => {
                    option_file::check(path)?;
                }
                _ => return Err(CaseError::OptionsFileWithoutPath),
            }
        }
    }
    Ok(())
}
