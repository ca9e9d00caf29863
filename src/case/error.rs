//! What can be wrong with a case, each as one sentence: what, where, what is allowed, what to do.

use std::fmt;

use crate::material::hardening::{HardeningError, ImpossibleLaw};
use crate::text::show_real;

/// Why a case is refused. The text is one sentence for the person who wrote the options.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// Whoever knows the options cannot be asked.
    #[error("option -{option} cannot be read: {reason}")]
    Unreadable {
        /// Name without the dash.
        option: String,
        /// What the source says.
        reason: String,
    },
    /// An option that needs a value was given without one.
    #[error("option -{option} has no value: specify {wanted} (default {default})")]
    NoValue {
        /// Name without the dash.
        option: &'static str,
        /// Kind, unit and range in words.
        wanted: String,
        /// Default with its unit.
        default: String,
    },
    /// The text of an option is not of its kind, or outside its range.
    #[error("option -{option} {given}: {problem}; specify {wanted} (default {default})")]
    BadValue {
        /// Name without the dash.
        option: &'static str,
        /// The text that was given.
        given: String,
        /// What is wrong with it.
        problem: &'static str,
        /// Kind, unit and range in words.
        wanted: String,
        /// Default with its unit.
        default: String,
    },
    /// An option nobody reads and that is not PETSc's.
    #[error("option -{given} is unknown: the nearest one is {nearest}{hint}")]
    UnknownOption {
        /// The name as given, without the dash.
        given: String,
        /// The nearest option of ours with unit, range and default.
        nearest: String,
        /// A further advice, or nothing.
        hint: &'static str,
    },
    /// One of our options written with two dashes, which PETSc takes for another option.
    #[error("option --{option} is written with one dash: -{option} value")]
    TwoDashes {
        /// Name without dashes.
        option: String,
    },
    /// A word of the command line that is neither an option nor the value of one.
    #[error(
        "argument '{argument}' is neither an option nor the value of one: options are written -name value, see -help"
    )]
    StrayArgument {
        /// The word.
        argument: String,
    },
    /// A word of the command line that is not UTF-8 text.
    #[error(
        "argument '{argument}' is not UTF-8 text: write it in UTF-8, and name files and folders in UTF-8"
    )]
    ArgumentNotText {
        /// The word, as far as it can be read.
        argument: String,
    },
    /// The environment variable with options is refused.
    #[error("environment variable PETSC_OPTIONS: {0}")]
    Environment(Box<CaseError>),
    /// A quoted value without an end.
    #[error("{problem}; a value with spaces stands between double quotes")]
    OpenQuote {
        /// What is wrong.
        problem: String,
    },
    /// `-options_file` without a path.
    #[error(
        "option -options_file has no value: specify the path of an option file, for example inputs/ssnp155.opts"
    )]
    OptionsFileWithoutPath,
    /// `-options_file` with a path that cannot be read.
    #[error(
        "option -options_file {path}: the file cannot be read ({reason}); specify the path of a text file with an option on \
         each line, for example inputs/ssnp155.opts"
    )]
    OptionsFileUnreadable {
        /// The path as given.
        path: String,
        /// The operating system's reason.
        reason: String,
    },
    /// `--options_file`, which PETSc does not take for `-options_file`.
    #[error("option --options_file is written with one dash: -options_file path")]
    OptionsFileTwoDashes,
    /// A line of an option file that PETSc would stop on.
    #[error("option file {path}, line {line}: {problem}")]
    OptionsFileLine {
        /// The path as given.
        path: String,
        /// Line from 1.
        line: usize,
        /// What is wrong, and what is expected.
        problem: String,
    },
    /// The hardening table is refused; what it says names the file and the line.
    #[error("option -hardening_file: {0}")]
    Hardening(#[from] HardeningError),
    /// The constants of a hardening law make no law together.
    #[error("option -hardening {}: {}", .0.law, .0.problem)]
    ImpossibleLaw(#[from] ImpossibleLaw),
    /// An option of another hardening law than the one in use.
    #[error(
        "option -{option} {given} has no effect with -hardening {law}: it belongs to -hardening {owner}; leave it out, or \
         choose the other law"
    )]
    OtherLaw {
        /// Name without the dash.
        option: &'static str,
        /// The value that was given.
        given: String,
        /// Names of the laws it belongs to.
        owner: String,
        /// Name of the law in use.
        law: &'static str,
    },
    /// The outline of a tool is refused.
    #[error("option -{option} {path}{}: {problem}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
    ToolFile {
        /// Name without the dash.
        option: &'static str,
        /// The path as given.
        path: String,
        /// Line of the file from 1, if one is to blame.
        line: Option<u64>,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// Tools from files that cannot work with each other or with the sheet.
    #[error("the tools do not work together: {0}")]
    Tools(String),
    /// A size of the benchmark's tools where a file has taken their place.
    #[error(
        "option -{option} {given} has no effect: -{owner} {path} takes its place; leave one of the two out"
    )]
    ToolReplaced {
        /// Name without the dash.
        option: &'static str,
        /// The value that was given.
        given: String,
        /// The option with the file.
        owner: &'static str,
        /// The file.
        path: String,
    },
    /// A parameter by which this case has no derivative.
    #[error("option -sensitivity {name}: {reason}")]
    NoDerivative {
        /// Name of the parameter.
        name: &'static str,
        /// Why, and what to do.
        reason: String,
    },
    /// The punch passes between two contact points. Lengths in mm.
    #[error(
        "the mesh cannot feel the punch: -punch_radius {} mm is smaller than the distance between contact points, \
         {spacing:.3} mm; use a larger radius, or more elements with -sheet_nx",
        show_real(*punch_radius)
    )]
    PunchUnseen {
        /// Radius of the punch.
        punch_radius: f64,
        /// Distance between neighbouring contact points.
        spacing: f64,
    },
    /// The sheet does not fit between the vertical side of the punch and the die. Lengths in mm.
    #[error(
        "the sheet does not fit between punch and die: -die_radius {die_radius} mm less -punch_radius {punch_radius} mm \
         leaves {clearance} mm and -sheet_thickness is {thickness} mm; make the clearance greater than the thickness"
    )]
    NoClearance {
        /// Radius of the cavity.
        die_radius: f64,
        /// Radius of the punch.
        punch_radius: f64,
        /// What the radii leave.
        clearance: f64,
        /// Thickness of the sheet.
        thickness: f64,
    },
    /// The punch would squeeze the sheet on the bottom of the cavity. Lengths in mm.
    #[error(
        "-stroke {stroke} mm squeezes the sheet on the bottom of the die, which is {depth} mm below the die's flat \
         (-die_radius + -die_shoulder_radius); use a stroke below {depth} mm or a deeper die"
    )]
    StrokeTooDeep {
        /// Stroke of the punch.
        stroke: f64,
        /// Depth of the cavity.
        depth: f64,
    },
    /// The sheet does not reach the flat of the die. Lengths in mm.
    #[error(
        "the sheet does not rest on the die: half of -sheet_length is {half_length} mm and the die's flat begins at \
         {die_edge} mm (-die_radius + -die_shoulder_radius); use a -sheet_length above {least_length} mm, which leaves \
         a thickness to spare at each end"
    )]
    SheetTooShort {
        /// Half length of the sheet.
        half_length: f64,
        /// Where the flat begins.
        die_edge: f64,
        /// Least whole length.
        least_length: f64,
    },
    /// The end of the sheet would be drawn over the shoulder. Lengths in mm.
    #[error(
        "the sheet slips off the die's shoulder: at -stroke {stroke} mm the path round the punch to the shoulder is \
         {path:.3} mm and half of -sheet_length is {half_length} mm; use a -sheet_length above {least_length:.3} mm \
         or a shorter stroke"
    )]
    SheetSlipsOff {
        /// Stroke of the punch.
        stroke: f64,
        /// Path from the middle of the sheet round the punch to the shoulder.
        path: f64,
        /// Half length of the sheet.
        half_length: f64,
        /// Least whole length.
        least_length: f64,
    },
    /// The bounds of the time step do not enclose the first step. Times in ms.
    #[error(
        "the time steps contradict each other: -dt_min {dt_min} ms <= -dt_initial {dt_initial} ms <= -dt_max {dt_max} ms \
         does not hold; change one of the three"
    )]
    StepOrder {
        /// Least step.
        dt_min: f64,
        /// First step.
        dt_initial: f64,
        /// Greatest step.
        dt_max: f64,
    },
    /// More MPI ranks than elements.
    #[error(
        "too many MPI ranks: {ranks}, and the mesh has -sheet_nx {nx} times -sheet_ny {ny} elements; every rank needs \
         one: use mpirun -n {elements} or less, or refine the mesh"
    )]
    TooManyRanks {
        /// Ranks of the run.
        ranks: usize,
        /// Elements of the sheet.
        elements: usize,
        /// Elements along the half length.
        nx: usize,
        /// Elements through the thickness.
        ny: usize,
    },
    /// What is looked for does not fit the case.
    #[error("option -{option}: {problem}")]
    Inverse {
        /// Name without the dash.
        option: &'static str,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A measured curve is refused.
    #[error("measured curve {path}{}: {problem}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Measured {
        /// The path as given.
        path: String,
        /// Line of the file from 1, if one is to blame.
        line: Option<u64>,
        /// What is wrong, and what is expected.
        problem: String,
    },
    /// An option of PETSc's that the program has to decide itself.
    #[error(
        "option {}: {reason}{}; leave it out, and {instead}", format!("-{option} {given}").trim_end(),
        allowed.map_or_else(String::new, |allowed| format!(", so only {allowed} works here"))
    )]
    Reserved {
        /// Name without the dash.
        option: String,
        /// The value that was given.
        given: String,
        /// Why the program decides.
        reason: &'static str,
        /// The one value that can be given, if there is one.
        allowed: Option<&'static str>,
        /// What else to do.
        instead: &'static str,
    },
    /// The table of reference values is malformed.
    #[error("reference values, line {line}: {problem}")]
    ReferenceValues {
        /// Line of the file, from 1.
        line: u64,
        /// What is wrong, and what is expected.
        problem: String,
    },
}

/// Something the person should know that does not stop the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name of the option without the dash.
    pub option: String,
    /// Its value, if it has one.
    pub value: Option<String>,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "option -{}", self.option)?;
        if let Some(value) = &self.value {
            write!(f, " {value}")?;
        }
        f.write_str(" has no effect: PETSc did not read it; check its spelling and whether the chosen solver has it")
    }
}
