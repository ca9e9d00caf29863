//! Any hardening table is taken or refused, and a curve that is taken never softens.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ssnp155::material::hardening::Hardening;

const YOUNG: f64 = 70500.0;

fuzz_target!(|text: &str| {
    for table in [
        text.to_owned(),
        format!("strain,stress\n2.75177e-3,194\n{text}"),
    ] {
        match Hardening::from_csv(&table, "fuzz", YOUNG) {
            Ok(curve) => {
                let step = curve.return_map(300.0, 0.01, 78000.0);
                assert!(
                    step.dp >= 0.0 && step.slope >= 0.0 && step.yield_stress >= curve.initial()
                );
            }
            Err(error) => assert_eq!(error.to_string().lines().count(), 1),
        }
    }
});
