//! Writes docs/verification.md from the answers.

use std::fmt::Write;
use std::path::Path;

use crate::row::{Answer, Case, Result, Row};

const HEAD: &str = "\
# Verification

<!-- Written by scripts/verify.sh; changes by hand are lost. -->

What the program computes beside closed solutions and independent integrations: first the material without a mesh, then
elements, contact, and motion in time. `scripts/verify.sh` runs all cases and writes this page; the cases marked *quick* run in
`cargo test --release`. Units are mm, N, MPa, g and ms. The cases are in [tests/verification](../tests/verification).

An error is relative to the reference unless it is marked with its absolute unit by *abs*. A tolerance says what the method
should reach (rounding, the order of the scheme, or the terms the reference neglects), and the text of a case says which.
Numbers below 1e-9 are shown as such: they are rounding.
";

/// Writes the page and its pictures below docs/.
pub fn write(answers: &[(&Case, &Answer)]) -> Result<()> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::fs::create_dir_all(docs.join("images"))?;
    let mut page = HEAD.to_owned();
    for (case, answer) in answers {
        section(&mut page, case, answer)?;
        for (name, _, svg) in &answer.pictures {
            std::fs::write(docs.join("images").join(format!("{name}.svg")), svg)?;
        }
    }
    std::fs::write(docs.join("verification.md"), page)?;
    Ok(())
}

fn section(page: &mut String, case: &Case, answer: &Answer) -> Result<()> {
    let quick = if case.quick { ", quick" } else { "" };
    writeln!(page, "\n## {}\n\n`{}`{quick}\n", case.title, case.name)?;
    writeln!(page, "{}\n", case.text)?;
    for (name, caption, _) in &answer.pictures {
        writeln!(page, "![{caption}](images/{name}.svg)\n")?;
    }
    writeln!(
        page,
        "| quantity | computed | reference | error | tolerance | source |"
    )?;
    writeln!(page, "|---|---|---|---|---|---|")?;
    for row in &answer.rows {
        writeln!(page, "{}", table_line(row))?;
    }
    Ok(())
}

fn table_line(row: &Row) -> String {
    let kind = if row.relative { "" } else { " abs" };
    format!(
        "| {} | {} | {} | {}{kind} | {:.1e}{kind} | {} |",
        row.quantity,
        number(row.computed),
        number(row.reference),
        error(row.error()),
        row.tolerance,
        row.source
    )
}

/// Below this a number is rounding, which differs from machine to machine.
const ROUNDING: f64 = 1e-9;

fn error(value: f64) -> String {
    if value < ROUNDING {
        format!("< {ROUNDING:.0e}")
    } else {
        format!("{value:.1e}")
    }
}

/// Seven digits, with an exponent where that is shorter.
fn number(value: f64) -> String {
    if value.abs() < ROUNDING {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.6e}");
    }
    let decimals = (6 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}
