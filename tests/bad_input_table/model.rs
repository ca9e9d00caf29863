//! The models and folders that cannot be: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// What is in the place of a folder.
pub const FILES: &[(&str, &[u8])] = &[("file", b"")];

/// What does not fit, and where nothing can be written.
pub const MISTAKES: &[Mistake] = &[
    words(
        "sheet thicker than the clearance",
        ONE,
        "-punch_radius 24.5",
        "the sheet does not fit between punch and die: -die_radius 25 mm less -punch_radius 24.5 mm leaves 0.5 mm and -sheet_thickness is 1 mm; make the clearance greater than the thickness",
    ),
    words(
        "punch finer than the mesh",
        ONE,
        "-punch_radius 0.01",
        "the mesh cannot feel the punch: -punch_radius 0.01 mm is smaller than the distance between contact points, 0.059 mm; use a larger radius, or more elements with -sheet_nx",
    ),
    words(
        "stroke deeper than the die",
        BOTH,
        "-stroke 40",
        "-stroke 40 mm squeezes the sheet on the bottom of the die, which is 29 mm below the die's flat (-die_radius + -die_shoulder_radius); use a stroke below 29 mm or a deeper die",
    ),
    words(
        "sheet shorter than the die",
        ONE,
        "-sheet_length 50",
        "the sheet does not rest on the die: half of -sheet_length is 25 mm and the die's flat begins at 29 mm (-die_radius + -die_shoulder_radius); use a -sheet_length above 60 mm, which leaves a thickness to spare at each end",
    ),
    words(
        "sheet drawn off the die",
        ONE,
        "-sheet_length 80",
        "the sheet slips off the die's shoulder: at -stroke 28.5 mm the path round the punch to the shoulder is 39.290 mm and half of -sheet_length is 40 mm; use a -sheet_length above 80.581 mm or a shorter stroke",
    ),
    words(
        "more ranks than elements",
        &[3],
        "-sheet_nx 2 -sheet_ny 1 -contact_points_per_edge 8",
        "too many MPI ranks: 3, and the mesh has -sheet_nx 2 times -sheet_ny 1 elements; every rank needs one: use mpirun -n 2 or less, or refine the mesh",
    ),
    words(
        "results in the place of a file",
        BOTH,
        "-output_dir file",
        "the output folder file is a file, not a folder; choose another one with -output_dir, or move the file away",
    ),
    words(
        "results below a file",
        ONE,
        "-output_dir file/run",
        "cannot create the output folder file/run: Not a directory (os error 20); choose another one with -output_dir",
    ),
    words(
        "results where no file can be made",
        BOTH,
        "-output_dir /proc",
        "the output folder /proc takes no files: No such file or directory (os error 2); choose another one with -output_dir",
    ),
    words(
        "a folder has the name of a result",
        BOTH,
        "-output_dir taken",
        "taken/summary.json cannot be written over: it is not a file; move it away, or choose another folder with -output_dir",
    ),
];
