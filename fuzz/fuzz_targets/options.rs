//! Any command line or option file is taken or refused: a byte string, as words and as `-name value` lines.
#![no_main]

use std::collections::BTreeMap;

use libfuzzer_sys::fuzz_target;
use ssnp155::case::{Case, check_arguments, check_environment, check_unused};

fuzz_target!(|text: &str| {
    let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
    // Files are left out: reading whatever the fuzzer names is no test of the parser.
    if words
        .iter()
        .any(|word| word.to_lowercase().contains("file"))
    {
        return;
    }
    let _ = check_arguments(&words);
    let _ = check_environment(Some(text.into()));
    let given: BTreeMap<String, String> = text
        .lines()
        .filter_map(|line| line.strip_prefix('-')?.split_once(' '))
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .collect();
    let unused: Vec<(String, Option<String>)> = given
        .iter()
        .map(|(name, value)| (name.clone(), Some(value.clone())))
        .collect();
    let _ = check_unused(&unused);
    if let Ok(case) = Case::read(&given) {
        // What is taken can be written down and read again.
        let shown: BTreeMap<String, String> = case
            .options()
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
        assert_eq!(Case::read(&shown), Ok(case));
    }
});
