//! The option table for people: the text of `-help` and the page docs/options.md.

use std::fmt::Write;

use super::option::{Described, Group};
use super::table::TABLE;
use crate::text::{COLUMNS as WIDTH, wrapped};

/// Defaults that are longer do not widen their column.
const LONG_DEFAULT: usize = 20;

const UNITS: &str =
    "Units are mm, N, MPa, g and ms. Without options the frictionless reference case is run.";

const OF_PETSC: &str = "The options of PETSc that the objects of a run read follow; docs/petsc-options.md says which \
                        have an effect.";

fn options_of(group: Group) -> impl Iterator<Item = &'static dyn Described> {
    TABLE
        .iter()
        .copied()
        .filter(move |option| option.group() == group)
}

/// What `-help` prints: every option of ours with unit, default, range and meaning, for a terminal of 80 columns.
pub fn help_text() -> String {
    let mut text = String::from(
        "ssnp155: sheet metal forming with contact, the NAFEMS contact benchmark 3\n\
         (code_aster test SSNP155).\n\n\
         Usage: ssnp155 [-name value ...] [-options_file inputs/ssnp155.opts]\n\n",
    );
    wrap(&mut text, UNITS, 0);
    wrap(&mut text, OF_PETSC, 0);
    let name_width = TABLE
        .iter()
        .map(|option| option.name().len() + 1)
        .max()
        .unwrap_or_default();
    let default_width = TABLE
        .iter()
        .map(|option| option.default_with_unit().chars().count())
        .filter(|&length| length <= LONG_DEFAULT)
        .max()
        .unwrap_or_default();
    for group in Group::ALL {
        let heading = format!(
            "\n{:<name_width$}  {:<default_width$}  {}\n",
            group.title(),
            "default",
            "allowed"
        );
        text.push_str(&heading);
        for option in options_of(group) {
            let name = format!("-{}", option.name());
            let default = option.default_with_unit();
            let begun = format!("{name:<name_width$}  {default:<default_width$}  ");
            let allowed = option.allowed();
            if begun.chars().count() + allowed.chars().count() <= WIDTH {
                text.push_str(&format!("{begun}{allowed}\n"));
            } else {
                text.push_str(&format!("{}\n", begun.trim_end()));
                wrap(&mut text, &allowed, 6);
            }
            wrap(&mut text, option.meaning(), 6);
        }
    }
    text
}

/// Appends a sentence, broken between words and indented.
fn wrap(text: &mut String, sentence: &str, indent: usize) {
    for line in wrapped(sentence, WIDTH - indent) {
        text.push_str(&format!("{:indent$}{line}\n", ""));
    }
}

/// The page docs/options.md; a test keeps the file equal to it.
pub fn options_markdown() -> String {
    let mut page = String::from(
        "# Options\n\n\
         <!-- Rendered from the option table src/case/table.rs by `UPDATE_DOCS=1 cargo test --test case_docs`; \
         changes by hand are lost. -->\n\n",
    );
    page.push_str(UNITS);
    page.push_str(
        "\nOptions are given on the command line as `-name value`, or in a file (one per line, `#` begins a comment) with\n\
         `-options_file path`; [inputs/ssnp155.opts](../inputs/ssnp155.opts) is the reference case with all of them.\n\
         PETSc's options: [petsc-options.md](petsc-options.md).\n",
    );
    for group in Group::ALL {
        // Writing to a String cannot fail.
        let _ = write!(
            page,
            "\n## {}\n\n| option | default | unit | allowed | meaning |\n|---|---|---|---|---|\n",
            group.title()
        );
        for option in options_of(group) {
            let _ = writeln!(
                page,
                "| `-{}` | {} | {} | {} | {} |",
                option.name(),
                option.default(),
                option.unit(),
                option.allowed().replace('<', "&lt;"),
                option.meaning()
            );
        }
    }
    page
}
