//! Work done over a run.

/// How much a run has done so far, with the runs it goes on from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Solves refused.
    pub refused: u64,
    /// Newton iterations of all solves; each is one linear solve.
    pub newton: u64,
}
