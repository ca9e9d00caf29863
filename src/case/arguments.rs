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

/// Checks that every `-options_file` of a command line has a path, and that the file there is an option file: PETSc would
/// stop on it with a traceback.
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
                Some(path) if !path.starts_with('-') && !path.is_empty() => check_file(path)?,
                _ => return Err(CaseError::OptionsFileWithoutPath),
            }
        }
    }
    Ok(())
}

fn check_file(path: &str) -> Result<(), CaseError> {
    let unreadable = |reason| CaseError::OptionsFileUnreadable {
        path: path.to_owned(),
        reason,
    };
    let file = path.strip_suffix(":yaml").unwrap_or(path);
    let bytes = std::fs::read(file).map_err(|error| unreadable(error.to_string()))?;
    let text =
        std::str::from_utf8(&bytes).map_err(|_| unreadable("it is not UTF-8 text".to_owned()))?;
    let yaml = file != path || file.ends_with(".yaml") || file.ends_with(".yml");
    if !yaml {
        for (content, line) in text.lines().zip(1..) {
            check_line(content).map_err(|problem| CaseError::OptionsFileLine {
                path: path.to_owned(),
                line,
                problem,
            })?;
        }
    }
    Ok(())
}

/// PETSc's rules (`PetscOptionsInsertFilePetsc`, 3.18): an option and at most one value on a line, or an alias; values
/// with spaces stand in quotes, and are left to PETSc.
fn check_line(content: &str) -> Result<(), String> {
    let content = content.split('#').next().unwrap_or_default();
    let mut words = content.split_ascii_whitespace();
    match words.next() {
        None => Ok(()),
        Some(first) if first.eq_ignore_ascii_case("alias") => Ok(()),
        Some(first) if !is_option(first) => Err(format!(
            "'{first}' is not an option, which begins with a dash and a letter"
        )),
        Some(_) if content.contains(['"', '\'']) => Ok(()),
        Some(_) => match (words.next(), words.next()) {
            (Some(second), _) if is_option(second) => Err(format!(
                "'{second}' is a second option and needs its own line"
            )),
            (_, Some(third)) => Err(format!(
                "'{third}' is too much behind an option and its value; a comment begins with #"
            )),
            _ => Ok(()),
        },
    }
}

/// Whether PETSc takes a word for the name of an option: a dash (or two), then a letter, and not a number such as -inf.
fn is_option(word: &str) -> bool {
    let Some(name) = word.strip_prefix('-') else {
        return false;
    };
    let name = name.strip_prefix('-').unwrap_or(name);
    name.starts_with(|first: char| first.is_ascii_alphabetic()) && name.parse::<f64>().is_err()
}
