//! Misspelt options and stray words are refused with the name that was meant; PETSc's own are left to PETSc.

use proptest::prelude::{any, proptest};
use ssnp155::case::{Case, check_arguments, check_options_file, check_unused};

const CASE_FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/ssnp155.opts");

fn error_of(name: &str) -> Option<String> {
    let (errors, warnings) = check_unused(&[(name.to_owned(), Some("1".to_owned()))]);
    assert_eq!(errors.len() + warnings.len(), 1, "{name}");
    errors.first().map(ToString::to_string)
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// The error for an option file with this content.
fn file_error(name: &str, content: &[u8]) -> Option<String> {
    let path = std::env::temp_dir().join(format!("ssnp155-{}-{name}", std::process::id()));
    std::fs::write(&path, content).unwrap();
    let result = check_options_file(&["-options_file".to_owned(), path.display().to_string()]);
    std::fs::remove_file(&path).unwrap();
    result.err().map(|error| error.to_string())
}

#[test]
fn a_slip_of_the_pen_names_the_option_that_was_meant() {
    for (given, meant) in [
        ("sheet_lenght", "sheet_length"),
        ("punch_radus", "punch_radius"),
        ("die_radus", "die_radius"),
        ("strok", "stroke"),
        ("Stroke_", "stroke"),
        ("youngs_modulus", "young_modulus"),
        ("poisson", "poisson_ratio"),
        ("contact_complience", "contact_compliance"),
        ("dtmax", "dt_max"),
        ("output-dir", "output_dir"),
        ("Output_Dri", "output_dir"),
        ("newton_tol", "newton_tolerance"),
        ("die_shoulder", "die_shoulder_radius"),
        ("unload_frac", "unload_fraction"),
        ("option_file", "options_file"),
        ("options_fil", "options_file"),
    ] {
        let error = error_of(given).unwrap_or_else(|| panic!("-{given} is only warned about"));
        assert!(
            error.starts_with(&format!(
                "option -{given} is unknown: the nearest one is -{meant} ("
            )),
            "{error}"
        );
    }
    assert_eq!(
        error_of("sheet_lenght").unwrap(),
        "option -sheet_lenght is unknown: the nearest one is -sheet_length (0 < value <= 100000 mm; default 120 mm)"
    );
    assert!(
        error_of("stroke=20")
            .unwrap()
            .ends_with("; name and value are separated by a space")
    );
}

#[test]
fn an_option_of_nobody_is_an_error() {
    assert!(error_of("friction").unwrap().ends_with("; -help lists all"));
    for name in [
        "friction_law",
        "use_friction",
        "start",
        "foo",
        "",
        "größe",
        "x",
    ] {
        assert!(error_of(name).is_some(), "-{name}");
    }
}

#[test]
fn petsc_options_nobody_read_are_warned_about() {
    for name in [
        "snes_monitr",
        "snes_max_it",
        "ksp_rtol",
        "pc_factor_mat_solver_type",
        "mat_mumps_icntl_7",
        "ts_dt",
        "ts_max_time",
        "ts_adapt_dt_max",
        "vec_type",
        "log_view",
        "options_left",
        "options_view",
        "malloc_debug",
        "memory_view",
        "info",
        "on_error_abort",
        "start_in_debugger",
        "fp_trap",
        "dm_view",
        "viewer_binary_skip_info",
        "sub_pc_type",
        "npc_snes_type",
        "help",
        "version",
        "nox",
        "mat_view",
        "snes_linesearch_damping",
        "snes_vi_monitor",
        "mpi_linear_solver_server",
        "ts_exact_final_time",
        "options_file_yaml",
    ] {
        assert_eq!(error_of(name), None, "-{name}");
    }
    let (_, warnings) = check_unused(&[
        ("snes_monitr".to_owned(), None),
        ("ksp_rtoll".to_owned(), Some("1e-3".to_owned())),
    ]);
    assert!(
        warnings[0]
            .to_string()
            .starts_with("option -snes_monitr has no effect: PETSc did not read it")
    );
    assert!(
        warnings[1]
            .to_string()
            .starts_with("option -ksp_rtoll 1e-3 has no effect")
    );
}

#[test]
fn no_option_of_ours_looks_like_petscs() {
    // Otherwise its misspelling could pass as a warning: every name with a slip at its end is an error.
    for (name, _) in Case::reference().unwrap().options() {
        assert!(error_of(&format!("{name}x")).is_some(), "-{name}");
    }
}

#[test]
fn words_of_the_command_line_are_options_or_values() {
    for line in [
        "",
        "-help",
        "-stroke 20 -log_view",
        "-stroke -5",
        "-snes_monitor -stroke 20",
        "-stroke -nan",
    ] {
        assert!(check_arguments(&words(line)).is_ok(), "{line}");
    }
    for (line, stray) in [
        ("stroke 20", "stroke"),
        ("-stroke 20 30", "30"),
        ("inputs/ssnp155.opts", "inputs/ssnp155.opts"),
    ] {
        let error = check_arguments(&words(line)).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!(
                "argument '{stray}' is neither an option nor the value of one"
            )),
            "{error}"
        );
    }
}

#[test]
fn an_option_file_is_there_and_readable() {
    assert!(check_options_file(&words(&format!("-options_file {CASE_FILE} -stroke 20"))).is_ok());
    for line in [
        "-options_file",
        "-options_file -stroke 20",
        "-stroke 20 -OPTIONS_FILE",
    ] {
        let error = check_options_file(&words(line)).unwrap_err().to_string();
        assert!(
            error.starts_with("option -options_file has no value"),
            "{error}"
        );
    }
    let error = check_options_file(&words("-options_file no/such.opts"))
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with(
            "option -options_file no/such.opts: the file cannot be read (No such file"
        ),
        "{error}"
    );
    assert!(check_options_file(&["-options_file".to_owned(), "/".to_owned()]).is_err());
    assert!(
        check_options_file(&words("--options_file x"))
            .unwrap_err()
            .to_string()
            .contains("one dash")
    );
    assert!(
        file_error("binary", &[0xff, 0xfe])
            .unwrap()
            .contains("not UTF-8")
    );
}

#[test]
fn the_lines_of_an_option_file_are_options() {
    for content in [
        "",
        "# only\n",
        "  -stroke 20 # mm\r\n\n-log_view\n",
        "-stroke -5",
        "alias -a -b",
        "-x \"a b c\"",
    ] {
        assert_eq!(file_error("good", content.as_bytes()), None, "{content}");
    }
    for (content, problem) in [
        ("\nstroke 20", "line 2: 'stroke' is not an option"),
        ("-stroke 20 mm", "line 1: 'mm' is too much"),
        (
            "-log_view -stroke 20",
            "line 1: '-stroke' is a second option",
        ),
        ("-5", "line 1: '-5' is not an option"),
    ] {
        let error = file_error("bad", content.as_bytes()).unwrap();
        assert!(
            error.starts_with("option file ") && error.contains(problem),
            "{error}"
        );
    }
}

proptest! {
    #[test]
    fn any_name_is_sorted(name in any::<String>(), value in any::<Option<String>>()) {
        let (errors, warnings) = check_unused(&[(name, value)]);
        assert_eq!(errors.len() + warnings.len(), 1);
    }

    #[test]
    fn any_command_line_is_checked(args in any::<Vec<String>>()) {
        let _ = check_arguments(&args);
    }
}
