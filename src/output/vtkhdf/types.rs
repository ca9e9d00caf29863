//! What the files of a series are made of: cells, parts of the mesh, and arrays with their values.

use mpi::traits::Communicator;

use crate::ranks::gather_on_first;

/// VTK's numbers for the cell types used here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum CellType {
    /// One point.
    Vertex = 1,
    /// A line through any number of points.
    PolyLine = 4,
    /// Eight nodes: corners counter-clockwise, then mid-sides starting between the first two corners.
    QuadraticQuad = 23,
}

/// One rank's part of the mesh: points in mm, and cells that name them by their local index.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Points, mm.
    pub points: Vec<[f64; 3]>,
    /// The type of all cells.
    pub cell_type: CellType,
    /// The points of all cells, one cell after the other.
    pub connectivity: Vec<i64>,
    /// Where each cell starts in `connectivity`, and the end: one entry more than there are cells, starting with 0.
    pub offsets: Vec<i64>,
}

impl Part {
    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    pub(super) fn check(&self) -> Result<(), String> {
        if self.offsets.first() != Some(&0)
            || self.offsets.last() != Some(&(self.connectivity.len() as i64))
        {
            return Err("the cell offsets do not span the connectivity".into());
        }
        match self
            .connectivity
            .iter()
            .find(|&&node| node < 0 || node as usize >= self.points.len())
        {
            Some(node) => Err(format!(
                "a cell names point {node} of {}",
                self.points.len()
            )),
            None => Ok(()),
        }
    }
}

/// What kind of numbers an array holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Double precision.
    F64,
    /// 32-bit integers.
    I32,
}

/// Name and shape of an array; the same on all ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ArraySpec {
    /// The name shown to the user.
    pub name: &'static str,
    /// Its unit, stored as an attribute; "1" if it has none.
    pub unit: &'static str,
    /// Values per point or cell.
    pub components: usize,
    /// Kind of numbers.
    pub kind: Kind,
}

impl ArraySpec {
    /// Bytes of one point or cell.
    pub(super) fn bytes(&self) -> usize {
        self.components
            * match self.kind {
                Kind::F64 => size_of::<f64>(),
                Kind::I32 => size_of::<i32>(),
            }
    }
}

/// The values of an array on this rank: all components of the first point (or cell), then those of the second, ...
#[derive(Debug, Clone, Copy)]
pub(super) enum Values<'a> {
    /// Double precision.
    F64(&'a [f64]),
    /// 32-bit integers.
    I32(&'a [i32]),
}

/// The values of an array, owned.
#[derive(Debug, Clone)]
pub(super) enum Column {
    /// Double precision.
    F64(Vec<f64>),
    /// 32-bit integers.
    I32(Vec<i32>),
}

impl Column {
    pub(super) fn values(&self) -> Values<'_> {
        match self {
            Self::F64(values) => Values::F64(values),
            Self::I32(values) => Values::I32(values),
        }
    }
}

impl Values<'_> {
    /// Those of all ranks on rank 0, in the order of the ranks. Collective.
    pub(super) fn gather(&self, comm: &impl Communicator) -> Option<Column> {
        match self {
            Self::F64(values) => gather_on_first(comm, values).map(Column::F64),
            Self::I32(values) => gather_on_first(comm, values).map(Column::I32),
        }
    }

    pub(super) fn check(&self, spec: &ArraySpec, rows: usize) -> Result<(), String> {
        let (kind, length) = match self {
            Self::F64(values) => (Kind::F64, values.len()),
            Self::I32(values) => (Kind::I32, values.len()),
        };
        if kind != spec.kind || length != rows * spec.components {
            let ArraySpec {
                name,
                components,
                kind: expected,
                ..
            } = spec;
            return Err(format!(
                "array {name} got {length} values of kind {kind:?}, expected {rows} x {components} of kind {expected:?}"
            ));
        }
        Ok(())
    }
}
