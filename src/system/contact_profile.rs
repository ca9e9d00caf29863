//! Where a tool is touched, along the tool: the sheet slides past, the pressure stays.
//!
//! The closure row of a contact point, φ + C λ - g = 0, says that the signed distance φ is everything: pressed where it
//! is negative, open where it is positive. In a step the sheet slides past the tool by several contact points, and
//! nearly each of them opens or closes; φ as a function of the tool's arc length hardly changes, it only moves along
//! with the zone of contact. So the profile of the last step, moved on as its zones moved before, shows which points
//! will carry in the next one, and what.

/// Points farther than this from the tool are left out, mm: some hundred times how deep surfaces close.
pub(super) const NEAR: f64 = 0.02;
/// What is no farther than this from a zone along the tool belongs to it, mm: half a thickness of the sheet.
pub(super) const REACH: f64 = 0.5;
/// A zone of fewer points says too little of the distance along the tool.
const LEAST_POINTS: usize = 3;

/// A contact point near a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NearPoint {
    /// Arc length of its foot along the tool, mm.
    pub along: f64,
    /// Signed distance, mm.
    pub distance: f64,
}

/// Neighbouring points that are pressed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Zone {
    /// Mean arc length, weighted by how deep each point is pressed, mm.
    centre: f64,
    half_width: f64,
}

/// The distance of the sheet along a tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ContactProfile {
    /// Ascending along the tool.
    feet: Vec<NearPoint>,
    zones: Vec<Zone>,
    /// Whether every zone has enough points.
    resolved: bool,
}

impl ContactProfile {
    /// Of points in any order.
    pub fn new(mut feet: Vec<NearPoint>) -> Self {
        feet.sort_by(|a, b| a.along.total_cmp(&b.along));
        let pressed: Vec<&[NearPoint]> = feet
            .chunk_by(|a, b| (a.distance < 0.0) == (b.distance < 0.0))
            .filter(|run| run[0].distance < 0.0)
            .collect();
        Self {
            zones: pressed.iter().copied().map(Zone::of).collect(),
            resolved: pressed.iter().all(|run| run.len() >= LEAST_POINTS),
            feet,
        }
    }

    /// Whether it shows where contact will be: a contact of one or two points moves by jumps.
    pub fn is_resolved(&self) -> bool {
        self.resolved
    }

    /// Whether an arc length (mm) belongs to a zone, or lies next to one.
    pub fn reaches(&self, along: f64) -> bool {
        self.zones.iter().any(|zone| zone.beyond(along) < REACH)
    }

    /// The distance to expect at an arc length (mm) if each zone moves on by `ratio` times what it has moved since the
    /// profile `before`; none where nothing is known.
    pub fn expected(&self, along: f64, before: &Self, ratio: f64) -> Option<f64> {
        let moved = |zone: &Zone| (zone.moved(before) * ratio, *zone);
        let (shift, zone) = self.zones.iter().map(moved).min_by(|(a, near), (b, far)| {
            let [a, b] = [near.beyond(along - a), far.beyond(along - b)];
            a.total_cmp(&b)
        })?;
        let there = along - shift;
        (zone.beyond(there) < REACH).then(|| self.at(there))?
    }

    /// The distance at an arc length between two neighbours.
    fn at(&self, along: f64) -> Option<f64> {
        let after = self.feet.partition_point(|foot| foot.along < along);
        let (left, right) = (self.feet.get(after.checked_sub(1)?)?, self.feet.get(after)?);
        let share = (along - left.along) / (right.along - left.along);
        Some(left.distance + share * (right.distance - left.distance))
    }
}

impl Zone {
    /// Of its pressed points, at least one.
    fn of(pressed: &[NearPoint]) -> Self {
        let depth: f64 = pressed.iter().map(|foot| foot.distance).sum();
        let moment: f64 = pressed.iter().map(|foot| foot.distance * foot.along).sum();
        Self {
            centre: moment / depth,
            half_width: 0.5 * (pressed[pressed.len() - 1].along - pressed[0].along),
        }
    }

    /// How far an arc length is beyond the zone's ends, mm; negative inside.
    fn beyond(&self, along: f64) -> f64 {
        (along - self.centre).abs() - self.half_width
    }

    /// How far it has moved along the tool since an earlier profile, mm; a new one has not.
    fn moved(&self, before: &ContactProfile) -> f64 {
        let moves = before.zones.iter().map(|zone| self.centre - zone.centre);
        moves
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .filter(|moved| moved.abs() < REACH)
            .unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola pressed by a hundredth of a millimetre around `centre`, sampled where the sheet's points happen to be.
    fn parabola(centre: f64, phase: f64) -> ContactProfile {
        let feet = (-20..20).rev().map(|k| {
            let along = centre + 0.07 * (f64::from(k) + phase);
            let distance = (along - centre).powi(2) - 0.01;
            NearPoint { along, distance }
        });
        ContactProfile::new(feet.filter(|foot| foot.distance < NEAR).collect())
    }

    #[test]
    fn a_zone_moves_on_as_it_moved() {
        let (before, now) = (parabola(10.0, 0.2), parabola(10.05, 0.7));
        for along in [10.04, 10.1, 10.15, 10.27] {
            // Twice the time: from 10.05 to 10.15. The distance is known to 0.02 mm, and a parabola is interpolated to a quarter of the spacing squared.
            let exact = (along - 10.15_f64).powi(2) - 0.01;
            let expected = now.expected(along, &before, 2.0).unwrap();
            assert!(
                (expected - exact).abs() < 3e-3,
                "{along}: {expected} {exact}"
            );
        }
    }

    #[test]
    fn nothing_is_expected_where_nothing_was_near() {
        let (none, now) = (ContactProfile::default(), parabola(10.0, 0.3));
        assert_eq!(none.expected(10.0, &now, 1.0), None);
        assert_eq!(now.expected(12.0, &now, 1.0), None);
        assert!(now.reaches(10.5) && !now.reaches(10.7) && !none.reaches(10.0));
        assert!(now.is_resolved());
        let point = NearPoint {
            along: 1.0,
            distance: -1e-3,
        };
        assert!(!ContactProfile::new(vec![point]).is_resolved());
    }

    #[test]
    fn a_zone_without_a_past_stays() {
        let (far, now) = (parabola(20.0, 0.0), parabola(10.0, 0.0));
        let expected = now.expected(10.0, &far, 5.0).unwrap();
        assert!((expected + 0.01).abs() < 1e-12, "{expected}");
    }
}
