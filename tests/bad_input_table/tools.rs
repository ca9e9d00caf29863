//! The bad inputs of tools from files: a part of the table.

use super::{BOTH, Mistake, ONE, words};

/// Outlines.
pub const FILES: &[(&str, &[u8])] = &[
    ("tool-die.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,25\n25,0,4\n85,0,0\n"),
    ("tool-punch.csv", b"x_mm,y_mm,radius_mm\n0,0,0\n23.5,0,23.5\n23.5,52,0\n"),
    ("tool-header.csv", b"0,-29,0\n25,-29,25\n"),
    ("tool-word.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,wide\n85,0,0\n"),
    ("tool-short.csv", b"x_mm,y_mm,radius_mm\n0,0,0\n23.5,0\n23.5,52,0\n"),
    ("tool-one.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n"),
    ("tool-axis.csv", b"x_mm,y_mm,radius_mm\n1,-29,0\n25,0,0\n"),
    ("tool-inwards.csv", b"x_mm,y_mm,radius_mm\n85,0,0\n25,0,4\n0,-29,0\n"),
    ("tool-left.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n-5,0,0\n85,0,0\n"),
    ("tool-twice.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,0\n25,-29,0\n25,0,4\n85,0,0\n"),
    ("tool-end.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,25\n25,0,4\n85,0,1\n"),
    ("tool-back.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,25\n25,0,4\n40,0,4\n35,-20,0\n"),
    ("tool-fold.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,0\n12,-29,0\n85,0,0\n"),
    ("tool-straight.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n12,-29,1\n25,-29,0\n25,0,4\n85,0,0\n"),
    ("tool-overlap.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,25\n25,0,4.5\n85,0,0\n"),
    ("tool-loop.csv", b"x_mm,y_mm,radius_mm\n# a die with its underside\n0,-29,0\n25,-29,0\n25,0,4\n40,0,4\n40,-20,0\n10,-20,0\n10,-60,0\n"),
    ("tool-sharp.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,0\n25,0,0\n85,0,0\n"),
    ("tool-fine.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n25,-29,0\n25,0,0.02\n85,0,0\n"),
    ("tool-bump.csv", b"x_mm,y_mm,radius_mm\n0,0,0\n10,0,6\n10,-29,0\n85,-29,0\n"),
    ("tool-wide.csv", b"x_mm,y_mm,radius_mm\n0,-29,0\n52,-29,0\n56,0,4\n85,0,0\n"),
    ("tool-thick.csv", b"x_mm,y_mm,radius_mm\n0,0,0\n24.5,0,24.5\n24.5,52,0\n"),
];

/// Outlines that are none, and tools that cannot work.
pub const MISTAKES: &[Mistake] = &[
    words(
        "outline of a die that is not there",
        BOTH,
        "-die_profile nowhere.csv",
        "option -die_profile nowhere.csv: the file cannot be read (No such file or directory (os error 2)); specify the path of a CSV file with the header x_mm,y_mm,radius_mm",
    ),
    words(
        "outline that is a folder",
        ONE,
        "-punch_profile folder",
        "option -punch_profile folder: the file cannot be read (it is a folder); specify the path of a CSV file with the header x_mm,y_mm,radius_mm",
    ),
    words(
        "outline without a header",
        ONE,
        "-die_profile tool-header.csv",
        "option -die_profile tool-header.csv: the header is '0,-29,0' instead of x_mm,y_mm,radius_mm: the corners of the tool's right half from x = 0 outwards, and the radius each is rounded with",
    ),
    words(
        "outline with a word for a number",
        BOTH,
        "-die_profile tool-word.csv",
        "option -die_profile tool-word.csv, line 3: radius_mm 'wide' is not a number such as 23.5 with 0 <= number <= 100000",
    ),
    words(
        "outline with a number missing",
        ONE,
        "-punch_profile tool-short.csv",
        "option -punch_profile tool-short.csv, line 3: the line has another number of columns than the header; each needs a comma, and a sharp corner the radius 0",
    ),
    words(
        "outline of one corner",
        ONE,
        "-die_profile tool-one.csv",
        "option -die_profile tool-one.csv: corners: 1; 2 to 200 are needed",
    ),
    words(
        "outline that does not begin on the symmetry line",
        ONE,
        "-die_profile tool-axis.csv",
        "option -die_profile tool-axis.csv, line 2: the first corner is at x = 1 mm; the outline begins on the symmetry line x = 0",
    ),
    words(
        "outline written from outside inwards",
        ONE,
        "-die_profile tool-inwards.csv",
        "option -die_profile tool-inwards.csv, line 2: the outline ends on the symmetry line x = 0; write it the other way round, from there outwards",
    ),
    words(
        "outline with its left half",
        ONE,
        "-die_profile tool-left.csv",
        "option -die_profile tool-left.csv, line 3: x = -5 mm is left of the symmetry line; only the right half is written, x >= 0",
    ),
    words(
        "outline with a corner twice",
        ONE,
        "-die_profile tool-twice.csv",
        "option -die_profile tool-twice.csv, line 4: this corner is where the one before is; leave one of them out",
    ),
    words(
        "outline whose end is rounded",
        ONE,
        "-die_profile tool-end.csv",
        "option -die_profile tool-end.csv, line 5: the outline ends here and goes straight on, so there is nothing to round; the last radius is 0",
    ),
    words(
        "outline that ends towards the symmetry line",
        ONE,
        "-die_profile tool-back.csv",
        "option -die_profile tool-back.csv, line 6: the last line goes on beyond its end, and so back to the symmetry line; end with one that does not",
    ),
    words(
        "outline that goes back along itself",
        ONE,
        "-die_profile tool-fold.csv",
        "option -die_profile tool-fold.csv, line 3: the outline goes back along itself here; a tool has two sides, so leave room between them",
    ),
    words(
        "outline with a radius where it is straight",
        ONE,
        "-die_profile tool-straight.csv",
        "option -die_profile tool-straight.csv, line 3: the outline goes straight on here, so the radius 1 mm rounds nothing; make it 0",
    ),
    words(
        "outline with roundings that overlap",
        BOTH,
        "-die_profile tool-overlap.csv",
        "option -die_profile tool-overlap.csv, line 4: the line from the corner before is 29 mm long, and the roundings at its ends need 25 and 4.5 mm of it; use smaller radii, or move the corners apart",
    ),
    words(
        "outline with a loop",
        ONE,
        "-die_profile tool-loop.csv",
        "option -die_profile tool-loop.csv, line 8: on the way to this corner, in its rounding, or beyond the end the outline crosses an earlier part; a tool has one free side, so draw it without a loop (the earlier part is that of line 5)",
    ),
    words(
        "tool with a sharp edge",
        BOTH,
        "-die_profile tool-sharp.csv",
        "option -die_profile tool-sharp.csv, line 4: the corner sticks out and is sharp: between two contact points, which are 0.0588235 mm apart, it would get 0.0294118 mm into the sheet, and -penetration_limit is 0.005 mm; use a radius of 0.09 mm or more, or more elements with -sheet_nx",
    ),
    words(
        "tool with an edge that is too sharp for the contact points",
        ONE,
        "-die_profile tool-fine.csv",
        "option -die_profile tool-fine.csv, line 4: the radius 0.02 mm is too small: between two contact points, which are 0.0588235 mm apart, it would get 0.0211275 mm into the sheet, and -penetration_limit is 0.005 mm; use a radius of 0.09 mm or more, or more elements with -sheet_nx",
    ),
    words(
        "the same for moving contact points",
        ONE,
        "-die_profile tool-fine.csv -contact_location closest",
        "option -die_profile tool-fine.csv, line 4: the radius 0.02 mm is too small: moving contact points follow the tool's normal, and it turns here too sharply for edges of the sheet that are 0.352941 mm long; use a radius of 0.08 mm or more, or more elements with -sheet_nx",
    ),
    words(
        "die that is highest under the punch",
        ONE,
        "-die_profile tool-bump.csv",
        "the tools do not work together: the die holds the sheet at x = 0 mm and the punch pushes it at x = 0 mm, so it is squeezed and not bent; the die's highest point under the sheet has to be farther out than the punch's lowest",
    ),
    words(
        "die that is too wide for the sheet",
        ONE,
        "-die_profile tool-wide.csv",
        "the tools do not work together: half of -sheet_length is 60 mm and the die holds the sheet from x = 59.4861 mm on; use a -sheet_length above 120.972 mm, which leaves a thickness to spare at each end",
    ),
    words(
        "punch that is too wide for the die",
        BOTH,
        "-punch_profile tool-thick.csv",
        "the tools do not work together: at a stroke of 28.5 mm they are 0.5172 mm apart at (24.485, -3.849) mm and -sheet_thickness is 1 mm, so the sheet would be squeezed; use a shorter -stroke (now 28.5 mm), or tools with more room there",
    ),
    words(
        "stroke that squeezes the sheet between outlines",
        ONE,
        "-punch_profile tool-punch.csv -stroke 29",
        "the tools do not work together: at a stroke of 29 mm they are 1.0000 mm apart at (0.000, -28.000) mm and -sheet_thickness is 1 mm, so the sheet would be squeezed; use a shorter -stroke (now 29 mm), or tools with more room there",
    ),
    words(
        "radius of a punch from a file",
        ONE,
        "-punch_profile tool-punch.csv -punch_radius 20",
        "option -punch_radius 20 has no effect: -punch_profile tool-punch.csv takes its place; leave one of the two out",
    ),
    words(
        "derivative by the radius of a tool from a file",
        ONE,
        "-die_profile tool-die.csv -sensitivity die_shoulder_radius",
        "option -sensitivity die_shoulder_radius: -die_profile tool-die.csv takes the place of -die_shoulder_radius, and a tool from a file has no parameter; leave it out",
    ),
    words(
        "design by the radius of a tool from a file",
        ONE,
        "-punch_profile tool-punch.csv -design 50 -parameters punch_radius:20:24",
        "option -parameters: punch_radius has no effect: -punch_profile tool-punch.csv takes its place; leave one of the two out",
    ),
];
