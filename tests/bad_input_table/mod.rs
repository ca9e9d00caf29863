//! Bad inputs and the sentence each gets: the table behind tests/bad_input.rs and docs/bad-input.md.

pub mod inverse;
pub mod tools;

/// How an input reaches the program.
pub enum Given {
    /// Words of the command line, with blanks between.
    Words(&'static str),
    /// The environment variable PETSC_OPTIONS.
    Environment(&'static str),
    /// An option with an empty value.
    Empty(&'static str),
    /// One word of the command line that is no text.
    Bytes(&'static [u8]),
}

/// One bad input.
pub struct Mistake {
    pub what: &'static str,
    pub given: Given,
    /// The numbers of ranks it is tried on.
    pub ranks: &'static [usize],
    /// The answer, without the program's name.
    pub sentence: &'static str,
}

/// Files that inputs point to, and what is in them.
pub const FILES: &[(&str, &[u8])] = &[
    ("word.opts", b"-sheet_ny 2\nstroke 4\n"),
    ("range.opts", b"-sheet_ny 0\n"),
    ("two.opts", b"-sheet_ny 2 -sheet_nx 20\n"),
    ("three.opts", b"-report_strokes 1, 2\n"),
    ("quote.opts", b"-output_dir \"my results\n"),
    ("itself.opts", b"-sheet_ny 2\n-options_file itself.opts\n"),
    ("missing.opts", b"-options_file nowhere.opts\n"),
    ("alias.opts", b"alias -nx\n"),
    ("binary.opts", b"\xff\xfe-\x00s\x00\n"),
    ("latin.opts", b"-output_dir M\xfcnchen\n"),
    ("broken.yaml", b"stroke: [\n"),
    ("header.csv", b"2.75177e-3,194\n0.03,250\n"),
    ("empty.csv", b""),
    ("one-point.csv", b"strain,stress\n2.75177e-3,194\n"),
    ("text.csv", b"strain,stress\nhello,world\n"),
    ("semicolon.csv", b"strain,stress\n0,00275177;194\n"),
    ("nan.csv", b"strain,stress\n2.75177e-3,NaN\n0.03,250\n"),
    (
        "negative.csv",
        b"strain,stress\n2.75177e-3,-194\n0.03,250\n",
    ),
    ("percent.csv", b"strain,stress\n2.75177e-3,194\n300,250\n"),
    ("off.csv", b"strain,stress\n0.005,194\n0.03,250\n"),
    (
        "strain-falls.csv",
        b"strain,stress\n2.75177e-3,194\n0.03,250\n0.02,260\n",
    ),
    (
        "stress-falls.csv",
        b"strain,stress\n2.75177e-3,194\n0.03,150\n",
    ),
    ("latin.csv", b"strain,stress\n\xfc\n"),
    ("zero.csv", b"strain,stress\n2.75177e-3,194\n\x00\n"),
    ("file", b""),
];

const ONE: &[usize] = &[1];
/// For one example of each place where input is checked.
const BOTH: &[usize] = &[1, 2];

const fn words(
    what: &'static str,
    ranks: &'static [usize],
    given: &'static str,
    sentence: &'static str,
) -> Mistake {
    Mistake {
        what,
        given: Given::Words(given),
        ranks,
        sentence,
    }
}

/// All of them, by the place where they are found.
pub const MISTAKES: &[Mistake] = &[
    words(
        "misspelt option",
        BOTH,
        "-sheet_lenght 100",
        "option -sheet_lenght is unknown: the nearest one is -sheet_length (0 < value <= 100000 mm; default 120 mm)",
    ),
    words(
        "value after an equals sign",
        ONE,
        "-stroke=3",
        "option -stroke=3 is unknown: the nearest one is -stroke (0 < value <= 100000 mm; default 28.5 mm); name and value are separated by a space",
    ),
    words(
        "two dashes",
        ONE,
        "--stroke 3",
        "option --stroke is written with one dash: -stroke value",
    ),
    words(
        "no dash",
        BOTH,
        "stroke 3",
        "argument 'stroke' is neither an option nor the value of one: options are written -name value, see -help",
    ),
    words(
        "a word too much",
        ONE,
        "-stroke 3 4",
        "argument '4' is neither an option nor the value of one: options are written -name value, see -help",
    ),
    words(
        "unknown option",
        ONE,
        "-contact_stiffness 3",
        "option -contact_stiffness is unknown: the nearest one is -contact_location (points or nodes or closest; default points); -help lists all",
    ),
    words(
        "option of nobody",
        ONE,
        "-verbose",
        "option -verbose is unknown: the nearest one is -overwrite (true or false; default false); -help lists all",
    ),
    words(
        "count of zero",
        BOTH,
        "-sheet_nx 0",
        "option -sheet_nx 0: the value is out of range; specify a whole number: 1 <= value <= 10000 (default 170)",
    ),
    words(
        "count with a fraction",
        ONE,
        "-sheet_nx 2.5",
        "option -sheet_nx 2.5: this is not a whole number; specify a whole number: 1 <= value <= 10000 (default 170)",
    ),
    words(
        "negative count",
        ONE,
        "-output_every -1",
        "option -output_every -1: the value is out of range; specify a whole number: 0 <= value <= 1000000 (default 1)",
    ),
    words(
        "count beyond every integer",
        ONE,
        "-sheet_ny 99999999999999999999999",
        "option -sheet_ny 99999999999999999999999: the value is out of range; specify a whole number: 1 <= value <= 500 (default 5)",
    ),
    words(
        "no value",
        ONE,
        "-sheet_nx",
        "option -sheet_nx has no value: specify a whole number: 1 <= value <= 10000 (default 170)",
    ),
    words(
        "value out of range",
        ONE,
        "-poisson_ratio 0.7",
        "option -poisson_ratio 0.7: the value is out of range; specify a real number: 0 <= value < 0.5 (default 0.342)",
    ),
    words(
        "negative length",
        ONE,
        "-sheet_thickness -1",
        "option -sheet_thickness -1: the value is out of range; specify a real number in mm: 0 < value <= 100000 (default 1 mm)",
    ),
    words(
        "length of zero",
        ONE,
        "-punch_radius 0",
        "option -punch_radius 0: the value is out of range; specify a real number in mm: 0 < value <= 100000 (default 23.5 mm)",
    ),
    words(
        "not a number",
        ONE,
        "-stroke nan",
        "option -stroke nan: the number is not finite; specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    ),
    words(
        "infinite",
        ONE,
        "-young_modulus 1e999",
        "option -young_modulus 1e999: the number is not finite; specify a real number in MPa: 0 < value <= 1e8 (default 70500 MPa)",
    ),
    words(
        "word for a number",
        ONE,
        "-stroke deep",
        "option -stroke deep: this is not a number; specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    ),
    words(
        "decimal comma",
        ONE,
        "-stroke 28,5",
        "option -stroke 28,5: the decimal sign is a point, as in 28.5; specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    ),
    words(
        "exponent with d",
        ONE,
        "-density 2.7d-3",
        "option -density 2.7d-3: the exponent is written with e, as in 1e-3; specify a real number in g/mm3: 0 < value <= 1000 (default 2.7e-3 g/mm3)",
    ),
    words(
        "number with its unit",
        ONE,
        "-stroke 28.5mm",
        "option -stroke 28.5mm: this is not a number; specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    ),
    words(
        "unknown choice",
        ONE,
        "-dynamics fast",
        "option -dynamics fast: this is none of the choices; specify one of the words: slow or none (default slow)",
    ),
    words(
        "number for a flag",
        ONE,
        "-extrapolate 2",
        "option -extrapolate 2: this is neither true nor false; specify one of the words: true or false (default true)",
    ),
    words(
        "tolerance too loose",
        ONE,
        "-newton_tolerance 1",
        "option -newton_tolerance 1: the value is out of range; specify a real number in mm: 0 < value <= 1e-3 (default 1e-9 mm)",
    ),
    words(
        "gap in a list",
        ONE,
        "-report_strokes 1,,2",
        "option -report_strokes 1,,2: a number is missing between the commas; specify real numbers with commas between and no spaces in mm: 0 < each <= 100000, or none (default 1,2,5,8,10,12,15,16,18,20,22,24,26,28 mm)",
    ),
    words(
        "negative stroke in a list",
        ONE,
        "-report_strokes 1,-2",
        "option -report_strokes 1,-2: the value is out of range; specify real numbers with commas between and no spaces in mm: 0 < each <= 100000, or none (default 1,2,5,8,10,12,15,16,18,20,22,24,26,28 mm)",
    ),
    words(
        "time steps in disorder",
        BOTH,
        "-dt_initial 10",
        "the time steps contradict each other: -dt_min 0.000001 ms <= -dt_initial 10 ms <= -dt_max 9 ms does not hold; change one of the three",
    ),
    words(
        "PETSc's step control",
        BOTH,
        "-ts_adapt_type basic",
        "option -ts_adapt_type basic: the program chooses the steps itself, so only none works here; leave it out, and set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load",
    ),
    words(
        "PETSc's other steppers",
        ONE,
        "-ts_type euler",
        "option -ts_type euler: the equations with inertia (-dynamics slow) are of second order in time, so only alpha2 works here; leave it out, and choose between inertia and statics with -dynamics",
    ),
    words(
        "PETSc's other steppers in statics",
        BOTH,
        "-dynamics none -ts_type alpha2",
        "option -ts_type alpha2: the static equations (-dynamics none) hold at the end of each step, so only beuler works here; leave it out, and choose between inertia and statics with -dynamics",
    ),
    words(
        "spectral radius of PETSc's stepper",
        BOTH,
        "-ts_alpha_radius 0.5",
        "option -ts_alpha_radius 0.5: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "alpha_m of PETSc's stepper",
        ONE,
        "-ts_alpha_alpha_m 1.5",
        "option -ts_alpha_alpha_m 1.5: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "alpha_f of PETSc's stepper",
        ONE,
        "-ts_alpha_alpha_f 0.9",
        "option -ts_alpha_alpha_f 0.9: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "gamma of PETSc's stepper",
        ONE,
        "-ts_alpha_gamma 0.6",
        "option -ts_alpha_gamma 0.6: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "beta of PETSc's stepper",
        ONE,
        "-ts_alpha_beta 0.3",
        "option -ts_alpha_beta 0.3: contact, stress and inertia hold at the end of a step only with the parameters the program sets (spectral radius 0); leave it out, and shorten the steps with -dt_max where vibrations are damped too much",
    ),
    words(
        "PETSc's first step",
        ONE,
        "-ts_dt 0.5",
        "option -ts_dt 0.5: the program chooses the steps itself; leave it out, and set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load",
    ),
    words(
        "PETSc's first time",
        ONE,
        "-ts_init_time 1",
        "option -ts_init_time 1: every run begins at time 0; leave it out, and set the times with -time_load and -time_unload",
    ),
    words(
        "PETSc's last time",
        ONE,
        "-ts_max_time 1",
        "option -ts_max_time 1: the motion of the punch ends the run; leave it out, and set the times with -time_load and -time_unload",
    ),
    words(
        "unknown solver of PETSc",
        BOTH,
        "-snes_type foo",
        "PETSc error 86: Unknown type. Check for miss-spelling or missing package: https://petsc.org/release/install/install/#external-packages: Unable to find requested SNES type foo; if a value of one of PETSc's options is to blame: -help lists what each can be",
    ),
    words(
        "word for a number of PETSc",
        ONE,
        "-snes_max_it many",
        "PETSc error 63: Argument out of range: Input string many has no integer value (do not include . in it); if a value of one of PETSc's options is to blame: -help lists what each can be",
    ),
    words(
        "option file not there",
        BOTH,
        "-options_file nowhere.opts",
        "option -options_file nowhere.opts: the file cannot be read (No such file or directory (os error 2)); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file without a path",
        ONE,
        "-options_file",
        "option -options_file has no value: specify the path of an option file, for example inputs/ssnp155.opts",
    ),
    words(
        "option file is a folder",
        ONE,
        "-options_file folder",
        "option -options_file folder: the file cannot be read (it is a folder); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file is a pipe",
        BOTH,
        "-options_file pipe",
        "option -options_file pipe: the file cannot be read (it is not a regular file); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file is binary",
        ONE,
        "-options_file binary.opts",
        "option -options_file binary.opts: the file cannot be read (it holds a zero byte, so it is no text); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file is not UTF-8",
        ONE,
        "-options_file latin.opts",
        "option -options_file latin.opts: the file cannot be read (it is not UTF-8 text); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file includes itself",
        BOTH,
        "-options_file itself.opts",
        "option -options_file itself.opts: the file cannot be read (it includes itself); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file includes a missing one",
        ONE,
        "-options_file missing.opts",
        "option -options_file nowhere.opts: the file cannot be read (No such file or directory (os error 2)); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    ),
    words(
        "option file with a word",
        BOTH,
        "-options_file word.opts",
        "option file word.opts, line 2: 'stroke' is not an option, which begins with a dash and a letter",
    ),
    words(
        "option file with two options on a line",
        ONE,
        "-options_file two.opts",
        "option file two.opts, line 1: '-sheet_nx' is a second option and needs its own line",
    ),
    words(
        "option file with two values on a line",
        ONE,
        "-options_file three.opts",
        "option file three.opts, line 1: '2' is too much behind an option and its value; a comment begins with #, and a value with spaces stands in double quotes",
    ),
    words(
        "option file with an open quote",
        ONE,
        "-options_file quote.opts",
        "option file quote.opts, line 1: the double quote before 'my results' is not closed",
    ),
    words(
        "option file with half an alias",
        ONE,
        "-options_file alias.opts",
        "option file alias.opts, line 1: an alias is written: alias -new_name -old_name",
    ),
    words(
        "option file in broken YAML",
        BOTH,
        "-options_file broken.yaml",
        "PETSc refuses its options (PETSc error 76: Error in external library: YAML parser loading error); look at the command line, the option files, PETSC_OPTIONS and .petscrc",
    ),
    words(
        "option file with a value out of range",
        ONE,
        "-options_file range.opts",
        "option -sheet_ny 0: the value is out of range; specify a whole number: 1 <= value <= 500 (default 5)",
    ),
    Mistake {
        what: "word in the environment",
        given: Given::Environment("-stroke 3 4"),
        ranks: BOTH,
        sentence: "environment variable PETSC_OPTIONS: argument '4' is neither an option nor the value of one: options are written -name value, see -help",
    },
    Mistake {
        what: "open quote in the environment",
        given: Given::Environment("-output_dir \"my results"),
        ranks: ONE,
        sentence: "environment variable PETSC_OPTIONS: the double quote before 'my results' is not closed; a value with spaces stands between double quotes",
    },
    Mistake {
        what: "missing option file in the environment",
        given: Given::Environment("-options_file nowhere.opts"),
        ranks: ONE,
        sentence: "environment variable PETSC_OPTIONS: option -options_file nowhere.opts: the file cannot be read (No such file or directory (os error 2)); specify the path of a text file with an option on each line, for example inputs/ssnp155.opts",
    },
    Mistake {
        what: "argument that is not UTF-8",
        given: Given::Bytes(b"-stroke\xff"),
        ranks: BOTH,
        sentence: "argument '-stroke�' is not UTF-8 text: write it in UTF-8, and name files and folders in UTF-8",
    },
    Mistake {
        what: "empty value",
        given: Given::Empty("-stroke"),
        ranks: ONE,
        sentence: "option -stroke has no value: specify a real number in mm: 0 < value <= 100000 (default 28.5 mm)",
    },
    Mistake {
        what: "empty path",
        given: Given::Empty("-output_dir"),
        ranks: ONE,
        sentence: "option -output_dir has no value: specify a path (default results)",
    },
    words(
        "derivative by what is no parameter",
        BOTH,
        "-sensitivity friction_coefficient,stroke",
        "option -sensitivity friction_coefficient,stroke: this is not a list of parameters with a derivative; specify names of options with commas between and no spaces: punch_radius, die_radius, die_shoulder_radius, sheet_thickness, young_modulus, friction_coefficient, contact_compliance, constants of the hardening law in use (table_factor, hollomon_k, hollomon_n, hollomon_elastic_limit, swift_k, swift_eps0, swift_n, voce_sigma0, voce_q, voce_b, linear_sigma0, linear_h), or none (default none)",
    ),
    words(
        "derivative without friction",
        ONE,
        "-sensitivity friction_coefficient",
        "option -sensitivity friction_coefficient: the derivative at 0 would be one-sided, and -friction_coefficient is 0; leave it out, or use a value above 0",
    ),
    words(
        "derivative by a constant of another law",
        ONE,
        "-sensitivity hollomon_k",
        "option -sensitivity hollomon_k: it is no constant of the law in use, -hardening table; leave it out, or choose its law",
    ),
    words(
        "derivative twice",
        ONE,
        "-sensitivity punch_radius,punch_radius",
        "option -sensitivity punch_radius,punch_radius: a parameter is there twice; specify names of options with commas between and no spaces: punch_radius, die_radius, die_shoulder_radius, sheet_thickness, young_modulus, friction_coefficient, contact_compliance, constants of the hardening law in use (table_factor, hollomon_k, hollomon_n, hollomon_elastic_limit, swift_k, swift_eps0, swift_n, voce_sigma0, voce_q, voce_b, linear_sigma0, linear_h), or none (default none)",
    ),
    words(
        "derivative at the end of the range",
        ONE,
        "-sensitivity friction_coefficient -friction_coefficient 10",
        "option -sensitivity friction_coefficient: values on both sides of it are needed, and beside it option -friction_coefficient 10.0001: the value is out of range; specify a real number: 0 <= value <= 10 (default 0)",
    ),
    words(
        "derivatives with the linear systems left to PETSc",
        BOTH,
        "-sensitivity punch_radius -pc_type lu",
        "option -sensitivity punch_radius: the linear systems are left to PETSc, and derivatives need the program's own solve; leave out -sensitivity, or -pc_type and -snes_type",
    ),
    words(
        "factor on a table with another law",
        ONE,
        "-hardening voce -table_factor 1.1",
        "option -table_factor 1.1 has no effect with -hardening voce: it belongs to -hardening table; leave it out, or choose the other law",
    ),
    words(
        "hardening table not there",
        BOTH,
        "-hardening_file nowhere.csv",
        "option -hardening_file: hardening table nowhere.csv cannot be read (No such file or directory (os error 2)); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table is a folder",
        ONE,
        "-hardening_file folder",
        "option -hardening_file: hardening table folder cannot be read (it is a folder); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table is a pipe",
        BOTH,
        "-hardening_file pipe",
        "option -hardening_file: hardening table pipe cannot be read (it is not a regular file); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table never ends",
        ONE,
        "-hardening_file /dev/zero",
        "option -hardening_file: hardening table /dev/zero cannot be read (it is not a regular file); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table too long",
        ONE,
        "-hardening_file long.csv",
        "option -hardening_file: hardening table long.csv cannot be read (it is longer than 1 MiB); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table not UTF-8",
        ONE,
        "-hardening_file latin.csv",
        "option -hardening_file: hardening table latin.csv cannot be read (it is not UTF-8 text); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table with a zero byte",
        ONE,
        "-hardening_file zero.csv",
        "option -hardening_file: hardening table zero.csv cannot be read (it holds a zero byte, so it is no text); specify the path of a text file with the columns strain,stress",
    ),
    words(
        "hardening table empty",
        ONE,
        "-hardening_file empty.csv",
        "option -hardening_file: hardening table empty.csv: the table is empty; it begins with the header strain,stress",
    ),
    words(
        "hardening table without its header",
        ONE,
        "-hardening_file header.csv",
        "option -hardening_file: hardening table header.csv, line 1: the header is '2.75177e-3,194' instead of strain,stress",
    ),
    words(
        "hardening table of one point",
        ONE,
        "-hardening_file one-point.csv",
        "option -hardening_file: hardening table one-point.csv: points: 1; at least two are needed to make a curve",
    ),
    words(
        "hardening table of words",
        ONE,
        "-hardening_file text.csv",
        "option -hardening_file: hardening table text.csv, line 2: the strain 'hello' is not a number such as 2.75177e-3",
    ),
    words(
        "hardening table with semicolons",
        ONE,
        "-hardening_file semicolon.csv",
        "option -hardening_file: hardening table semicolon.csv, line 2: the stress '00275177;194' is not a number such as 2.75177e-3",
    ),
    words(
        "hardening table with NaN",
        ONE,
        "-hardening_file nan.csv",
        "option -hardening_file: hardening table nan.csv, line 2: the stress 'NaN' is not finite",
    ),
    words(
        "hardening table with negative stress",
        ONE,
        "-hardening_file negative.csv",
        "option -hardening_file: hardening table negative.csv, line 2: strain 2.75177e-3 and stress -194 MPa; 0 < strain <= 100 and 0 < stress <= 1e6 MPa are needed",
    ),
    words(
        "hardening table in percent",
        ONE,
        "-hardening_file percent.csv",
        "option -hardening_file: hardening table percent.csv, line 3: strain 300 and stress 250 MPa; 0 < strain <= 100 and 0 < stress <= 1e6 MPa are needed",
    ),
    words(
        "hardening table off the elastic line",
        ONE,
        "-hardening_file off.csv",
        "option -hardening_file: hardening table off.csv, line 2: the first point is not on the elastic line: strain 5e-3 - stress 194 MPa / E 70500 MPa leaves a plastic strain of 2.248e-3 instead of 0; change the point or -young_modulus",
    ),
    words(
        "hardening table with falling strain",
        ONE,
        "-hardening_file strain-falls.csv",
        "option -hardening_file: hardening table strain-falls.csv, line 4: the plastic strain strain - stress / E = 1.631206e-2 is not above the one before (2.645390e-2); it must increase from line to line",
    ),
    words(
        "hardening table that softens",
        ONE,
        "-hardening_file stress-falls.csv",
        "option -hardening_file: hardening table stress-falls.csv, line 3: the stress 150 MPa is below the one before (194 MPa); softening is not supported",
    ),
    words(
        "another modulus than the table's",
        ONE,
        "-young_modulus 210000",
        "option -hardening_file: hardening table of the benchmark, line 5: the first point is not on the elastic line: strain 2.75177e-3 - stress 194 MPa / E 210000 MPa leaves a plastic strain of 1.828e-3 instead of 0; change the point or -young_modulus",
    ),
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
