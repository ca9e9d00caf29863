//! What a run with friction writes about its contact: one state from the law to the files and the report.

mod program;

use hdf5::{File, H5Type};
use program::{run, scratch};

const FRICTION: f64 = 0.1342;

fn read<T: H5Type>(file: &File, name: &str) -> Vec<T> {
    let dataset = file.dataset(&format!("VTKHDF/{name}")).unwrap();
    dataset.read_raw().unwrap()
}

/// Going down the sheet slips over the tools one way, going back it sticks and slips the other way.
#[test]
fn stick_and_both_directions_of_slip_reach_the_files_and_the_report() {
    let folder = scratch("output-contact");
    let mut words = vec!["-output_dir", folder.to_str().unwrap()];
    words.extend("-sheet_nx 40 -sheet_ny 2 -friction_coefficient 0.1342".split(' '));
    words.extend("-stroke 12 -time_load 380 -time_unload 380 -unload_fraction 0.5".split(' '));
    words.extend(["-report_strokes", "none"]);
    let ended = run(1, 120, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());

    let contact = File::open(folder.join("contact.vtkhdf")).unwrap();
    let states: Vec<i32> = read(&contact, "PointData/contact_status");
    for state in 0..=3 {
        assert!(
            states.contains(&state),
            "no contact point has state {state}"
        );
    }
    assert!(states.iter().all(|state| (0..=3).contains(state)));
    let pressure: Vec<f64> = read(&contact, "PointData/contact_pressure");
    let traction: Vec<f64> = read(&contact, "PointData/friction_traction");
    for ((&state, p), t) in states.iter().zip(&pressure).zip(&traction) {
        let limit = FRICTION * p;
        // Friction acts against the slip; at its limit it is as large as Coulomb's law allows.
        let expected = match state {
            2 | 3 => (t.abs() - limit).abs() <= 1e-6 * limit,
            1 => t.abs() <= (1.0 + 1e-6) * limit,
            _ => true,
        };
        assert!(expected, "state {state}, pressure {p}, friction {t}");
    }
    let sign = |state: i32| {
        let of_state = states.iter().zip(&traction).filter(|(s, _)| **s == state);
        let mut signs: Vec<f64> = of_state.map(|(_, t)| t.signum()).collect();
        signs.dedup();
        signs
    };
    let (forward, backward) = (sign(2), sign(3));
    assert_eq!((forward.len(), backward.len()), (1, 1));
    assert_eq!(forward[0], -backward[0]);

    let fields = File::open(folder.join("fields.vtkhdf")).unwrap();
    let at_nodes: Vec<i32> = read(&fields, "PointData/contact_status");
    let nodal: Vec<f64> = read(&fields, "PointData/contact_pressure");
    let heights: Vec<f64> = read::<f64>(&fields, "Points")
        .chunks(3)
        .map(|x| x[1])
        .collect();
    for state in -1..=3 {
        assert!(at_nodes.contains(&state), "no node has state {state}");
    }
    for (row, (&state, p)) in at_nodes.iter().zip(&nodal).enumerate() {
        let y = heights[row % heights.len()];
        let inside = y > 1e-9 && y < 1.0 - 1e-9;
        assert_eq!(state == -1, inside, "state {state} at y = {y} mm");
        // An open point may keep what rounding leaves of a force.
        let fits = if state > 0 { *p > 0.0 } else { *p < 1e-9 };
        assert!(fits, "state {state}, pressure {p} MPa");
    }

    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    let data = page.split("id=\"data\">").nth(1).unwrap();
    let data = data.split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let shown = data["states"]["contact"]["status"].as_array().unwrap();
    let closed = states.iter().filter(|state| **state > 0);
    assert!(
        shown
            .iter()
            .map(|s| s.as_i64().unwrap() as i32)
            .eq(closed.copied())
    );
}
