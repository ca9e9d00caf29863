//! Sheet metal forming with contact: the NAFEMS contact benchmark 3 (code_aster test SSNP155).
//!
//! Units are mm, N, MPa, g and ms throughout. ARCHITECTURE.md says what lives where.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), deny(clippy::unwrap_used, clippy::expect_used))]

pub mod case;
pub mod contact;
pub mod element;
pub mod inverse;
pub mod material;
pub mod mesh;
pub mod output;
pub mod plane;
pub mod ranks;
pub mod run;
pub mod sensitivity;
pub mod system;
mod text;
pub mod tool;

pub use {mpi, petsc};
