//! Two runs side by side: the table and the page of -compare, and what is said of a folder that holds no run.

mod program;

use std::path::Path;

use program::{run, scratch};

fn small(folder: &Path, more: &str) {
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(
        "-sheet_nx 20 -sheet_ny 2 -stroke 0.2 -time_load 6.4 -unload_fraction 0 -output_every 0"
            .split(' '),
    );
    words.extend(more.split_whitespace());
    let ended = run(1, 60, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
}

#[test]
fn two_runs_stand_side_by_side_with_the_options_that_differ() {
    let folder = scratch("compare");
    let [a, b, page] = ["a", "b", "page"].map(|name| folder.join(name));
    small(&a, "");
    small(&b, "-friction_coefficient 0.1342 -snes_lag_jacobian 2");
    let pair = format!("{},{}", a.display(), b.display());
    let words = ["-compare", &pair, "-output_dir", page.to_str().unwrap()];
    let ended = run(2, 60, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    for part in [
        "-friction_coefficient: 0 and 0.1342",
        "-snes_lag_jacobian: not used and 2",
        "greatest force, N",
        "verdicts that fail 0 of 8 0 of 9",
    ] {
        assert!(ended.says(part), "{part}: {}", ended.stdout);
    }
    assert!(!ended.says("-output_dir"), "{}", ended.stdout);
    let page = std::fs::read_to_string(page.join("comparison.html")).unwrap();
    assert!(page.contains("\"friction_coefficient\":\"0.1342\""));
    assert!(!page.contains("{{") && !page.contains("src="));
}

#[test]
fn a_folder_without_a_run_is_named() {
    let folder = scratch("compare-none");
    let a = folder.join("a");
    small(&a, "");
    for (other, why) in [
        ("nowhere", "No such file or directory"),
        (".", "summary.json, a run's last file, is not there"),
        ("a/history.csv", "it is not a folder"),
    ] {
        let pair = format!("{},{}", a.display(), folder.join(other).display());
        let page = folder.join("page");
        let words = ["-compare", &pair, "-output_dir", page.to_str().unwrap()];
        let ended = run(1, 60, &words);
        assert_eq!(ended.code, Some(2), "{}", ended.text());
        assert!(
            ended.stderr.contains("holds no run that has ended"),
            "{}",
            ended.stderr
        );
        assert!(
            ended.stderr.contains(why) && ended.stderr.lines().count() == 1,
            "{}",
            ended.stderr
        );
        assert!(!page.exists());
    }
    let summary = a.join("summary.json");
    std::fs::write(&summary, "{}").unwrap();
    let pair = format!("{0},{0}", a.display());
    let ended = run(
        1,
        60,
        &["-compare", &pair, "-output_dir", a.to_str().unwrap()],
    );
    assert_eq!(ended.code, Some(2));
    assert!(
        ended.stderr.contains("it is not the summary of a run"),
        "{}",
        ended.stderr
    );
}
