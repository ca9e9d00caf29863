//! Writes docs/verification.md from the answers.

use std::fmt::Write;
use std::path::Path;

use crate::row::{Answer, Case, ROUNDING, Result, Row};

const HEAD: &str = "\
# Verification

<!-- Written by scripts/verify.sh; changes by hand are lost. -->

What the program computes beside closed solutions and independent integrations: first the material without a mesh, then
elements, contact, and motion in time. `scripts/verify.sh` runs all cases and writes this page; the cases marked *quick* run in
`cargo test --release`. The cases marked *also on two ranks* are solved a second time by two ranks, where every row must hold, too,
and every value be that of one rank, to 1e-7 of its size (errors given in absolute terms: to 1e-9 or 1e-5 of their tolerance).
Units are mm, N, MPa, g and ms. The cases are in [tests/verification](../tests/verification).

An error is relative to the reference unless it is marked with its absolute unit by *abs*. A tolerance says what the method
should reach (rounding, the order of the scheme, or the terms the reference neglects), and the text of a case says which.
Numbers below 1e-9 are shown as such: they are rounding.
";

/// What was done by hand, with its commands.
const TAIL: &str = "
## Odd input

[bad-input.md](bad-input.md) holds over 80 bad inputs with their answers. Beyond them the readers were given random input, with
libFuzzer (`fuzz/run.sh`, guided by coverage, checks for overflow on) and with proptest (`PROPTEST_CASES=1000000 cargo test --release
--test case_hardening_table any`, and so on). Every input must be taken or refused with one line, without a panic:

| reader | libFuzzer, executions | proptest, cases | findings |
|---|---|---|---|
| options, command line, environment | 45 413 in 100 s | 300 000 lines of option files, 100 000 command lines and names | none |
| hardening table | 1 344 527 in 100 s | 1 000 000 texts, 1 000 000 sets of points | none |
| reference values | | 300 000 | none |

By hand, without a fuzzer, these were found and mended: an argument that is no UTF-8 (panic), an option file that includes itself
(stack overflow in PETSc), a pipe or device for a file (waited for ever), a quote left open (the value was taken silently), a
PETSc step control (ever shorter steps without end), `-ts_max_steps` (a run cut short looked finished), and a punch finer than
the mesh (it went through the sheet, and all verdicts held).

## Memory

`scripts/valgrind.sh` runs the tests of the PETSc wrapper and three small cases of the program (frictionless, with friction, static
with PETSc's own factorisation) under memcheck, on one rank. All clean: no invalid access and no value used unset; the only lost memory is that of Open MPI, of its plug-ins and of PETSc 3.18 on
two paths that only tests take (a refused scatter, a change of the solver's type), listed with reasons in
`scripts/valgrind.supp`.
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
    page.push_str(TAIL);
    std::fs::write(docs.join("verification.md"), page)?;
    Ok(())
}

fn section(page: &mut String, case: &Case, answer: &Answer) -> Result<()> {
    let quick = if case.quick { ", quick" } else { "" };
    let ranks = if case.two_ranks {
        ", also on two ranks"
    } else {
        ""
    };
    writeln!(
        page,
        "\n## {}\n\n`{}`{quick}{ranks}\n",
        case.title, case.name
    )?;
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
