//! In: a deformation gradient and the state of a point. Out: Kirchhoff stress, consistent tangent,
//! stored energy and the new state.
//! Never: meshes, unknowns, PETSc or MPI; of files only the hardening table is read.

pub mod hardening;
mod principal;
mod von_mises;

pub use hardening::Hardening;
pub use von_mises::{
    DeformationError, Linearised, MaterialSlope, PointState, Response, ResponseSlope, VonMises,
};
