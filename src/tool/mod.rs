//! In: the radii of punch and die, or the corners of an outline, and a point. Out: signed distance to the tool with its first and
//! second derivatives, arc length along it, and the tool's motion in time.
//! Never: the sheet, the contact forces, PETSc or MPI.

mod benchmark;
mod corners;
mod crossing;
mod distance;
mod foot;
mod motion;
mod outline;
mod piece;
mod profile;

pub use benchmark::{die, punch};
pub use distance::Distance;
pub use motion::{Motion, PunchMotion};
pub use outline::{Bend, Corner, FirstTouch, Outline, OutlineError, ToolSide};
pub use piece::Piece;
pub use profile::{DistanceSlope, Profile, ProfileError, ProfileSlope};
