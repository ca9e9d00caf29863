//! In: the nodes of one surface edge, one contact point on it, a tool, a multiplier and a gap.
//! Out: the point's share of the equilibrium, closure and complementarity equations with tangents.
//! Never: other points, the tools' motion in time, PETSc or MPI.

mod closest;
mod friction;
mod law;
mod rule;
mod state;

pub use closest::Drift;
pub use friction::{Friction, FrictionState, Traction};
pub use law::{
    ContactAt, ContactLaw, ContactLawSlope, ContactMotion, ContactRows, ContactSlope,
    ContactTangent, PointPosition,
};
pub use rule::{ContactLocation, ContactRule, ContactSample};
pub use state::ContactState;
