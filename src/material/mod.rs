//! In: strains and the state of one material point.
//! Out: stresses, tangents and the new state.
//! Never: meshes, unknowns, PETSc or MPI.

pub mod hardening;
mod hardening_table;
