//! The bad option files, environments and arguments: a part of the table.

use super::{BOTH, Given, Mistake, ONE, words};

/// Option files.
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
];

/// Where options come from.
pub const MISTAKES: &[Mistake] = &[
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
];
