//! Whatever a person gets wrong is answered with one sentence, once over all ranks, and a code that is not 0: no panic,
//! no traceback, no hang, and no file touched.

mod program;

use std::path::Path;

use program::{run, scratch};

/// Longest time an answer may take, s.
const PATIENCE: u32 = 30;

/// The program refuses these words on this many ranks, with this sentence only.
#[track_caller]
fn refused_on(ranks: usize, words: &[&str], sentence: &str) {
    let ended = run(ranks, PATIENCE, words);
    let place = format!("{words:?} on {ranks} ranks: {}", ended.text());
    assert_eq!(ended.code, Some(2), "{place}");
    assert_eq!(
        ended.stderr.trim(),
        format!("ssnp155: {sentence}"),
        "{place}"
    );
    assert_eq!(ended.stdout.trim(), "", "{place}");
}

/// The same on one rank.
#[track_caller]
fn refused(words: &[&str], sentence: &str) {
    refused_on(1, words, sentence);
}

/// The same on one and on two ranks: for one example of each place where input is checked.
#[track_caller]
fn refused_everywhere(words: &[&str], sentence: &str) {
    refused_on(1, words, sentence);
    refused_on(2, words, sentence);
}

/// The same with a file of this content, whose path stands for `{}` in words and sentence.
#[track_caller]
fn refused_file(option: &str, name: &str, content: &[u8], sentence: &str) {
    let path = scratch(&format!("bad-input-{name}")).join(name);
    std::fs::write(&path, content).unwrap();
    let path = path.to_str().unwrap();
    refused(&[option, path], &sentence.replace("{}", path));
}

#[test]
fn misspelt_options() {
    let length = "-sheet_length (0 < value <= 100000 mm; default 120 mm)";
    refused_everywhere(
        &["-sheet_lenght", "100"],
        &format!("option -sheet_lenght is unknown: the nearest one is {length}"),
    );
    refused(
        &["--stroke", "3"],
        "option --stroke is written with one dash: -stroke value",
    );
    refused(
        &["-stroke=3"],
        "option -stroke=3 is unknown: the nearest one is -stroke (0 < value <= 100000 mm; default 28.5 mm); name and \
         value are separated by a space",
    );
    refused_everywhere(
        &["stroke", "3"],
        "argument 'stroke' is neither an option nor the value of one: options are written -name value, see -help",
    );
    refused(
        &["-stroke", "3", "4"],
        "argument '4' is neither an option nor the value of one: options are written -name value, see -help",
    );
}

#[test]
fn values_out_of_range_or_of_another_kind() {
    refused_everywhere(
        &["-sheet_nx", "0"],
        "option -sheet_nx 0: the value is out of range; give a whole number: 1 <= value <= 10000 (default 170)",
    );
    refused(
        &["-sheet_nx", "2.5"],
        "option -sheet_nx 2.5: this is not a whole number; give a whole number: 1 <= value <= 10000 (default 170)",
    );
    refused(
        &["-sheet_nx"],
        "option -sheet_nx has no value: give a whole number: 1 <= value <= 10000 (default 170)",
    );
    refused(
        &["-poisson_ratio", "0.7"],
        "option -poisson_ratio 0.7: the value is out of range; give a real number: 0 <= value < 0.5 (default 0.342)",
    );
    refused(
        &["-stroke", "nan"],
        "option -stroke nan: the number is not finite; give a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    );
    refused(
        &["-stroke", "deep"],
        "option -stroke deep: this is not a number; give a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    );
    refused(
        &["-dynamics", "fast"],
        "option -dynamics fast: this is none of the choices; give one of the words: slow or none (default slow)",
    );
    refused(
        &["-report_strokes", "1,,2"],
        "option -report_strokes 1,,2: a number is missing between the commas; give real numbers with commas between and \
         no spaces in mm: 0 < each <= 100000, or none (default 1,2,5,8,10,12,15,16,18,20,22,24,26,28 mm)",
    );
    refused_everywhere(
        &["-dt_initial", "10"],
        "the time steps contradict each other: -dt_min 0.000001 ms <= -dt_initial 10 ms <= -dt_max 9 ms does not hold; \
         change one of the three",
    );
}

#[test]
fn option_files() {
    refused_everywhere(
        &["-options_file", "/nowhere/case.opts"],
        "option -options_file /nowhere/case.opts: the file cannot be read (No such file or directory (os error 2)); \
         give the path of a readable text file",
    );
    refused(
        &["-options_file"],
        "option -options_file has no value: give the path of an option file, for example inputs/ssnp155.opts",
    );
    refused_file(
        "-options_file",
        "words.opts",
        b"-sheet_ny 2\nstroke 4\n",
        "option file {}, line 2: 'stroke' is not an option, which begins with a dash and a letter",
    );
    refused_file(
        "-options_file",
        "range.opts",
        b"-sheet_ny 0\n",
        "option -sheet_ny 0: the value is out of range; give a whole number: 1 <= value <= 500 (default 5)",
    );
}

#[test]
fn hardening_tables() {
    refused_everywhere(
        &["-hardening_file", "/nowhere/table.csv"],
        "option -hardening_file: hardening table /nowhere/table.csv cannot be read (No such file or directory \
         (os error 2)); give the path of a text file with the columns strain,stress",
    );
    let malformed: [(&str, &[u8], &str); 7] = [
        (
            "falling-strain.csv",
            b"strain,stress\n2.75177e-3,194\n0.03,250\n0.02,260\n",
            "{}, line 4: the plastic strain strain - stress / E = 1.631206e-2 is not above the one before \
             (2.645390e-2); it must increase from line to line",
        ),
        (
            "falling-stress.csv",
            b"strain,stress\n2.75177e-3,194\n0.03,150\n",
            "{}, line 3: the stress 150 MPa is below the one before (194 MPa); softening is not supported",
        ),
        (
            "text.csv",
            b"strain,stress\nhello,world\n",
            "{}, line 2: the strain 'hello' is not a number such as 2.75177e-3",
        ),
        (
            "header.csv",
            b"2.75177e-3,194\n0.03,250\n",
            "{}, line 1: the header is '2.75177e-3,194' instead of strain,stress",
        ),
        (
            "empty.csv",
            b"",
            "{}: the table is empty; it begins with the header strain,stress",
        ),
        (
            "one-point.csv",
            b"strain,stress\n2.75177e-3,194\n",
            "{}: points: 1; at least two are needed to make a curve",
        ),
        (
            "not-text.csv",
            b"strain,stress\n\xff\xfe\n",
            "{} cannot be read (it is not UTF-8 text); give the path of a text file with the columns strain,stress",
        ),
    ];
    for (name, content, sentence) in malformed {
        let sentence = format!("option -hardening_file: hardening table {sentence}");
        refused_file("-hardening_file", name, content, &sentence);
    }
}

#[test]
fn output_folders() {
    let folder = scratch("bad-input-output");
    let file = folder.join("taken");
    std::fs::write(&file, "").unwrap();
    let file = file.to_str().unwrap();
    refused_everywhere(
        &["-output_dir", file],
        &format!(
            "the output folder {file} is a file, not a folder; give another one with -output_dir, or move the file away"
        ),
    );
    // A folder below a file cannot be made, not even by root.
    let below = format!("{file}/run");
    refused(
        &["-output_dir", &below],
        &format!(
            "cannot create the output folder {below}: Not a directory (os error 20); give another one with -output_dir"
        ),
    );
    // /proc takes no files, not even from root.
    refused_everywhere(
        &["-output_dir", "/proc"],
        "the output folder /proc takes no files: No such file or directory (os error 2); give another one with \
         -output_dir",
    );
}

#[test]
fn geometry_that_cannot_work() {
    refused(
        &["-punch_radius", "24.5"],
        "the sheet does not fit between punch and die: -die_radius 25 mm less -punch_radius 24.5 mm leaves 0.5 mm and \
         -sheet_thickness is 1 mm; make the clearance greater than the thickness",
    );
    refused_everywhere(
        &["-stroke", "40"],
        "-stroke 40 mm squeezes the sheet on the bottom of the die, which is 29 mm below the die's flat (-die_radius + \
         -die_shoulder_radius); give a stroke below 29 mm or a deeper die",
    );
    refused(
        &["-sheet_length", "50"],
        "the sheet does not rest on the die: half of -sheet_length is 25 mm and the die's flat begins at 29 mm \
         (-die_radius + -die_shoulder_radius); give a -sheet_length above 60 mm, which leaves a thickness to spare at \
         each end",
    );
    refused(
        &["-sheet_length", "80"],
        "the sheet slips off the die's shoulder: at -stroke 28.5 mm the way round the punch to the shoulder is 39.290 \
         mm and half of -sheet_length is 40 mm; give a -sheet_length above 80.581 mm or a shorter stroke",
    );
}

#[test]
fn more_ranks_than_elements() {
    let ended = run(3, PATIENCE, &["-sheet_nx", "2", "-sheet_ny", "1"]);
    assert_eq!(ended.code, Some(2), "{}", ended.text());
    assert_eq!(
        ended.stderr.trim(),
        "ssnp155: too many MPI ranks: 3, and the mesh has -sheet_nx 2 times -sheet_ny 1 elements; every rank needs \
         one: give mpirun -n 2 or less, or refine the mesh"
    );
}

#[test]
fn neither_a_slip_nor_a_question_touches_an_earlier_run() {
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
        assert!(help.stdout.contains(option), "{option}");
    }
    assert_eq!(std::fs::read_to_string(&history).unwrap(), "earlier");
    assert_eq!(std::fs::read_dir(Path::new(folder)).unwrap().count(), 1);
}

#[test]
fn an_option_that_petsc_does_not_read_is_told_after_the_run() {
    let folder = scratch("bad-input-unread");
    let mut words = vec!["-output_dir", folder.to_str().unwrap(), "-snes_maxit", "4"];
    words.extend("-sheet_nx 20 -sheet_ny 1 -stroke 0.1 -time_load 2 -unload_fraction 0".split(' '));
    let ended = run(2, PATIENCE, &words);
    assert_eq!(ended.code, Some(0), "{}", ended.text());
    let warning = "warning: option -snes_maxit 4 has no effect: PETSc did not read it; check its spelling and whether \
                   the chosen solver has it\n";
    assert_eq!(
        ended.stdout.matches("warning:").count(),
        1,
        "{}",
        ended.stdout
    );
    assert!(ended.stdout.contains(warning), "{}", ended.stdout);
}
