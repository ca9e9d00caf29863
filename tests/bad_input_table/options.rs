//! The bad options of the program: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// Names and values.
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
];
