//! A safe wrapper of the parts of PETSc (3.18 to 3.26) that a contact solver needs.
//!
//! In: communicators of rsmpi, plain slices, closures. Out: vectors, matrices, linear, nonlinear,
//! time-step and least-squares solvers whose failures are [`Error`]s in Rust. Never: `unsafe` for the user, printing,
//! or an opinion about mechanics.
//!
//! The PETSc is chosen when this crate is built: `PETSC_DIR` and `PETSC_ARCH`, or pkg-config, see the README.
//!
//! # Examples
//! Four complete programs, which take PETSc's options and run on any number of ranks:
//! `cargo run -p petsc --example obstacle` (bounds on the unknowns), `oscillator` (TSALPHA2), `shell_matrix`
//! (a matrix that is a closure) and `curve_fit` (least squares within bounds). The shortest one starts MPI and PETSc, and adds two vectors:
//!
//! ```
//! use mpi::Threading;
//!
//! let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
//!     panic!("MPI was started before");
//! };
//! let arguments: Vec<String> = std::env::args().take(1).collect();
//! let session = petsc::Session::new(&arguments)?;
//! let mut x = petsc::Vector::new(&universe.world(), 3)?;
//! let mut y = x.duplicate()?;
//! x.set_all(2.0)?;
//! y.write()?[0] = 1.0;
//! y.axpy(0.5, &x)?; // y = y + 0.5 x
//! assert_eq!(y.read()?[..], [2.0, 1.0, 1.0]);
//! drop((x, y, session)); // before MPI ends
//! # Ok::<(), petsc::Error>(())
//! ```
//!
//! # Owned and borrowed objects
//! [`Vector`], [`Matrix`], [`Ksp`], [`Snes`], [`Ts`] and [`Tao`] own a PETSc object and dereference to
//! [`VectorRef`], [`MatrixRef`], [`KspRef`], [`SnesRef`], [`TsRef`] and [`TaoRef`], which is also what callbacks
//! are given. Every owned object keeps the [`Session`] alive, so the order of drops does not matter
//! as long as all of them happen before MPI ends.
//!
//! # Callbacks
//! Closures are `Fn + 'static` and belong to the PETSc object they are set on; share state with them
//! through `Rc<RefCell<_>>`. Do not let a closure own (an `Rc` of) the object it is set on: that is
//! a cycle, and neither would ever be freed.
//!
//! A closure's `Err` and its panic travel through PETSc and come out as the `Err` of the outermost
//! call ([`Error::Callback`], [`Error::Panic`]). After each closure the ranks of the object's
//! communicator agree on the outcome, so one failing rank makes every rank return (the others with
//! [`Error::Elsewhere`]). A closure that communicates must therefore reach its last collective call
//! on every rank even if it has already failed on one.

#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]
#![deny(clippy::unwrap_used, clippy::expect_used)]

mod agree;
mod block;
mod callback;
mod error;
mod factorization;
mod guard;
mod handle;
mod kept;
mod ksp;
mod matrix;
mod placeholder;
mod reason;
mod scatter;
mod session;
mod shell;
mod shell_matrix;
mod snes;
mod tao;
mod ts;
mod vector;

pub mod log;
pub mod options;

pub use block::{Block, BlockRef};
pub use error::{CallbackError, Error, Evaluation, Failure, Result};
pub use factorization::{FactorKind, FactorStatus, Factorization};
pub use guard::{ReadGuard, WriteGuard};
pub use ksp::{Ksp, KspRef};
pub use matrix::{Matrix, MatrixOption, MatrixRef};
pub use reason::{KspReason, SnesReason, TaoReason, TsReason};
pub use scatter::Scatter;
pub use session::{BUILT_WITH, Session, has_external_package};
pub use snes::{ConvergenceCheck, LineSearchInfo, Snes, SnesRef};
pub use tao::{Tao, TaoRef};
pub use ts::{Alpha2State, AlphaParameters, ExactFinalTime, Ts, TsRef};
pub use vector::{Vector, VectorRef};

/// The value that stands for "no bound" in bounds of variables (PETSc's `PETSC_INFINITY`).
pub const INFINITY: f64 = f64::MAX / 4.0;
