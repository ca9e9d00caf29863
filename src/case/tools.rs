//! The tools of a case: the benchmark's with their radii, or outlines from files.

use super::error::CaseError;
use super::kind::{Kind, Path};
use super::model::{Case, Tools};
use super::option::{Opt, OptionSource};
use super::table;
use super::tool_file::ToolFile;
use crate::text::shortened;
use crate::tool::{Corner, Outline, OutlineError, Profile, ToolSide, die, punch};

/// The benchmark's tools, as files.
const BENCHMARK: [&str; 2] = [
    include_str!("../../inputs/tools/benchmark-die.csv"),
    include_str!("../../inputs/tools/benchmark-punch.csv"),
];

/// The tools the options describe.
pub(super) fn read(options: &dyn OptionSource) -> Result<Tools, CaseError> {
    let file = |option: &'static Opt<Path>, side| {
        let path = option.read(options)?;
        let given = path != table::BENCHMARK_TOOL;
        given
            .then(|| ToolFile::read(option.name, side, &path))
            .transpose()
    };
    let tools = Tools {
        punch_radius: table::PUNCH_RADIUS.read(options)?,
        die_radius: table::DIE_RADIUS.read(options)?,
        die_shoulder_radius: table::DIE_SHOULDER_RADIUS.read(options)?,
        punch_file: file(&table::PUNCH_PROFILE, ToolSide::Above)?,
        die_file: file(&table::DIE_PROFILE, ToolSide::Below)?,
    };
    for option in [
        &table::PUNCH_RADIUS,
        &table::DIE_RADIUS,
        &table::DIE_SHOULDER_RADIUS,
    ] {
        let Some((owner, path)) = tools.replaced_by(option.name) else {
            continue;
        };
        // An option file that names every option with its default is no mistake.
        let value = option.read(options)?;
        if option.kind.parse(option.default) != Ok(value) {
            return Err(CaseError::ToolReplaced {
                option: option.name,
                given: shortened(&option.kind.show(&value)),
                owner,
                path: shortened(path),
            });
        }
    }
    Ok(tools)
}

impl Tools {
    /// The option and the path of the file that takes the place of a size of the benchmark's tools, if one does.
    pub(super) fn replaced_by(&self, option: &str) -> Option<(&'static str, &str)> {
        let (owner, file) = if option == table::PUNCH_RADIUS.name {
            (table::PUNCH_PROFILE.name, &self.punch_file)
        } else if [table::DIE_RADIUS.name, table::DIE_SHOULDER_RADIUS.name].contains(&option) {
            (table::DIE_PROFILE.name, &self.die_file)
        } else {
            return None;
        };
        file.as_ref().map(|file| (owner, file.path.as_str()))
    }

    /// Whether a tool is from a file.
    pub fn from_file(&self) -> bool {
        self.punch_file.is_some() || self.die_file.is_some()
    }
}

impl Case {
    /// The die. Its highest point under the sheet is at y = 0.
    pub fn die(&self) -> Profile {
        let Tools {
            die_radius,
            die_shoulder_radius,
            die_file,
            ..
        } = &self.tools;
        let half_length = self.sheet.half_length();
        match die_file {
            Some(file) => file
                .outline
                .placed(0.0 - file.outline.first_touch(half_length).y),
            None => die(*die_radius, *die_shoulder_radius, half_length),
        }
    }

    /// The punch before its stroke. Its lowest point over the sheet is on the sheet.
    pub fn punch(&self) -> Profile {
        let Tools {
            punch_radius,
            punch_file,
            ..
        } = &self.tools;
        let thickness = self.sheet.thickness;
        match punch_file {
            Some(file) => file
                .outline
                .placed(thickness - file.outline.first_touch(self.sheet.half_length()).y),
            None => punch(*punch_radius, thickness, self.loading.stroke),
        }
    }

    /// Outlines of die and punch, at any height, whether they are from files or not.
    pub(super) fn outlines(&self) -> Result<[Outline; 2], OutlineError> {
        let corner = |x: f64, y: f64, radius: f64| Corner { x: [x, y], radius };
        let die = match &self.tools.die_file {
            Some(file) => file.outline.clone(),
            None => {
                let (edge, radius) = (self.tools.die_edge(), self.tools.die_radius);
                let end = edge.max(self.sheet.half_length()) + radius;
                let shoulder = self.tools.die_shoulder_radius;
                let corners = [
                    corner(0.0, -edge, 0.0),
                    corner(radius, -edge, radius),
                    corner(radius, 0.0, shoulder),
                    corner(end, 0.0, 0.0),
                ];
                Outline::new(ToolSide::Below, &corners)?
            }
        };
        let punch = match &self.tools.punch_file {
            Some(file) => file.outline.clone(),
            None => {
                let radius = self.tools.punch_radius;
                let top = radius + self.loading.stroke;
                let corners = [
                    corner(0.0, 0.0, 0.0),
                    corner(radius, 0.0, radius),
                    corner(radius, top, 0.0),
                ];
                Outline::new(ToolSide::Above, &corners)?
            }
        };
        Ok([die, punch])
    }

    /// Whether die and punch have the corners of the benchmark's, from files or not; of the radii nothing is said.
    pub(super) fn benchmark_files(&self) -> [bool; 2] {
        let Tools {
            die_file,
            punch_file,
            ..
        } = &self.tools;
        let same = |file: &Option<ToolFile>, text: &str| {
            file.as_ref().is_none_or(|file| file.is_written(text))
        };
        [same(die_file, BENCHMARK[0]), same(punch_file, BENCHMARK[1])]
    }

    /// What a checkpoint knows the outlines by, die and punch: their corners, nothing where the benchmark's are in use.
    pub fn tool_marks(&self) -> [String; 2] {
        let [die, punch] = self.benchmark_files();
        let mark = |file: &Option<ToolFile>, benchmark: bool| match file {
            Some(file) if !benchmark => format!("{:?}", file.outline.corners()),
            _ => String::new(),
        };
        [
            mark(&self.tools.die_file, die),
            mark(&self.tools.punch_file, punch),
        ]
    }
}
