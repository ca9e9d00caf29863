//! Where the sheet is held at the start.

use super::history::History;
use super::subdomain::Subdomain;
use crate::mesh::SurfaceSide;

/// Multiplier of a point that holds the sheet, mm: it marks the point as one that carries, and is far below any
/// force that matters.
const HOLDS: f64 = 1e-9;
/// Gaps that exceed the smallest one by no more than this are as small, mm.
const SAME_GAP: f64 = 1e-12;

/// Multiplier and gap of a contact point at the start, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StartValues {
    pub multiplier: f64,
    pub gap: f64,
}

/// Gap of a contact point of the undeformed sheet, and its distance from the middle of the sheet, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    gap: f64,
    along: f64,
}

impl Subdomain {
    /// Start values of this rank's contact points.
    ///
    /// The flat sheet lies on the die without force: every point of the die's flat is closed and none
    /// carries, so nothing would hold the sheet in the first Newton step. A tiny multiplier at the one
    /// point that will carry, the die's innermost touching one, and at the punch's closest one, shows
    /// the solver where the sheet is held. With a multiplier at all touching points instead the sheet peels off
    /// the die one point after the other. `smallest` takes the smallest number over the ranks.
    pub(super) fn start_values(&self, smallest: impl Fn(f64) -> f64) -> Vec<StartValues> {
        let still = vec![0.0; self.unknown_count()];
        let points = self.contact_points(&History::virgin(self), 0.0, &still);
        let candidates: Vec<(SurfaceSide, Candidate)> = points
            .iter()
            .zip(&self.contacts)
            .map(|(point, contact)| {
                let (gap, along) = (point.gap, point.reference[0]);
                (contact.side, Candidate { gap, along })
            })
            .collect();
        let [bottom, top] = [SurfaceSide::Bottom, SurfaceSide::Top].map(|side| {
            let of_side = candidates.iter().filter(|(of, _)| *of == side);
            Holding::of(of_side.map(|(_, candidate)| *candidate), &smallest)
        });
        candidates
            .into_iter()
            .map(|(side, candidate)| {
                let holding = match side {
                    SurfaceSide::Bottom => &bottom,
                    SurfaceSide::Top => &top,
                };
                if holding.is(candidate) {
                    StartValues {
                        multiplier: HOLDS,
                        gap: 0.0,
                    }
                } else {
                    StartValues {
                        multiplier: 0.0,
                        gap: candidate.gap.max(0.0),
                    }
                }
            })
            .collect()
    }
}

/// Which point of a face holds the sheet: of those whose gap is the smallest, the innermost one.
struct Holding {
    smallest_gap: f64,
    innermost: f64,
}

impl Holding {
    /// Of this rank's points and those of all others. The smallest gap is settled first, over all points: whether two
    /// gaps are the same is no transitive relation, so points must not be compared pair by pair.
    fn of(
        candidates: impl Iterator<Item = Candidate> + Clone,
        smallest: impl Fn(f64) -> f64,
    ) -> Self {
        let least = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(f64::INFINITY, f64::min);
        let smallest_gap = smallest(least(&mut candidates.clone().map(|point| point.gap)));
        let near = candidates.filter(|point| is_same(point.gap, smallest_gap));
        let innermost = smallest(least(&mut near.map(|point| point.along)));
        Self {
            smallest_gap,
            innermost,
        }
    }

    fn is(&self, candidate: Candidate) -> bool {
        is_same(candidate.gap, self.smallest_gap) && candidate.along == self.innermost
    }
}

fn is_same(gap: f64, smallest: f64) -> bool {
    gap <= smallest + SAME_GAP
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The place of the point that holds, on one rank.
    fn chosen(candidates: &[Candidate]) -> f64 {
        let holding = Holding::of(candidates.iter().copied(), |number| number);
        let holds: Vec<f64> = candidates
            .iter()
            .filter(|candidate| holding.is(**candidate))
            .map(|candidate| candidate.along)
            .collect();
        assert_eq!(holds.len(), 1);
        holds[0]
    }

    #[test]
    fn the_choice_does_not_depend_on_the_order_of_the_points() {
        // The second is as near as the first, the third as near as the second, but not as the first.
        let [first, second, third] = [(0.0, 3.0), (0.9e-12, 2.0), (1.8e-12, 1.0)]
            .map(|(gap, along)| Candidate { gap, along });
        for order in [
            [first, second, third],
            [first, third, second],
            [second, first, third],
            [second, third, first],
            [third, first, second],
            [third, second, first],
        ] {
            assert_eq!(chosen(&order), 2.0, "{order:?}");
        }
    }
}
