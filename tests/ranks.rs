//! The number of ranks changes the order of sums and nothing else: forces and angles at given strokes agree.

mod program;

use std::collections::BTreeMap;

use program::{history, run, scratch};

const STROKES: &str = "1,2,3,4,5";
/// Relative difference of the force: the solves stop at 1e-9 mm, which the last iteration undercuts by far, and rounding is
/// not yet amplified by a snap.
const FORCE: f64 = 1e-9;
/// Difference of the angle, degrees; likewise.
const ANGLE: f64 = 1e-7;

/// Force (N) and angle (degrees) by stroke in micrometres.
fn results(ranks: usize) -> BTreeMap<i64, (f64, f64)> {
    let folder = scratch(&format!("ranks-{ranks}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(["-report_strokes", STROKES]);
    words.extend(
        "-sheet_nx 60 -sheet_ny 2 -stroke 6 -time_load 189 -unload_fraction 0 -output_every 0"
            .split(' '),
    );
    let ended = run(ranks, 120, &words);
    assert_eq!(ended.code, Some(0), "{ranks} ranks: {}", ended.text());
    let history = history(&folder);
    let mut results = BTreeMap::new();
    for (row, stroke) in history["stroke_mm"].iter().enumerate() {
        let key = (stroke * 1e3).round() as i64;
        results.insert(key, (history["force_N"][row], history["angle_deg"][row]));
    }
    results
}

#[test]
fn one_to_four_ranks_give_the_same_forces_and_angles() {
    let one = results(1);
    for ranks in 2..=4 {
        let other = results(ranks);
        for stroke in STROKES
            .split(',')
            .map(|mm| 1000 * mm.parse::<i64>().unwrap())
            .chain([6000])
        {
            let ((force, angle), (same_force, same_angle)) = (one[&stroke], other[&stroke]);
            let (df, da) = (
                (force - same_force).abs() / force,
                (angle - same_angle).abs(),
            );
            println!("{ranks} ranks, {stroke} micrometres: force {df:.1e}, angle {da:.1e} degrees");
            assert!(
                df < FORCE && da < ANGLE,
                "{ranks} ranks at {stroke} micrometres"
            );
        }
    }
}
