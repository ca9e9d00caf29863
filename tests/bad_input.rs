//! Whatever a person gets wrong is answered with one sentence, once over all ranks, and a code that is not 0: no panic,
//! no traceback, no hang, and no file touched. docs/bad-input.md is rendered from this table.

mod bad_input_table;
mod program;

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::Path;
use std::sync::Mutex;

use bad_input_table::{Given, Mistake, files, mistakes};
use program::{Ended, run, run_in, scratch};

/// Longest time an answer may take, s.
const PATIENCE: u32 = 30;
/// Answers that are waited for at the same time: MPI's start and end are mostly waiting.
const SIDE_BY_SIDE: usize = 4;
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/bad-input.md");

/// A folder with everything the table's inputs point to.
fn prepared() -> std::path::PathBuf {
    let folder = scratch("bad-input");
    for (name, content) in files() {
        std::fs::write(folder.join(name), content).unwrap();
    }
    for name in ["folder", "taken/summary.json"] {
        std::fs::create_dir_all(folder.join(name)).unwrap();
    }
    std::fs::write(folder.join("long.csv"), vec![b'#'; (1 << 20) + 1]).unwrap();
    let made = std::process::Command::new("mkfifo")
        .arg(folder.join("pipe"))
        .status();
    assert!(made.unwrap().success());
    folder
}

fn answer(mistake: &Mistake, ranks: usize, folder: &Path) -> Ended {
    let (words, environment): (Vec<OsString>, _) = match mistake.given {
        Given::Words(words) => (words.split_whitespace().map(OsString::from).collect(), None),
        Given::Environment(value) => (Vec::new(), Some(("PETSC_OPTIONS", value))),
        Given::Empty(option) => (vec![option.into(), "".into()], None),
        Given::Bytes(bytes) => (vec![OsString::from_vec(bytes.to_vec())], None),
    };
    run_in(folder, environment, ranks, PATIENCE, &words)
}

fn listing(folder: &Path) -> BTreeSet<String> {
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
    std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| name(entry).to_string_lossy().into_owned())
        .collect()
}

/// What is wrong with the answers to a mistake.
fn faults(mistake: &Mistake, folder: &Path) -> Vec<String> {
    let fault = |&ranks: &usize| {
        let ended = answer(mistake, ranks, folder);
        let text = ended.text();
        let good = ended.code == Some(2)
            && ended.stderr.trim_end() == format!("ssnp155: {}", mistake.sentence)
            && ended.stdout.trim().is_empty();
        let (what, end) = (mistake.what, ended.code);
        (!good || text.contains("panicked") || text.contains("PETSC ERROR"))
            .then(|| format!("{what} ({ranks} ranks, code {end:?}): {text}"))
    };
    mistake.ranks.iter().filter_map(fault).collect()
}

#[test]
fn every_mistake_of_the_table_gets_its_sentence_and_touches_nothing() {
    let folder = prepared();
    let before = listing(&folder);
    let left = Mutex::new(mistakes());
    let next = || left.lock().unwrap().next();
    let worker = || -> Vec<String> {
        let own = std::iter::from_fn(next);
        own.flat_map(|mistake| faults(mistake, &folder)).collect()
    };
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..SIDE_BY_SIDE).map(|_| scope.spawn(worker)).collect();
        let found = workers.into_iter().map(|worker| worker.join().unwrap());
        found.flatten().collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(listing(&folder), before, "a file was made");
}

#[test]
fn the_page_is_rendered_from_the_table() {
    let mut page = String::from(
        "# Bad input\n\n\
         <!-- Rendered from tests/bad_input_table/ by `UPDATE_DOCS=1 cargo test --test bad_input`; changes by hand are \
         lost. -->\n\n\
         What the program answers to bad input: one sentence on standard error, once over all ranks, exit code 2, and no \
         file made or\nchanged. A test gives each of these to the program and expects exactly this answer, on one rank \
         and, where the third\ncolumn says so, on more.\n\n\
         | what is wrong | given | ranks | answer |\n|---|---|---|---|\n",
    );
    for mistake in mistakes() {
        let given = match mistake.given {
            Given::Words(words) => format!("`{words}`"),
            Given::Environment(value) => format!("`PETSC_OPTIONS='{value}'`"),
            Given::Empty(option) => format!("`{option} \"\"`"),
            Given::Bytes(bytes) => format!("`{}`", bytes.escape_ascii()),
        };
        let ranks: Vec<String> = mistake.ranks.iter().map(usize::to_string).collect();
        let sentence = mistake.sentence.replace('<', "&lt;").replace('|', "\\|");
        page += &format!(
            "| {} | {given} | {} | {sentence} |\n",
            mistake.what,
            ranks.join(", ")
        );
    }
    page += "\nThe files:\n\n";
    for (name, content) in files() {
        page += &format!("- `{name}`: `{}`\n", content.escape_ascii());
    }
    page += "- `long.csv`: one byte more than 1 MiB; `pipe`: a named pipe; `folder`: a folder; `taken`: a folder with a folder \
             `summary.json` in it\n";
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(PAGE, &page).unwrap();
    }
    assert!(
        std::fs::read_to_string(PAGE).unwrap_or_default() == page,
        "docs/bad-input.md is out of date: run UPDATE_DOCS=1 cargo test --test bad_input"
    );
}

#[test]
fn neither_a_mistake_nor_a_question_touches_an_earlier_run() {
    let folder = scratch("bad-input-untouched");
    let history = folder.join("history.csv");
    std::fs::write(&history, "earlier").unwrap();
    let folder = folder.to_str().unwrap();
    assert_eq!(
        run(2, PATIENCE, &["-output_dir", folder, "-strok", "3"]).code,
        Some(2)
    );
    let help = run(2, PATIENCE, &["-output_dir", folder, "-help"]);
    assert_eq!(help.code, Some(0), "{}", help.stderr);
    for option in ["-sheet_nx", "-snes_max_it", "-ts_max_steps"] {
        assert!(help.says(option), "{option}");
    }
    assert_eq!(std::fs::read_to_string(&history).unwrap(), "earlier");
    assert_eq!(std::fs::read_dir(Path::new(folder)).unwrap().count(), 1);
}

/// A small case that takes a fraction of a second, with these words behind it.
fn small(ranks: usize, name: &str, more: &str) -> Ended {
    let folder = scratch(name);
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend("-sheet_nx 20 -sheet_ny 1 -stroke 0.1 -time_load 2 -unload_fraction 0".split(' '));
    words.extend(more.split(' '));
    run(ranks, PATIENCE, &words)
}

#[test]
fn the_stepper_that_fits_the_equations_may_be_named() {
    for (name, words) in [
        ("slow", "-dynamics slow -ts_type alpha2"),
        ("static", "-dynamics none -ts_type beuler"),
    ] {
        let ended = small(1, &format!("bad-input-stepper-{name}"), words);
        assert_eq!(ended.code, Some(0), "{words}: {}", ended.text());
    }
}

#[test]
fn an_option_that_petsc_does_not_read_is_named_after_the_run() {
    let ended = small(2, "bad-input-unread", "-snes_maxit 4");
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let warning = "warning: option -snes_maxit 4 has no effect: PETSc did not read it; check its spelling and whether \
                   the chosen solver has it\n";
    assert_eq!(
        ended.stdout.matches("warning:").count(),
        1,
        "{}",
        ended.stdout
    );
    assert!(ended.says(warning), "{}", ended.stdout);
}

#[test]
fn a_run_that_a_limit_ends_early_does_not_look_finished() {
    let ended = small(1, "bad-input-limit", "-ts_max_steps 1");
    assert_eq!(ended.code, Some(1), "{}", ended.text());
    assert!(ended.says("FAILED: the run did not finish"));
    assert!(ended.says("the prescribed number of steps is done"));
    assert!(!ended.says("FINISHED"));
}

#[test]
fn a_name_that_petsc_only_looks_up_during_the_run_ends_it() {
    let solver = small(
        2,
        "bad-input-solver",
        "-condensed_pc_factor_mat_solver_type foo",
    );
    assert_eq!(solver.code, Some(2), "{}", solver.text());
    let sentence = solver.stderr.trim();
    assert!(
        sentence.starts_with("ssnp155: PETSc error 92"),
        "{sentence}"
    );
    assert!(sentence.contains("foo") && sentence.contains("-help lists what each can be"));
    assert!(!solver.text().contains("panicked") && sentence.lines().count() == 1);
}
