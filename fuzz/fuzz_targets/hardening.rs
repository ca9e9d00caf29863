//! Any hardening table and any constants of a hardening law are taken or refused, and a law that is taken never softens.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ssnp155::material::hardening::{Hardening, LAWS};

const YOUNG: f64 = 70500.0;
const THREE_G: f64 = 78000.0;

fn returns(law: &Hardening) {
    let step = law.return_map(300.0, 0.01, THREE_G);
    assert!(step.dp >= 0.0 && step.slope >= 0.0 && step.yield_stress >= law.initial());
}

fuzz_target!(|text: &str| {
    for table in [
        text.to_owned(),
        format!("strain,stress\n2.75177e-3,194\n{text}"),
    ] {
        match Hardening::from_csv(&table, "fuzz", YOUNG) {
            Ok(law) => returns(&law),
            Err(error) => assert_eq!(error.to_string().lines().count(), 1),
        }
    }
    let numbers: Vec<f64> = text
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    for declaration in LAWS {
        let Some(build) = declaration.build else {
            continue;
        };
        let within = declaration
            .constants
            .iter()
            .zip(&numbers)
            .filter(|(constant, value)| std::ops::RangeBounds::contains(&constant.range, *value));
        if within.count() < declaration.constants.len() {
            continue;
        }
        match build(&numbers, YOUNG) {
            Ok(law) => returns(&law),
            Err(error) => assert_eq!(error.to_string().lines().count(), 1),
        }
    }
});
