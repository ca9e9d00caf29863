//! `sensitivity.csv`: what the state of each accepted step is, and its derivatives by the parameters of `-sensitivity`.

// As in `record.rs`: the field names are the column names.
#![allow(non_snake_case)]

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::OutputError;
use crate::case::Parameter;
use crate::sensitivity::Slopes;

/// One accepted step: its state, and the derivatives by every parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DerivativeRow {
    /// The columns [`STATE`].
    pub t_ms: f64,
    /// Travel of the punch, mm.
    pub stroke_mm: f64,
    /// Force on the punch, N.
    pub force_N: f64,
    /// Opening angle, degrees.
    pub angle_deg: f64,
    /// Vertical displacement of the sheet's point A, mm.
    pub dy_A_sheet_mm: f64,
    /// Gauss points and contact points that did something else than in the step before.
    pub changed_points: u32,
    /// Gauss points that flow at the parameter a little above its value and not a little below, or the reverse:
    /// the most over the parameters.
    pub doubtful_points: u32,
    /// Derivatives in the order of the parameters.
    pub by_parameter: Vec<Slopes>,
}

/// All rows of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DerivativeTable {
    /// The parameters; none without `-sensitivity`.
    pub parameters: Vec<Parameter>,
    /// One row per accepted step; none without `-sensitivity`.
    pub rows: Vec<DerivativeRow>,
}

/// A number of a row that is no derivative.
pub struct StateColumn {
    /// Name of the column, which ends with the unit if there is one.
    pub name: &'static str,
    value: fn(&mut DerivativeRow) -> Cell<'_>,
}

/// Where a column's number is kept.
enum Cell<'a> {
    Real(&'a mut f64),
    Count(&'a mut u32),
}

/// A quantity with derivatives.
pub struct Quantity {
    /// Name with its unit.
    pub name: &'static str,
    /// Its derivative.
    pub slope: fn(&mut Slopes) -> &mut f64,
}

macro_rules! state {
    ($($name:ident: $kind:ident,)*) => {
        /// The columns that come first.
        pub static STATE: &[StateColumn] = &[$(StateColumn {
            name: stringify!($name),
            value: |row| Cell::$kind(&mut row.$name),
        },)*];
    };
}

state! {
    t_ms: Real,
    stroke_mm: Real,
    force_N: Real,
    angle_deg: Real,
    dy_A_sheet_mm: Real,
    changed_points: Count,
    doubtful_points: Count,
}

/// The quantities, in the order of the columns of each parameter.
pub static QUANTITIES: &[Quantity] = &[
    Quantity {
        name: "force_N",
        slope: |slopes| &mut slopes.force,
    },
    Quantity {
        name: "angle_deg",
        slope: |slopes| &mut slopes.angle,
    },
    Quantity {
        name: "dy_A_sheet_mm",
        slope: |slopes| &mut slopes.dy_a,
    },
];

impl Quantity {
    /// The name of the column of this quantity's derivative by a parameter, with both units.
    pub fn column(&self, parameter: &Parameter) -> String {
        let unit = parameter.unit.replace('/', "_per_");
        let name = format!("d_{}_by_{}_{unit}", self.name, parameter.name);
        name.trim_end_matches('_').to_owned()
    }
}

impl DerivativeTable {
    /// For these parameters, without rows.
    pub fn new(parameters: Vec<Parameter>) -> Self {
        Self {
            parameters,
            rows: Vec::new(),
        }
    }

    /// The names of all columns.
    pub fn header(&self) -> Vec<String> {
        let state = STATE.iter().map(|column| column.name.to_owned());
        let of = |parameter| QUANTITIES.iter().map(move |of| of.column(parameter));
        state.chain(self.parameters.iter().flat_map(of)).collect()
    }
}

impl DerivativeRow {
    fn numbers(&self) -> Vec<String> {
        let mut row = self.clone();
        let mut texts = Vec::new();
        for column in STATE {
            texts.push(match (column.value)(&mut row) {
                Cell::Real(value) => format!("{value:?}"),
                Cell::Count(value) => value.to_string(),
            });
        }
        for slopes in &mut row.by_parameter {
            let slope = |of: &Quantity| format!("{:?}", (of.slope)(slopes));
            texts.extend(QUANTITIES.iter().map(slope));
        }
        texts
    }

    /// A row from its numbers; none if they are too few or no numbers.
    fn of(record: &csv::StringRecord, parameters: usize) -> Option<Self> {
        let mut row = Self {
            by_parameter: vec![Slopes::default(); parameters],
            ..Self::default()
        };
        let mut texts = record.iter();
        for column in STATE {
            let text = texts.next()?;
            match (column.value)(&mut row) {
                Cell::Real(value) => *value = text.parse().ok()?,
                Cell::Count(value) => *value = text.parse().ok()?,
            }
        }
        for slopes in &mut row.by_parameter {
            for of in QUANTITIES {
                *(of.slope)(slopes) = texts.next()?.parse().ok()?;
            }
        }
        Some(row)
    }
}

/// Writer of the table, on rank 0; each row is on its path to the disk before [`DerivativeFile::append`] returns.
pub struct DerivativeFile {
    path: PathBuf,
    table: csv::Writer<File>,
}

impl DerivativeFile {
    /// Starts a table, or continues the one in the file `rows` of an earlier run, which is left alone.
    ///
    /// # Errors
    /// [`OutputError::Read`] or [`OutputError::Write`].
    pub fn create(
        path: PathBuf,
        header: &[String],
        rows: Option<&Path>,
    ) -> Result<Self, OutputError> {
        let failed = |error: csv::Error| OutputError::write(&path, error);
        let mut table = match rows {
            Some(rows) => {
                let bytes = fs::read(rows).map_err(|error| OutputError::read(rows, error))?;
                super::atomic::write(&path, &bytes)?;
                let file = File::options().append(true).open(&path);
                csv::Writer::from_writer(file.map_err(|error| OutputError::write(&path, error))?)
            }
            None => {
                let mut table = csv::Writer::from_path(&path).map_err(failed)?;
                table.write_record(header).map_err(failed)?;
                table
            }
        };
        table
            .flush()
            .map_err(|error| OutputError::write(&path, error))?;
        Ok(Self { path, table })
    }

    /// Adds one row and hands it to the operating system.
    ///
    /// # Errors
    /// [`OutputError::Write`], for example when the disk is full.
    pub fn append(&mut self, row: &DerivativeRow) -> Result<(), OutputError> {
        let written = self.table.write_record(row.numbers());
        written.map_err(|error| OutputError::write(&self.path, error))?;
        let flushed = self.table.flush();
        flushed.map_err(|error| OutputError::write(&self.path, error))
    }
}

/// Reads the rows of a table with this number of parameters back.
///
/// # Errors
/// [`OutputError::Read`] where it is none.
pub fn read(path: &Path, parameters: usize) -> Result<Vec<DerivativeRow>, OutputError> {
    let failed = |error: csv::Error| OutputError::read(path, error);
    let mut table = csv::Reader::from_path(path).map_err(failed)?;
    let rows = table.records().map(|record| {
        DerivativeRow::of(&record.map_err(failed)?, parameters)
            .ok_or_else(|| OutputError::read(path, "a row is incomplete or has no numbers"))
    });
    rows.collect()
}
