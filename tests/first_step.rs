//! The first step, from a sheet that lies on the die without force, takes a handful of iterations whatever the mesh and
//! the geometry.

mod program;

use program::{history, run, scratch};

#[test]
fn the_first_step_is_easy_on_every_mesh_and_geometry() {
    let variants = [
        "",
        "-sheet_nx 41 -sheet_ny 1",
        "-sheet_nx 240",
        "-contact_points_per_edge 3",
        "-contact_points_per_edge 12",
        "-contact_location nodes",
        "-contact_location closest",
        "-die_shoulder_radius 2",
        "-die_shoulder_radius 8",
        "-sheet_thickness 0.4",
        "-sheet_thickness 1.4",
        "-punch_radius 10",
        "-die_radius 40 -sheet_length 200",
        "-dt_initial 9",
        "-friction_coefficient 0.5",
        "-quadrature 3",
        "-dynamics none",
    ];
    for (number, variant) in variants.iter().enumerate() {
        let folder = scratch(&format!("first-step-{number}"));
        let mut words = vec!["-output_dir", folder.to_str().unwrap()];
        words.extend(
            "-sheet_nx 60 -sheet_ny 2 -stroke 0.3 -time_load 9.5 -unload_fraction 0 -output_every 0"
                .split(' '),
        );
        words.extend(variant.split_whitespace());
        let ended = run(1, 60, &words);
        assert!(ended.says("FINISHED"), "{variant}: {}", ended.text());
        let history = history(&folder);
        let (iterations, refused) = (
            history["newton_iterations"][0],
            history["refused_solves"][0],
        );
        assert!(
            iterations <= 5.0 && refused == 0.0,
            "{variant}: {iterations} iterations, {refused} refused"
        );
    }
}
