//! Tools from files: the benchmark's own give the same bits, air bending and a V-die agree with beam theory and with geometry,
//! and what depends on the benchmark's tools knows that they are others.

mod program;
mod tool_theory;

use std::path::Path;

use program::{history, run_into, scratch, summary};
use tool_theory::Bending;

const BAND: &str = "-options_file inputs/band.opts";
const FILES: &str =
    "-punch_profile inputs/tools/benchmark-punch.csv -die_profile inputs/tools/benchmark-die.csv";
/// The benchmark on a coarse mesh.
const SMALL: &str = "-sheet_nx 40 -sheet_ny 2 -output_every 0";

fn rows(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("history.csv")).unwrap()
}

#[test]
fn the_benchmarks_tools_from_files_give_the_same_bits() {
    // The whole motion on one rank; on two a part of it, as the band solver is for one.
    let whole = format!("{BAND} -friction_coefficient 0.1342");
    for (ranks, more, least) in [(1, &whole[..], 100), (2, "-ts_max_steps 40", 40)] {
        let folder = scratch("tools-same");
        let (own, files) = (folder.join("own"), folder.join("files"));
        let own_end = run_into(&own, ranks, &[SMALL, more]);
        let files_end = run_into(&files, ranks, &[SMALL, more, FILES]);
        assert_eq!(own_end.code, files_end.code, "{}", files_end.text());
        assert!(rows(&own).lines().count() > least, "{}", own_end.text());
        assert!(
            rows(&own) == rows(&files),
            "{ranks} ranks, {more}: the rows differ"
        );
    }
}

/// Value of a column at a stroke on the way down, straight between the rows.
fn at(folder: &Path, column: &str, stroke: f64) -> f64 {
    let columns = history(folder);
    let (strokes, values) = (&columns["stroke_mm"], &columns[column]);
    let after = strokes.iter().position(|&d| d >= stroke).unwrap();
    let share = (stroke - strokes[after - 1]) / (strokes[after] - strokes[after - 1]);
    values[after - 1] + share * (values[after] - values[after - 1])
}

/// Force and angle of a run against beam theory where it holds: the sheet touches the nose and the edges only. The beam keeps its
/// thickness, and its neutral line stays in the middle; at a surface strain of 15 % that is worth 2 % of the moment. What the tools'
/// surface yields, 3 µm, and straight lines between the rows are less.
fn agrees_with_a_beam(folder: &Path, bending: &Bending, degrees: &[f64]) {
    for &arm in degrees {
        let beam = bending.at_arm_angle(f64::to_radians(arm));
        let (force, angle) = (
            at(folder, "force_N", beam.stroke),
            at(folder, "angle_deg", beam.stroke),
        );
        println!(
            "d = {:.3} mm: {force:.2} N, beam {:.2}; {angle:.3}°, beam {:.3}",
            beam.stroke, beam.force, beam.angle
        );
        assert!(
            (force / beam.force - 1.0).abs() < 0.02,
            "d = {}: {force} N, beam {} N",
            beam.stroke,
            beam.force
        );
        assert!(
            (angle - beam.angle).abs() < 0.3,
            "d = {}: {angle}°, beam {}°",
            beam.stroke,
            beam.angle
        );
    }
}

#[test]
fn air_bending_agrees_with_a_beam_in_force_angle_and_springback() {
    let folder = scratch("tools-air");
    let mesh = "-sheet_nx 30 -output_every 0";
    let ended = run_into(
        &folder,
        1,
        &["-options_file inputs/air-bending.opts", BAND, mesh],
    );
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let bending = Bending::new(12.0, 2.0);
    agrees_with_a_beam(&folder, &bending, &[5.0, 10.0, 20.0, 30.0, 39.0]);
    // The stroke of the run lies between two arms' angles.
    let (arm, released) = bending.at_stroke(7.5);
    let angles = &summary(&folder)["angles_deg"];
    let found = |name: &str| angles[name].as_f64().unwrap();
    println!("{arm} {released} {angles}");
    assert!(
        (found("full stroke") - arm).abs() < 0.3,
        "{angles}, beam {arm}"
    );
    // Springback is the beam's moment over its stiffness.
    assert!(
        (found("end of the motion") - released).abs() < 0.3,
        "{angles}, beam {released}"
    );

    // What belongs to the benchmark's tools is not claimed for others.
    let summary = summary(&folder);
    let verdicts = summary["verdicts"].to_string();
    assert!(
        !verdicts.contains("code_aster") && !verdicts.contains("document"),
        "{verdicts}"
    );
    let provenance = &summary["provenance"];
    assert!(
        provenance["options"].get("punch_radius").is_none(),
        "{provenance}"
    );
    assert_eq!(
        provenance["options"]["die_profile"],
        "inputs/tools/air-bending-die.csv"
    );
    assert!(
        provenance["inputs"].get("air-bending-punch.csv").is_some(),
        "{provenance}"
    );
    // The page draws these tools: the nose's tip on the sheet, and the die's channel.
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.contains("\"die\":[[") && page.contains("[10.0,-16.0]"));
}

#[test]
fn a_v_die_agrees_with_a_beam_before_it_closes_and_with_its_own_angle_after() {
    let folder = scratch("tools-v");
    let mesh = "-sheet_nx 30 -output_every 0";
    let ended = run_into(&folder, 1, &["-options_file inputs/v-die.opts", BAND, mesh]);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    // The shoulder of 3 mm turns by 45 degrees: its centre is 3 tan 22.5 beyond the corner at 12 mm.
    let shoulder = 12.0 + 3.0 * 22.5_f64.to_radians().tan();
    agrees_with_a_beam(
        &folder,
        &Bending::new(shoulder, 3.0),
        &[5.0, 10.0, 20.0, 30.0],
    );
    // Between flanks 1.04 mm apart an arm of 1 mm cannot be askew by more than 0.04 mm over the 11 mm for which they face
    // each other.
    let angle = summary(&folder)["angles_deg"]["full stroke"]
        .as_f64()
        .unwrap();
    let play = 2.0 * (0.04_f64 / 11.0).atan().to_degrees();
    println!("{angle} {play}");
    assert!((angle - 90.0).abs() < play, "{angle}°, play {play}°");
}

#[test]
fn a_restart_with_another_outline_is_refused_and_with_the_same_one_elsewhere_is_not() {
    let folder = scratch("tools-restart");
    let name = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (tool, copy) = (name("punch.csv"), name("copy.csv"));
    let outline = "x_mm,y_mm,radius_mm\n0,0,0\n23.5,0,23\n23.5,60,0\n";
    std::fs::write(&tool, outline).unwrap();
    std::fs::write(&copy, format!("# the same\n{outline}")).unwrap();
    let results = folder.join("results");
    let small =
        "-sheet_nx 20 -sheet_ny 2 -stroke 0.5 -time_load 16 -unload_fraction 0 -output_every 0";
    let wide = "-penetration_limit 0.02 -punch_profile";
    run_into(
        &results,
        1,
        &[small, wide, &tool, "-ts_max_steps 3 -checkpoint_every 1"],
    );
    std::fs::write(&tool, outline.replace("23.5,60", "23.5,61")).unwrap();
    let refused = run_into(&results, 1, &[small, wide, &tool, "-restart"]);
    assert_eq!(refused.code, Some(2), "{}", refused.text());
    assert!(
        refused.stderr.contains("-punch_profile was the outline of")
            && refused.stderr.contains("belongs to another problem"),
        "{}",
        refused.stderr
    );
    let benchmark = run_into(&results, 1, &[small, "-penetration_limit 0.02 -restart"]);
    assert_eq!(benchmark.code, Some(2), "{}", benchmark.text());
    assert!(
        benchmark.stderr.contains("and is the outline of benchmark"),
        "{}",
        benchmark.stderr
    );
    let resumed = run_into(&results, 1, &[small, wide, &copy, "-restart"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.text());
    assert!(resumed.stdout.contains("resumed from"));
}

#[test]
fn a_dry_run_says_and_draws_where_the_tools_are() {
    let folder = scratch("tools-dry");
    let ended = run_into(&folder, 2, &["-options_file inputs/v-die.opts -dry_run"]);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    for part in [
        "3 corners of inputs/tools/v-punch.csv, sharpest radius that sticks out 2 mm, touches first at x = 0 mm",
        "3 corners of inputs/tools/v-die.csv, sharpest radius that sticks out 3 mm, holds the sheet from x = 13.2426 to 30 mm",
        "at least 1.041 mm between the tools for a sheet of 1 mm, at a stroke of 10.7 mm",
    ] {
        assert!(ended.says(part), "{part}: {}", ended.stdout);
    }
    let sketch = std::fs::read_to_string(folder.join("model.svg")).unwrap();
    assert!(sketch.contains("punch, v-punch.csv") && sketch.contains("die, v-die.csv"));
}
