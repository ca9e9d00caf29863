//! The page docs/options.md and the option file of the reference case say what the option table says.

use std::collections::BTreeMap;

use ssnp155::case::{Case, help_text, options_markdown};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/options.md");
const REFERENCE_FILE: &str = include_str!("../inputs/ssnp155.opts");

/// The active lines of an option file: `-name value # comment`.
fn option_file(text: &str) -> Vec<(String, String)> {
    text.lines()
        .map(|line| line.split('#').next().unwrap_or_default().trim())
        .filter(|line| !line.is_empty())
        .map(|line| {
            let (name, value) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            (
                name.strip_prefix('-')
                    .expect("an option begins with a dash")
                    .to_owned(),
                value.trim().to_owned(),
            )
        })
        .collect()
}

#[test]
fn the_options_page_is_rendered_from_the_table() {
    let rendered = options_markdown();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(PAGE, &rendered).expect("docs/options.md can be written");
    }
    let page = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert!(
        page == rendered,
        "docs/options.md is out of date: run UPDATE_DOCS=1 cargo test --test case_docs"
    );
}

#[test]
fn the_option_file_gives_every_option_its_reference_value_once() {
    let given = option_file(REFERENCE_FILE);
    let source: BTreeMap<String, String> = given.iter().cloned().collect();
    assert_eq!(source.len(), given.len(), "an option is there twice");
    let case = Case::read(&source).unwrap();
    assert_eq!(case, Case::reference().unwrap());
    for (name, _) in case.options() {
        assert!(
            source.contains_key(name),
            "inputs/ssnp155.opts lacks -{name}"
        );
    }
}

#[test]
fn the_help_fits_a_terminal_of_80_columns_and_names_every_option() {
    let help = help_text();
    assert!(help.lines().all(|line| line.chars().count() <= 80));
    for (name, _) in Case::reference().unwrap().options() {
        assert_eq!(help.matches(&format!("\n-{name} ")).count(), 1, "-{name}");
    }
}
