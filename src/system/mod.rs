//! In: the problem (mesh, material, tools, motion) and this rank's unknowns. Out: residual, Jacobian
//! and what can be measured on a state; keeps the committed history of the material points.
//! Never: decides on steps, prints, or writes files.

mod census;
mod condensed;
mod distributed;
mod elimination;
mod evaluate;
mod local;
mod measure;
mod numbering;
mod pattern;
mod problem;
mod release;
mod sample;
mod seed;
mod share;
mod snapshot;
mod substructures;

pub use census::Share;
pub use condensed::CondensedSolve;
pub use distributed::{System, SystemError};
pub use evaluate::ElementFailure;
pub use local::LocalSystem;
pub use measure::{Measures, PartialMeasures};
pub use numbering::{Numbering, UNKNOWNS_PER_POINT};
pub use problem::{Factor, NodalValue, Problem, Tool};
pub use sample::{ContactPointSample, FieldSampler, NodeSample};
pub use seed::Seed;
pub use share::{ContactPlace, FailedElement};
pub use snapshot::Snapshot;
