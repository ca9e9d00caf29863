//! The bad hardening tables, laws and derivatives: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// Hardening tables.
pub const FILES: &[(&str, &[u8])] = &[
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
];

/// Tables, laws, and what is no parameter of the law in use.
pub const MISTAKES: &[Mistake] = &[
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
];
