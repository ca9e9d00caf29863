//! Hardening laws through the options that choose them: what is read, and what is refused in which words.

use std::collections::BTreeMap;

use ssnp155::case::{Case, CaseError};
use ssnp155::material::hardening::{LAWS, law_named};

fn read(given: &[(&str, &str)]) -> Result<Case, CaseError> {
    let options: BTreeMap<String, String> = given
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    Case::read(&options)
}

fn refusal(given: &[(&str, &str)]) -> String {
    read(given).unwrap_err().to_string()
}

#[test]
fn every_law_is_chosen_by_its_name_and_shown_with_its_constants_only() {
    for declaration in LAWS {
        let case = read(&[("hardening", declaration.name)]).unwrap();
        assert_eq!(case.material.hardening_law.name, declaration.name);
        let shown: BTreeMap<String, String> = case
            .options()
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
        assert_eq!(Case::read(&shown), Ok(case));
        for law in LAWS {
            for constant in law.constants {
                let own = declaration
                    .constants
                    .iter()
                    .any(|c| c.name == constant.name);
                assert_eq!(shown.contains_key(constant.name), own, "{}", constant.name);
            }
        }
    }
}

#[test]
fn constants_reach_the_law() {
    let case = read(&[
        ("hardening", "voce"),
        ("voce_sigma0", "100"),
        ("voce_q", "50"),
        ("voce_b", "2"),
    ])
    .unwrap();
    let young = case.material.young_modulus;
    let voce = law_named("voce").unwrap().build.unwrap()(&[100.0, 50.0, 2.0], young).unwrap();
    assert_eq!(case.material.hardening, voce);
    // Another modulus is no trouble for a law, unlike for a table.
    assert!(read(&[("hardening", "swift"), ("young_modulus", "210000")]).is_ok());
    let differences = case.differences_from_reference().unwrap();
    assert!(
        differences
            .iter()
            .any(|d| d.option == "hardening" && d.value == "voce")
    );
}

#[test]
fn what_belongs_to_another_law_is_refused_in_one_sentence() {
    assert_eq!(
        refusal(&[("voce_q", "100")]),
        "option -voce_q 100 has no effect with -hardening table: it belongs to -hardening voce; leave it out, or choose \
         the other law"
    );
    assert_eq!(
        refusal(&[("hardening", "swift"), ("hollomon_n", "0.2")]),
        "option -hollomon_n 0.2 has no effect with -hardening swift: it belongs to -hardening hollomon or hollomon_total; \
         leave it out, or choose the other law"
    );
    assert_eq!(
        refusal(&[("hardening", "voce"), ("hardening_file", "my.csv")]),
        "option -hardening_file my.csv has no effect with -hardening voce: it belongs to -hardening table; leave it out, \
         or choose the other law"
    );
    assert!(read(&[("hardening", "voce"), ("hardening_file", "benchmark")]).is_ok());
    assert!(
        refusal(&[
            ("hardening", "hollomon_total"),
            ("hollomon_elastic_limit", "194")
        ])
        .contains("belongs to -hardening hollomon;")
    );
}

#[test]
fn a_word_or_a_constant_that_cannot_be_is_refused_with_what_can() {
    let text = refusal(&[("hardening", "holomon")]);
    assert!(
        text.starts_with("option -hardening holomon: this is none of the choices; specify one of the words: table or hollomon"),
        "{text}"
    );
    let text = refusal(&[("hardening", "swift"), ("swift_n", "1.5")]);
    assert_eq!(
        text,
        "option -swift_n 1.5: the value is out of range; specify a real number: 1e-3 <= value <= 1 (default 0.223)"
    );
    let text = refusal(&[("hardening", "swift"), ("swift_k", "")]);
    assert!(
        text.starts_with("option -swift_k has no value: specify a real number in MPa:"),
        "{text}"
    );
    let text = refusal(&[("hardening", "hollomon"), ("hollomon_n", "0.01")]);
    assert!(
        text.starts_with("option -hardening hollomon: K p^n exceeds the elastic limit of 194 MPa from a plastic strain of"),
        "{text}"
    );
    let text = refusal(&[("hardening", "hollomon_total"), ("hollomon_k", "1e6")]);
    assert!(
        text.starts_with("option -hardening hollomon_total: K eps^n meets the elastic line of E 70500 MPa at a strain of"),
        "{text}"
    );
}
