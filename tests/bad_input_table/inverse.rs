//! The bad inputs of identification and design: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// Measured curves.
pub const FILES: &[(&str, &[u8])] = &[
    ("kilo.csv", b"stroke_mm,force_kN,uncertainty_N\n1,0.05,1\n"),
    (
        "press-text.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,1\n2,eighty,1\n",
    ),
    (
        "press-short.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,1\n2,85\n",
    ),
    (
        "press-back.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,1\n2,85,1\n1.5,80,1\n",
    ),
    (
        "press-deep.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,1\n30,300,1\n",
    ),
    (
        "press-sure.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,0\n",
    ),
    (
        "press-good.csv",
        b"stroke_mm,force_N,uncertainty_N\n1,50,1\n2,85,1\n",
    ),
    ("press.csv", b"stroke_mm,force_N,uncertainty_N\n1,50,1\n"),
];

/// What is looked for, and where.
pub const MISTAKES: &[Mistake] = &[
    words(
        "measured curve that is not there",
        BOTH,
        "-identify nowhere.csv -parameters table_factor:0.5:1.5",
        "measured curve nowhere.csv: the file cannot be read (No such file or directory (os error 2)); specify the path of a CSV file with the header stroke_mm,force_N,uncertainty_N",
    ),
    words(
        "measured curve in other units",
        ONE,
        "-identify kilo.csv -parameters table_factor:0.5:1.5",
        "measured curve kilo.csv: the header is 'stroke_mm,force_kN,uncertainty_N' instead of stroke_mm,force_N,uncertainty_N; convert to these units and name the columns so",
    ),
    words(
        "measured curve with a word for a number",
        BOTH,
        "-identify press-text.csv -parameters table_factor:0.5:1.5",
        "measured curve press-text.csv, line 3: force_N 'eighty' is not a finite number such as 180.5",
    ),
    words(
        "measured curve with a number missing",
        ONE,
        "-identify press-short.csv -parameters table_factor:0.5:1.5",
        "measured curve press-short.csv, line 3: the line has another number of columns than the header; each needs a comma",
    ),
    words(
        "measured curve with the travel back",
        ONE,
        "-identify press-back.csv -parameters table_factor:0.5:1.5",
        "measured curve press-back.csv, line 4: stroke_mm 1.5; at least 2.001 is needed, 0.001 above the line before (0 at the start): only the way down is compared, so leave out the rest",
    ),
    words(
        "measured curve beyond the stroke",
        ONE,
        "-identify press-deep.csv -parameters table_factor:0.5:1.5",
        "measured curve press-deep.csv, line 3: stroke_mm 30 is beyond -stroke 28.5; increase -stroke, or leave out the line",
    ),
    words(
        "measured curve without uncertainty",
        ONE,
        "-identify press-sure.csv -parameters table_factor:0.5:1.5",
        "measured curve press-sure.csv, line 2: uncertainty_N 0; it must be above 0: give the standard uncertainty of the force",
    ),
    words(
        "no more points than parameters",
        ONE,
        "-identify press.csv -parameters table_factor:0.5:1.5",
        "measured curve press.csv: points: 1; more than the number of parameters looked for, 1, are needed",
    ),
    words(
        "nothing to identify",
        BOTH,
        "-identify press.csv",
        "option -parameters: there is none; name what is looked for with its bounds, as in -parameters hollomon_k:300:900",
    ),
    words(
        "parameters without a search",
        ONE,
        "-parameters table_factor:0.5:1.5",
        "option -parameters: it has no effect without -identify or -design; add one of them, or leave it out",
    ),
    words(
        "two searches at once",
        ONE,
        "-identify press.csv -design 50 -parameters table_factor:0.5:1.5",
        "option -parameters: -identify and -design cannot be given together; make one after the other",
    ),
    words(
        "search that goes on",
        ONE,
        "-identify press.csv -parameters table_factor:0.5:1.5 -restart",
        "option -parameters: -restart goes on with a single run; leave it out, the search begins anew",
    ),
    words(
        "parameter without bounds",
        ONE,
        "-design 50 -parameters stroke",
        "option -parameters stroke: each parameter is written name:lower:upper, as in hollomon_k:300:900; specify options with their bounds: name:lower:upper with commas between and no spaces, or none (default none)",
    ),
    words(
        "parameter that is no number of the model",
        ONE,
        "-design 50 -parameters sheet_nx:20:40",
        "option -parameters sheet_nx:20:40: a name is none of the model's options with a real number; specify options with their bounds: name:lower:upper with commas between and no spaces, or none (default none)",
    ),
    words(
        "bound that is no number",
        ONE,
        "-design 50 -parameters stroke:20:deep",
        "option -parameters stroke:20:deep: a bound is not a finite number; specify options with their bounds: name:lower:upper with commas between and no spaces, or none (default none)",
    ),
    words(
        "bounds in the wrong order",
        ONE,
        "-design 50 -parameters stroke:28:20",
        "option -parameters stroke:28:20: a lower bound is not below its upper bound; specify options with their bounds: name:lower:upper with commas between and no spaces, or none (default none)",
    ),
    words(
        "parameter twice",
        ONE,
        "-design 50 -parameters stroke:20:28,stroke:20:28",
        "option -parameters stroke:20:28,stroke:20:28: a parameter is there twice; specify options with their bounds: name:lower:upper with commas between and no spaces, or none (default none)",
    ),
    words(
        "start outside the bounds",
        ONE,
        "-design 50 -parameters stroke:20:28",
        "option -parameters: the search starts from -stroke 28.5, which is not between its bounds 20 and 28; change one of the three",
    ),
    words(
        "bound without a case",
        ONE,
        "-design 50 -parameters stroke:20:40",
        "option -parameters: the bound 40 of stroke cannot be used: -stroke 40 mm squeezes the sheet on the bottom of the die, which is 29 mm below the die's flat (-die_radius + -die_shoulder_radius); use a stroke below 29 mm or a deeper die",
    ),
    words(
        "constant of a law that is not in use",
        ONE,
        "-identify press.csv -parameters hollomon_k:300:900",
        "option -parameters: hollomon_k has no effect with -hardening table; leave it out, or choose the law it belongs to",
    ),
    words(
        "the test itself as a parameter",
        ONE,
        "-identify press.csv -parameters stroke:20:28.5",
        "option -parameters: stroke is how the test was made, and cannot be identified from it; leave it out, and set -stroke",
    ),
    words(
        "design of three parameters",
        ONE,
        "-design 50 -parameters stroke:20:28.5,punch_radius:20:23.5,die_shoulder_radius:2:5",
        "option -parameters: -design takes one or two; leave the others at their values",
    ),
    words(
        "angle of no sheet",
        ONE,
        "-design 200 -parameters table_factor:0.5:1.5",
        "option -design 200: the value is out of range; specify a real number: 0 < value < 180, or none (default none)",
    ),
    words(
        "value that the optimiser does not know",
        BOTH,
        "-identify press-good.csv -parameters table_factor:0.5:1.5 -tao_gatol small",
        "PETSc error 63: Argument out of range: Input string small has no numeric value; if the value of an option -tao_... is to blame: -help lists what each can be",
    ),
    words(
        "misspelt option beside a search",
        ONE,
        "-design 50 -parameters table_factor:0.5:1.5 -design_tolerence 0.1",
        "option -design_tolerence is unknown: the nearest one is -design_tolerance (0 < value <= 10 deg; default 0.05 deg)",
    ),
];
