//! The command line before PETSc sees it: PETSc drops stray words silently and stops hard on a missing option file.

use super::error::CaseError;

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
                argument: argument.clone(),
            });
        }
        value_may_follow = option;
    }
    check_options_file(args)
}

/// Checks that every `-options_file` of a command line has a path, and that the file there is readable text.
///
/// # Errors
/// [`CaseError::OptionsFileWithoutPath`], [`CaseError::OptionsFileUnreadable`].
pub fn check_options_file(args: &[String]) -> Result<(), CaseError> {
    for (index, argument) in args.iter().enumerate() {
        if argument
            .trim_start_matches('-')
            .eq_ignore_ascii_case("options_file")
            && is_option(argument)
        {
            match args.get(index + 1) {
                Some(path) if !is_option(path) && !path.is_empty() => check_readable(path)?,
                _ => return Err(CaseError::OptionsFileWithoutPath),
            }
        }
    }
    Ok(())
}

fn check_readable(path: &str) -> Result<(), CaseError> {
    let reason = match std::fs::read(path) {
        Ok(bytes) if std::str::from_utf8(&bytes).is_ok() => return Ok(()),
        Ok(_) => "it is not UTF-8 text".to_owned(),
        Err(error) => error.to_string(),
    };
    Err(CaseError::OptionsFileUnreadable {
        path: path.to_owned(),
        reason,
    })
}

/// Whether PETSc takes a word for the name of an option: a dash (or two), then a letter, and not a number such as -inf.
fn is_option(word: &str) -> bool {
    let Some(name) = word.strip_prefix('-') else {
        return false;
    };
    let name = name.strip_prefix('-').unwrap_or(name);
    name.starts_with(|first: char| first.is_ascii_alphabetic()) && name.parse::<f64>().is_err()
}
