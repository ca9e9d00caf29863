//! Where the sheet is held at the start.

use super::LocalSystem;
use crate::mesh::SurfaceSide;

/// Multiplier of a seeded point, mm: tells the solver that the point carries, and is far below any
/// force that matters.
const SEED: f64 = 1e-9;
/// Gaps that differ by less than this are equal, mm.
const SAME_GAP: f64 = 1e-12;

/// Multiplier and gap of a contact point at the start, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// Multiplier.
    pub multiplier: f64,
    /// Gap.
    pub gap: f64,
}

impl LocalSystem {
    /// Start values of this rank's contact points.
    ///
    /// The flat sheet lies on the die without force: every point of the die's flat is closed and none
    /// carries, so nothing would hold the sheet in the first Newton step. A tiny multiplier at the one
    /// point that will carry, the die's innermost touching one, and at the punch's closest one, tells
    /// the solver where the sheet is held. Seeding all touching points instead lets the sheet peel off
    /// the die one point after the other. `gather` collects all ranks' numbers in order of rank.
    pub fn seeds(&self, gather: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Seed> {
        let still = vec![0.0; self.unknown_count()];
        let points = self.contact_points(0.0, &still);
        let closest = [SurfaceSide::Bottom, SurfaceSide::Top].map(|side| {
            let mine = points
                .iter()
                .zip(&self.contacts)
                .filter(|(_, contact)| contact.side == side)
                .map(|(point, _)| (point.gap, point.reference[0]))
                .fold((f64::INFINITY, f64::INFINITY), closer);
            let all = gather(&[mine.0, mine.1]);
            all.chunks_exact(2).map(|p| (p[0], p[1])).fold(mine, closer)
        });
        points
            .iter()
            .zip(&self.contacts)
            .map(|(point, contact)| {
                let chosen = closest[usize::from(contact.side == SurfaceSide::Top)];
                let seeded = (point.gap, point.reference[0]) == chosen;
                Seed {
                    multiplier: if seeded { SEED } else { 0.0 },
                    gap: if seeded { 0.0 } else { point.gap.max(0.0) },
                }
            })
            .collect()
    }
}

/// The point with the smaller gap, or the inner one of two with the same.
fn closer(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let nearer = b.0 < a.0 - SAME_GAP;
    let as_near_and_inner = b.0 <= a.0 + SAME_GAP && b.1 < a.1;
    if nearer || as_near_and_inner { b } else { a }
}
