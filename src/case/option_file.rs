//! Option files before PETSc reads them: it would stop on a slip with a traceback, drop a value without a word, or follow
//! a file that includes itself until the stack is full.

use std::path::{Path, PathBuf};

use super::error::CaseError;
use crate::text;

/// Checks an option file and those it includes.
///
/// # Errors
/// [`CaseError::OptionsFileUnreadable`] or [`CaseError::OptionsFileLine`], of the file that is to blame.
pub(super) fn check(path: &str) -> Result<(), CaseError> {
    check_below(path, &mut Vec::new())
}

/// `above`: the files that lead to this one.
fn check_below(path: &str, above: &mut Vec<PathBuf>) -> Result<(), CaseError> {
    let file = Path::new(path.strip_suffix(":yaml").unwrap_or(path));
    let unreadable = |reason| CaseError::OptionsFileUnreadable {
        path: path.to_owned(),
        reason,
    };
    let content = text::read(file).map_err(unreadable)?;
    let absolute = file
        .canonicalize()
        .map_err(|error| unreadable(error.to_string()))?;
    if above.contains(&absolute) {
        return Err(unreadable("it includes itself".to_owned()));
    }
    let yaml = Path::new(path) != file
        || file
            .extension()
            .is_some_and(|ending| ending == "yaml" || ending == "yml");
    if yaml {
        return Ok(());
    }
    above.push(absolute);
    for (content, line) in content.lines().zip(1..) {
        let blame = |problem| CaseError::OptionsFileLine {
            path: path.to_owned(),
            line,
            problem,
        };
        if let Some(included) = included_by(content).map_err(blame)? {
            check_below(included, above)?;
        }
    }
    above.pop();
    Ok(())
}

/// Checks a line by PETSc's rules (`PetscOptionsInsertFilePetsc`, 3.18): an option and at most one value, or an alias.
/// Returns the path of the file it includes, if it does.
fn included_by(line: &str) -> Result<Option<&str>, String> {
    let quote = text::shortened;
    let words = words(line.split('#').next().unwrap_or_default())?;
    let is_file = |word: &str| word.eq_ignore_ascii_case("-options_file");
    match words[..] {
        [] => Ok(None),
        [first, ..] if first.eq_ignore_ascii_case("alias") => match words[..] {
            [_, new, old] if is_option(new) && is_option(old) => Ok(None),
            _ => Err("an alias is written: alias -new_name -old_name".to_owned()),
        },
        [first, ..] if !is_option(first) => Err(format!(
            "'{}' is not an option, which begins with a dash and a letter",
            quote(first)
        )),
        [first] if is_file(first) => Err("-options_file needs the path of a file".to_owned()),
        [_] => Ok(None),
        [_, second, ..] if is_option(second) => Err(second_option(second)),
        [_, _, third, ..] if is_option(third) => Err(second_option(third)),
        [_, _, third, ..] => Err(format!(
            "'{}' is too much behind an option and its value; a comment begins with #, and a value with spaces stands in \
             double quotes",
            quote(third)
        )),
        [first, path] => Ok(is_file(first).then_some(path)),
    }
}

fn second_option(word: &str) -> String {
    format!(
        "'{}' is a second option and needs its own line",
        text::shortened(word)
    )
}

/// The words of a text, as PETSc's tokens: a word that begins with a double quote ends with the next one.
///
/// # Errors
/// A quote that is not closed, in words.
pub(super) fn words(text: &str) -> Result<Vec<&str>, String> {
    let mut words = Vec::new();
    let mut rest = text.trim_ascii_start();
    while !rest.is_empty() {
        let (word, behind) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').ok_or_else(|| {
                format!(
                    "the double quote before '{}' is not closed",
                    text::shortened(quoted)
                )
            })?,
            None => rest
                .split_once(|c: char| c.is_ascii_whitespace())
                .unwrap_or((rest, "")),
        };
        words.push(word);
        rest = behind.trim_ascii_start();
    }
    Ok(words)
}

/// Whether PETSc takes a word for the name of an option: a dash (or two), then a letter, and not a number such as -inf.
pub(super) fn is_option(word: &str) -> bool {
    let Some(name) = word.strip_prefix('-') else {
        return false;
    };
    let name = name.strip_prefix('-').unwrap_or(name);
    name.starts_with(|first: char| first.is_ascii_alphabetic()) && name.parse::<f64>().is_err()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{any, prop, proptest};

    #[test]
    fn words_are_petscs_tokens() {
        assert_eq!(
            words(" -a  \"b c\" \t'd e\""),
            Ok(vec!["-a", "b c", "'d", "e\""])
        );
        assert!(words("-a \"b").unwrap_err().contains("is not closed"));
    }

    proptest! {
        #[test]
        fn any_line_is_read_or_refused(line in any::<String>(), more in prop::collection::vec("[-a-z\"# ]{0,6}", 0..5)) {
            let _ = included_by(&line);
            let _ = included_by(&more.join(" "));
        }

        #[test]
        fn words_without_quotes_come_back(given in prop::collection::vec("[!#-~]{1,8}", 0..6)) {
            let text = given.join(" ");
            assert_eq!(words(&text), Ok(given.iter().map(String::as_str).collect()));
        }
    }
}
