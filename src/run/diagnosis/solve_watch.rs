//! Watches a Newton solve: its residual norms, and the contact points that change their state again and again.

use crate::contact::ContactState;

/// Status of the contact points is looked at in the last iterations a solve may have: looking costs a little, and a
/// solve that ends earlier converged.
const LAST_ITERATIONS: usize = 6;
/// A point that changes its status this often in these iterations chatters.
const CHANGES: u8 = 2;

/// What one Newton solve looked like so far, on this rank.
#[derive(Clone, Debug, Default)]
pub(in crate::run) struct SolveWatch {
    norms: Vec<f64>,
    /// States of this rank's contact points at the last look.
    states: Vec<ContactState>,
    changes: Vec<Changes>,
}

/// How often a contact point changed in the iterations looked at.
#[derive(Clone, Copy, Debug, Default)]
struct Changes {
    /// Between open and closed.
    closing: u8,
    /// Between sticking, slipping forwards and slipping backwards.
    slipping: u8,
}

/// How a contact point chatters: changes its state between the iterations of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chattering {
    /// Opens and closes.
    OpenClose,
    /// Closed, it sticks and slips.
    StickSlip,
}

impl SolveWatch {
    /// Takes the residual norm (mm) at an iteration; 0 starts a new solve.
    pub(in crate::run) fn residual(&mut self, iteration: usize, norm: f64) {
        if iteration == 0 {
            *self = Self::default();
        }
        self.norms.push(norm);
    }

    /// Whether the status of the points is wanted at this iteration of a solve that may have `most`.
    pub(in crate::run) fn looks(iteration: usize, most: usize) -> bool {
        iteration + LAST_ITERATIONS >= most
    }

    /// Takes the states of this rank's points.
    pub(in crate::run) fn states(&mut self, now: Vec<ContactState>) {
        self.changes.resize(now.len(), Changes::default());
        for ((old, new), changes) in self.states.iter().zip(&now).zip(&mut self.changes) {
            if old.is_closed() != new.is_closed() {
                changes.closing += 1;
            } else if old != new {
                changes.slipping += 1;
            }
        }
        self.states = now;
    }

    /// Residual norms of the solve, mm.
    pub(in crate::run) fn norms(&self) -> &[f64] {
        &self.norms
    }

    /// This rank's points that chatter. Where the allowed iterations are too few for two changes, one change is
    /// enough.
    pub(in crate::run) fn chattering(&self) -> impl Iterator<Item = (usize, Chattering)> {
        let enough = if self.norms.len() > LAST_ITERATIONS {
            CHANGES
        } else {
            1
        };
        let kind = move |changes: &Changes| {
            if changes.closing >= enough {
                Some(Chattering::OpenClose)
            } else {
                (changes.slipping >= enough).then_some(Chattering::StickSlip)
            }
        };
        let points = self.changes.iter().enumerate();
        points.filter_map(move |(point, changes)| Some((point, kind(changes)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_that_change_back_and_forth_chatter() {
        let mut watch = SolveWatch::default();
        for iteration in 0..10 {
            watch.residual(iteration, 1.0);
            // The first opens and closes, the second closes once, the third sticks and slips.
            let even = iteration % 2 == 0;
            let closed = |is| {
                if is {
                    ContactState::Stick
                } else {
                    ContactState::Open
                }
            };
            let slips = |is| {
                if is {
                    ContactState::SlipForward
                } else {
                    ContactState::Stick
                }
            };
            watch.states(vec![closed(!even), closed(iteration > 4), slips(!even)]);
        }
        let chattering: Vec<_> = watch.chattering().collect();
        assert_eq!(
            chattering,
            [(0, Chattering::OpenClose), (2, Chattering::StickSlip)]
        );
        assert!(!SolveWatch::looks(13, 20) && SolveWatch::looks(14, 20) && SolveWatch::looks(0, 3));
    }
}
