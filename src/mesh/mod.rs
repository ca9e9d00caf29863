//! In: the sheet's dimensions and divisions. Out: nodes, QUAD8 connectivity, surface edges and
//! the rank of every element. Never: displacements, forces, PETSc or MPI.

mod partition;
mod sheet;

pub use partition::{Partition, PartitionError, partition};
pub use sheet::{SheetMesh, SurfaceEdge, SurfaceSide};
