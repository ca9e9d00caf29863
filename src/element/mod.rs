//! In: nodal coordinates, displacements and point states of one element. Out: its internal force,
//! tangent, mass, energies and new states.
//! Never: other elements, contact, files, PETSc or MPI.

mod quad8;
mod quadrature;
mod shape;

pub use quad8::{
    ElementForce, EvaluatedPoint, GaussPointFailure, NodeBlock, PointMotion, Quad8, Quad8Slope,
};
pub use quadrature::{Quadrature, gauss_points};
pub use shape::{
    EDGE_SHAPE_CURVATURES, NODES, edge_shape, edge_shape_slopes, shape, shape_gradients,
};
