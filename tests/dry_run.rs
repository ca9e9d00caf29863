//! `-dry_run` tells what would be solved, draws it, solves nothing, and refuses what a run would refuse.

mod program;

use program::{run, scratch};

fn words(folder: &str) -> Vec<&str> {
    vec!["-dry_run", "-output_dir", folder]
}

#[test]
fn the_model_is_told_and_drawn_and_nothing_else_is_written() {
    for ranks in [1, 3] {
        let folder = scratch(&format!("dry-run-{ranks}"));
        let ended = run(ranks, 60, &words(folder.to_str().unwrap()));
        assert_eq!(ended.code, Some(0), "{}", ended.text());
        for part in [
            "170 x 5 = 850 elements",
            "2901 nodes, 3400 Gauss points",
            "9882: 5802 displacements, 4080 of contact",
            "2040 points on both faces",
            "down by 28.5 mm in 900 ms, back by 2.85 mm in 100 ms; with inertia",
            "yields at 194 MPa",
        ] {
            assert!(ended.says(part), "{part}: {}", ended.stdout);
        }
        assert_eq!(ended.stdout.matches("dry run").count(), 1);
        // The last columns of the table, one row per rank.
        let table = ended.stdout.split("contact points").last().unwrap();
        let rows: Vec<Vec<usize>> = table
            .lines()
            .map(|line| {
                line.split_whitespace()
                    .map_while(|word| word.parse().ok())
                    .collect()
            })
            .filter(|row: &Vec<usize>| row.len() == 6)
            .collect();
        assert_eq!(rows.len(), ranks);
        let sum = |column: usize| rows.iter().map(|row| row[column]).sum::<usize>();
        assert_eq!((sum(1), sum(4), sum(5)), (850, 2040, 9882));
        assert_eq!(sum(3) > 0, ranks > 1);
        let mut files: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        files.sort();
        assert_eq!(files, ["model.png", "model.svg"]);
        let sketch = std::fs::read_to_string(folder.join("model.svg")).unwrap();
        assert!(
            sketch.contains("punch, radius 23.5 mm") && sketch.contains("punch at full stroke")
        );
    }
}

#[test]
fn what_a_run_refuses_a_dry_run_refuses() {
    let folder = scratch("dry-run-refused");
    let mut words = words(folder.to_str().unwrap());
    words.extend(["-stroke", "40"]);
    let ended = run(1, 60, &words);
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}
