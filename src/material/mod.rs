//! In: a deformation gradient and the state of a point. Out: Kirchhoff stress, consistent tangent,
//! stored energy and the new state.
//! Never: elements, files, PETSc or MPI.

mod hardening;
mod von_mises;

pub use hardening::{Hardening, HardeningError, PlasticStep};
pub use von_mises::{PointState, Response, TurnedOver, VonMises};
