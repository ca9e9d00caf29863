//! A run that was ended on request.

use std::path::PathBuf;

use crate::run::stop_watch::StopCause;

/// A run that was ended before its end.
#[derive(Clone, Debug)]
pub struct Interruption {
    /// Why.
    pub cause: StopCause,
    /// Time of the last accepted step, ms.
    pub time: f64,
    /// From where it can go on.
    pub checkpoint: PathBuf,
}

impl Interruption {
    /// Where and why, in one sentence.
    pub fn sentence(&self) -> String {
        format!("at t = {:.6} ms: {}", self.time, self.cause.sentence())
    }
}
