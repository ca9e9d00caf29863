//! Watches a Newton solve: how its residual went, and which contact points could not make up their minds.

use crate::contact::ContactState;

/// Status of the contact points is looked at in the last iterations a solve may have: looking costs a little, and a
/// solve that ends earlier converged.
const LAST_ITERATIONS: usize = 6;
/// A point that changes its status so often in these iterations flips.
const FLIPS: u8 = 2;
/// Two residuals that differ by less than this share are the same, in a cycle.
const SAME: f64 = 0.02;

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

/// How a contact point flips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    /// Opens and closes.
    Closing,
    /// Closed, it sticks and slips.
    Slipping,
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

    /// This rank's points that flip. Where so few iterations were allowed that none could change twice, one change is
    /// enough.
    pub(in crate::run) fn flips(&self) -> impl Iterator<Item = (usize, Flip)> {
        let enough = if self.norms.len() > LAST_ITERATIONS {
            FLIPS
        } else {
            1
        };
        let kind = move |changes: &Changes| {
            if changes.closing >= enough {
                Some(Flip::Closing)
            } else {
                (changes.slipping >= enough).then_some(Flip::Slipping)
            }
        };
        let points = self.changes.iter().enumerate();
        points.filter_map(move |(point, changes)| Some((point, kind(changes)?)))
    }
}

/// How the residual of a solve went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Too few iterations to tell.
    Short,
    /// It is not a number.
    NotANumber,
    /// Below the tolerance, but the forces of the tools did not balance yet.
    Small,
    /// It was still falling, by this factor in each of the last two iterations.
    Falls(f64),
    /// It goes round with this period.
    Cycles(usize),
    /// It is larger than at the start.
    Grows,
    /// None of these: it hangs.
    Stagnates,
}

impl Course {
    /// The course of residual norms (mm) that should fall below `tolerance`.
    pub fn of(norms: &[f64], tolerance: f64) -> Self {
        let count = norms.len();
        let (Some(&first), Some(&last)) = (norms.first(), norms.last()) else {
            return Self::Short;
        };
        if !last.is_finite() {
            return Self::NotANumber;
        }
        if last <= tolerance {
            return Self::Small;
        }
        if count < 3 {
            return Self::Short;
        }
        let period = (2..=4).find(|&period| cycles(norms, period));
        if let Some(period) = period {
            return Self::Cycles(period);
        }
        let before = norms[count - 3];
        if last < 0.3 * before {
            Self::Falls((before / last).sqrt())
        } else if last > first {
            Self::Grows
        } else {
            Self::Stagnates
        }
    }

    /// In words, after "the residual".
    pub fn words(self, norms: &[f64]) -> String {
        let last = norms.last().copied().unwrap_or(f64::NAN);
        let tail = &norms[norms.len().saturating_sub(5)..];
        let least = tail.iter().copied().fold(f64::INFINITY, f64::min);
        let most = tail.iter().copied().fold(0.0, f64::max);
        match self {
            Self::Short => format!("was {last:.1e} mm when its few iterations were used up"),
            Self::NotANumber => "is not a number".to_owned(),
            Self::Small => {
                format!("is small, {last:.1e} mm, but the forces of the tools do not balance yet")
            }
            Self::Falls(factor) => {
                format!("was still falling, by {factor:.0} per iteration, at {last:.1e} mm")
            }
            Self::Cycles(period) => {
                format!("goes round in a cycle of {period}, from {least:.1e} to {most:.1e} mm")
            }
            Self::Grows => format!(
                "grows, from {:.1e} to {last:.1e} mm",
                norms.first().copied().unwrap_or(f64::NAN)
            ),
            Self::Stagnates => format!("hangs between {least:.1e} and {most:.1e} mm"),
        }
    }
}

/// Whether the last two rounds of `period` norms are the same, and a round is more than one value.
fn cycles(norms: &[f64], period: usize) -> bool {
    let count = norms.len();
    if count < 2 * period {
        return false;
    }
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.max(b);
    let round = &norms[count - period..];
    let before = &norms[count - 2 * period..count - period];
    round.iter().zip(before).all(|(a, b)| same(*a, *b)) && round.iter().any(|a| !same(*a, round[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_course_of_a_residual_is_told() {
        let of = |norms: &[f64]| Course::of(norms, 1e-9);
        assert_eq!(of(&[]), Course::Short);
        assert_eq!(of(&[1.0, 0.5]), Course::Short);
        assert_eq!(of(&[1.0, f64::NAN]), Course::NotANumber);
        assert_eq!(of(&[1.0, 1e-3, 1e-10]), Course::Small);
        assert_eq!(of(&[1.0, 1e-1, 1e-2]), Course::Falls(10.0));
        assert_eq!(of(&[1.0, 0.2, 0.1, 0.2, 0.1, 0.2, 0.1]), Course::Cycles(2));
        assert_eq!(of(&[1.0, 0.3, 0.2, 0.1, 0.3, 0.2, 0.1]), Course::Cycles(3));
        assert_eq!(of(&[1.0, 0.1, 0.1, 0.1, 0.1]), Course::Stagnates);
        assert_eq!(of(&[1.0, 3.0, 0.5, 9.0]), Course::Grows);
    }

    #[test]
    fn only_points_that_go_to_and_fro_flip() {
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
        let flips: Vec<_> = watch.flips().collect();
        assert_eq!(flips, [(0, Flip::Closing), (2, Flip::Slipping)]);
        assert!(!SolveWatch::looks(13, 20) && SolveWatch::looks(14, 20) && SolveWatch::looks(0, 3));
    }
}
