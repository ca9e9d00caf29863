//! Time series on a mesh that does not change, in VTK's own HDF5 layout (VTKHDF 2.0, `UnstructuredGrid`).
//!
//! In: states of nodes and contact points. Out: `fields.vtkhdf`, `tools.vtkhdf` and `contact.vtkhdf`. Never: mechanics.
//!
//! Written by rank 0, one partition per rank; ParaView (5.12 or newer) and VTK's `vtkHDFReader` open it. The mesh and the cell arrays are stored once and every step points at them; only the
//! point arrays grow.
//!
//! What holds when a run is killed: a step is written in two flushes, first its data, then the number of steps, so
//! the file on disk between two steps is complete and consistent, and a kill there loses nothing. HDF5 keeps no
//! journal: a kill inside a flush (milliseconds per step) can in unlucky cases leave the file unreadable. The history
//! table does not depend on it. That is about the process: a machine that loses its power loses what the system has not
//! brought to the disk yet, and has the last checkpoint, which is there for certain.

mod datasets;
mod earlier;
mod fields;
mod file;
mod mesh;
mod series;
mod steps;
mod types;

pub use fields::{ContactFile, SheetFile, SheetPart, ToolsFile};
