//! The three field files: sheet, tools and contact points, each a series over the accepted steps.
//!
//! Coordinates are those of the undeformed half model, x across and y up, in mm; show the deformed state with
//! ParaView's "Warp By Vector" on `displacement`. All functions are collective over the communicator of the file.
//!
//! `contact_status` is 0 open, 1 stick, 2 slip forward, 3 slip backward ([`ContactState`]), and -1 at nodes that no tool
//! can touch. Forward is along the tool's outline: outwards on the die, inwards on the punch.

use std::path::Path;

use mpi::traits::Communicator;

use super::series::TimeSeries;
use super::types::{ArraySpec, CellType, Kind, Part, Values};
use crate::contact::ContactState;
use crate::output::OutputError;
use crate::system::{ContactPointSample, NodeSample};

const fn real(name: &'static str, unit: &'static str, components: usize) -> ArraySpec {
    ArraySpec {
        name,
        unit,
        components,
        kind: Kind::F64,
    }
}

const fn integer(name: &'static str) -> ArraySpec {
    ArraySpec {
        name,
        unit: "1",
        components: 1,
        kind: Kind::I32,
    }
}

const DISPLACEMENT: ArraySpec = real("displacement", "mm", 3);
const CONTACT_PRESSURE: ArraySpec = real("contact_pressure", "MPa", 1);
const GAP: ArraySpec = real("gap", "mm", 1);
const CONTACT_STATUS: ArraySpec = integer("contact_status");
/// `contact_status` of a node that no tool can touch.
const CANNOT_TOUCH: i32 = -1;

/// Point arrays of `fields.vtkhdf`, in this order. `stress` has VTK's six components of a symmetric tensor, which
/// ParaView shows as XX, YY, ZZ, XY, YZ, XZ; the last two are 0 in plane strain.
const SHEET_ARRAYS: [ArraySpec; 7] = [
    DISPLACEMENT,
    real("stress", "MPa", 6),
    real("von_mises_stress", "MPa", 1),
    real("equivalent_plastic_strain", "1", 1),
    CONTACT_PRESSURE,
    GAP,
    CONTACT_STATUS,
];

/// Point arrays of `tools.vtkhdf`.
const TOOL_ARRAYS: [ArraySpec; 1] = [DISPLACEMENT];

/// Point arrays of `contact.vtkhdf`, in this order.
const CONTACT_ARRAYS: [ArraySpec; 5] = [
    DISPLACEMENT,
    CONTACT_PRESSURE,
    real("friction_traction", "MPa", 1),
    GAP,
    CONTACT_STATUS,
];

/// One rank's part of the sheet mesh. Nodes shared by two parts appear in both.
#[derive(Debug, Clone, Default)]
pub struct SheetPart {
    /// Reference coordinates [x, y] of the local nodes, mm.
    pub coordinates: Vec<[f64; 2]>,
    /// Local node numbers of the 8-node quadrilaterals: corners counter-clockwise, then the mid-sides starting with
    /// that between the first two corners.
    pub quads: Vec<[usize; 8]>,
    /// The rank that owns these elements.
    pub rank: i32,
}

/// `fields.vtkhdf`: the sheet. Closed when dropped, which must happen on all ranks before MPI is finalised.
pub struct SheetFile {
    series: TimeSeries,
}

impl SheetFile {
    /// Starts the file with the mesh and the owning ranks of the cells.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if the file cannot be written, the same on every rank.
    pub fn create(
        path: impl AsRef<Path>,
        comm: &impl Communicator,
        sheet: &SheetPart,
    ) -> Result<Self, OutputError> {
        let part = Part {
            points: in_space(&sheet.coordinates),
            cell_type: CellType::QuadraticQuad,
            connectivity: sheet
                .quads
                .iter()
                .flatten()
                .map(|&node| node as i64)
                .collect(),
            offsets: (0..=sheet.quads.len() as i64)
                .map(|cell| 8 * cell)
                .collect(),
        };
        let rank = vec![sheet.rank; sheet.quads.len()];
        let series = TimeSeries::create(
            path,
            comm,
            &part,
            &SHEET_ARRAYS,
            &[(integer("rank"), Values::I32(&rank))],
        )?;
        Ok(Self { series })
    }

    /// Begins with the steps of an earlier file, in which row `rows[i]` of every step is node i of this rank's part.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the file is another one, [`OutputError::Hdf5`] if its steps cannot be written.
    pub fn replay(&mut self, from: &Path, rows: &[usize]) -> Result<(), OutputError> {
        self.series.replay(from, rows)
    }

    /// Adds the state at `t_ms`, one sample for each local node in the order of [`SheetPart::coordinates`].
    ///
    /// # Errors
    /// [`OutputError::Mismatch`] if the values do not fit, [`OutputError::Hdf5`] if they cannot be written.
    pub fn write(&mut self, t_ms: f64, samples: &[NodeSample]) -> Result<(), OutputError> {
        let displacement = gather(samples, |s| [s.displacement[0], s.displacement[1], 0.0]);
        let stress = gather(samples, |s| {
            let [xx, yy, zz, xy] = s.stress;
            [xx, yy, zz, xy, 0.0, 0.0]
        });
        self.series.append(
            t_ms,
            &[
                Values::F64(&displacement),
                Values::F64(&stress),
                Values::F64(&gather(samples, |s| [s.von_mises_stress])),
                Values::F64(&gather(samples, |s| [s.equivalent_plastic_strain])),
                Values::F64(&gather(samples, |s| [s.contact_pressure])),
                Values::F64(&gather(samples, |s| [s.gap])),
                Values::I32(&gather(samples, |s| [status(s.contact_state)])),
            ],
        )
    }
}

/// `tools.vtkhdf`: the outlines of die and punch, one polyline each; cell array `tool` is 0 for the die and 1 for the
/// punch. Closed when dropped, which must happen on all ranks before MPI is finalised.
pub struct ToolsFile {
    series: TimeSeries,
    die_points: usize,
    punch_points: usize,
}

impl ToolsFile {
    /// Starts the file. The outlines ([x, y] in mm, punch in its initial position) of rank 0 are used, those of the
    /// other ranks ignored.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if the file cannot be written, the same on every rank.
    pub fn create(
        path: impl AsRef<Path>,
        comm: &impl Communicator,
        die: &[[f64; 2]],
        punch: &[[f64; 2]],
    ) -> Result<Self, OutputError> {
        let writes = comm.rank() == 0;
        let (die, punch) = if writes {
            (die, punch)
        } else {
            (&[][..], &[][..])
        };
        let points: Vec<[f64; 2]> = die.iter().chain(punch).copied().collect();
        let ends = [0, die.len() as i64, points.len() as i64];
        let part = Part {
            connectivity: (0..points.len() as i64).collect(),
            points: in_space(&points),
            cell_type: CellType::PolyLine,
            offsets: if writes { ends.to_vec() } else { vec![0] },
        };
        let tool: &[i32] = if writes { &[0, 1] } else { &[] };
        let series = TimeSeries::create(
            path,
            comm,
            &part,
            &TOOL_ARRAYS,
            &[(integer("tool"), Values::I32(tool))],
        )?;
        Ok(Self {
            series,
            die_points: die.len(),
            punch_points: punch.len(),
        })
    }

    /// Begins with the steps of an earlier file of the same tools.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the file is another one, [`OutputError::Hdf5`] if its steps cannot be written.
    pub fn replay(&mut self, from: &Path) -> Result<(), OutputError> {
        let rows: Vec<usize> = (0..self.die_points + self.punch_points).collect();
        self.series.replay(from, &rows)
    }

    /// Adds the state at `t_ms` with the punch moved down by `stroke_mm`.
    ///
    /// # Errors
    /// [`OutputError::Mismatch`] if the values do not fit, [`OutputError::Hdf5`] if they cannot be written.
    pub fn write(&mut self, t_ms: f64, stroke_mm: f64) -> Result<(), OutputError> {
        let mut displacement = vec![0.0; 3 * self.die_points];
        displacement.extend([0.0, -stroke_mm, 0.0].repeat(self.punch_points));
        self.series.append(t_ms, &[Values::F64(&displacement)])
    }
}

/// `contact.vtkhdf`: the points where contact is checked. Closed when dropped, which must happen on all ranks before
/// MPI is finalised.
pub struct ContactFile {
    series: TimeSeries,
}

impl ContactFile {
    /// Starts the file with the reference positions [x, y] of this rank's contact points, mm.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if the file cannot be written, the same on every rank.
    pub fn create(
        path: impl AsRef<Path>,
        comm: &impl Communicator,
        points: &[[f64; 2]],
    ) -> Result<Self, OutputError> {
        let count = points.len() as i64;
        let part = Part {
            points: in_space(points),
            cell_type: CellType::Vertex,
            connectivity: (0..count).collect(),
            offsets: (0..=count).collect(),
        };
        Ok(Self {
            series: TimeSeries::create(path, comm, &part, &CONTACT_ARRAYS, &[])?,
        })
    }

    /// Begins with the steps of an earlier file, in which row `rows[i]` of every step is point i of this rank.
    ///
    /// # Errors
    /// [`OutputError::Read`] if the file is another one, [`OutputError::Hdf5`] if its steps cannot be written.
    pub fn replay(&mut self, from: &Path, rows: &[usize]) -> Result<(), OutputError> {
        self.series.replay(from, rows)
    }

    /// Adds the state at `t_ms`, one sample for each of this rank's points.
    ///
    /// # Errors
    /// [`OutputError::Mismatch`] if the values do not fit, [`OutputError::Hdf5`] if they cannot be written.
    pub fn write(&mut self, t_ms: f64, samples: &[ContactPointSample]) -> Result<(), OutputError> {
        self.series.append(
            t_ms,
            &[
                Values::F64(&gather(samples, |s| {
                    [s.displacement[0], s.displacement[1], 0.0]
                })),
                Values::F64(&gather(samples, |s| [s.pressure])),
                Values::F64(&gather(samples, |s| [s.friction])),
                Values::F64(&gather(samples, |s| [s.gap])),
                Values::I32(&gather(samples, |s| [status(Some(s.state))])),
            ],
        )
    }
}

/// The number by which the files know a state of contact, also that of a node which no tool can touch.
fn status(state: Option<ContactState>) -> i32 {
    state.map_or(CANNOT_TOUCH, ContactState::code)
}

fn in_space(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    points.iter().map(|&[x, y]| [x, y, 0.0]).collect()
}

fn gather<S, T, const N: usize>(samples: &[S], values: impl Fn(&S) -> [T; N]) -> Vec<T> {
    samples.iter().flat_map(values).collect()
}
