//! What the terminal shows: 80 columns, no colour where there is no terminal, one line a step, no time left before it means
//! something, and with -quiet the end only.

mod program;

use program::{history, run, scratch};

const CASE: &str =
    "-sheet_nx 20 -sheet_ny 2 -stroke 2 -time_load 64 -output_every 0 -time_unload 8";

fn shown(name: &str, ranks: usize, more: &str) -> (String, String, usize) {
    let folder = scratch(&format!("terminal-{name}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(CASE.split(' ').chain(more.split_whitespace()));
    let ended = run(ranks, 120, &words);
    assert!(ended.says("===="), "{}", ended.text());
    let log = std::fs::read_to_string(folder.join("run.log")).unwrap();
    (ended.stdout, log, history(&folder)["t_ms"].len())
}

/// Paths are the only words that may be longer than a line.
fn fits(text: &str) {
    assert!(!text.contains('\x1b'), "an escape sequence");
    for line in text.lines().filter(|line| !line.contains('/')) {
        assert!(line.chars().count() <= 80, "{line}");
    }
}

/// The lines of steps: they begin with the share that is done.
fn steps(text: &str) -> Vec<&str> {
    let share = |line: &&str| line.get(..6).is_some_and(|start| start.ends_with('%'));
    text.lines().filter(share).collect()
}

#[test]
fn a_run_has_a_line_for_each_step_of_80_columns_and_no_early_estimate() {
    let (screen, log, rows) = shown("all", 1, "-snes_stol 1e-3 -pc_factor_levels 3");
    assert_eq!(screen, log, "the log is what the screen showed");
    fits(&screen);
    let lines = steps(&screen);
    assert_eq!(lines.len(), rows);
    for line in &lines {
        let done: f64 = line[..5].trim().parse().unwrap();
        let left = !line[6..14].trim().is_empty();
        assert!(!(left && done < 10.0), "{line}");
    }
    assert!(lines.iter().any(|line| !line[6..14].trim().is_empty()));
}

#[test]
fn every_line_of_iterations_refusals_and_two_ranks_fits() {
    let (screen, ..) = shown(
        "iterations",
        2,
        "-monitor_iterations -newton_max_iterations 3",
    );
    fits(&screen);
    assert!(screen.contains("residual"));
}

#[test]
fn quiet_shows_verdicts_and_last_words_and_the_log_has_all() {
    let (screen, log, rows) = shown("quiet", 1, "-quiet");
    assert!(steps(&screen).is_empty(), "{screen}");
    assert_eq!(steps(&log).len(), rows);
    assert!(
        screen.trim_start().starts_with("compared quantity"),
        "{screen}"
    );
    assert!(log.ends_with(&screen));
}
