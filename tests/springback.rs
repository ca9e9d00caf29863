//! The whole travel of the punch on a coarse mesh: the sheet springs back to the same angle whether the punch is withdrawn
//! or vanishes, unless friction makes it yield again while it is withdrawn.

mod program;

use program::{history, run, scratch, summary};

/// Angles after the punch is withdrawn, and after the tools vanish at full stroke, degrees.
fn angles(name: &str, friction: &str) -> (f64, f64) {
    let folder = scratch(&format!("springback-{name}"));
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend(
        "-sheet_nx 85 -sheet_ny 3 -unload_fraction 1 -time_unload 1000 -output_every 0".split(' '),
    );
    words.extend(["-friction_coefficient", friction]);
    let ended = run(1, 300, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let history = history(&folder);
    let last = history["t_ms"].len() - 1;
    assert!(history["force_N"][last].abs() < 1e-3, "the punch is out");
    assert!(history["cone_violation"].iter().all(|&v| v <= 1e-6));
    let refused: f64 = history["refused_solves"].iter().sum();
    assert!(
        refused * 10.0 < history["t_ms"].len() as f64,
        "{refused} refused"
    );
    let summary = summary(&folder);
    let angle = |name: &str| summary["angles_deg"][name].as_f64().unwrap();
    (angle("end of the motion"), angle("tools vanish at 28.5 mm"))
}

#[test]
fn without_friction_both_kinds_of_release_end_at_the_same_angle() {
    let (withdrawn, vanished) = angles("free", "0");
    assert!((withdrawn - vanished).abs() < 0.1, "{withdrawn} {vanished}");
    // Our own value on this mesh, as a regression; the path through the snap scatters by this much.
    assert!((withdrawn - 45.77).abs() < 0.3, "{withdrawn}");
}

#[test]
fn with_friction_the_sheet_yields_again_on_release() {
    let (withdrawn, vanished) = angles("friction", "0.1342");
    assert!((withdrawn - 54.50).abs() < 0.3, "{withdrawn}");
    assert!(vanished - withdrawn > 1.0, "{withdrawn} {vanished}");
}
