//! Why a run stopped, in the words a person reads.

use serde::Serialize;

/// What is known about a run that did not finish.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The last accepted step, its time and the depth of the punch.
    pub place: String,
    /// Why there is no further step, in a sentence or two.
    pub cause: String,
    /// What was seen in the last solve.
    pub observed: Vec<String>,
    /// The solves that were refused, the first and the last ones.
    pub tried: Vec<String>,
    /// What the user can do, the most promising first.
    pub remedies: Vec<String>,
}
