//! How the residual of a Newton solve went, and what that is called.

/// Two residuals that differ by less than this share are the same, in a cycle.
const SAME: f64 = 0.02;
/// A residual that fell to less than this share over the last two iterations was still falling.
const STILL_FALLING: f64 = 0.3;
/// Periods in which a residual can cycle, iterations.
const PERIODS: std::ops::RangeInclusive<usize> = 2..=4;
/// Residuals at the end of a solve between which it stagnates or cycles.
const TAIL: usize = 5;

/// How the residual norms of a solve developed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ResidualHistory {
    /// Too few iterations to judge it.
    Short,
    /// It is not a number.
    NotANumber,
    /// Below the tolerance, but the forces of the tools did not balance yet.
    Small,
    /// It was still falling, by this factor in each of the last two iterations.
    Falls(f64),
    /// It repeats itself with this period, iterations.
    Cycles(usize),
    /// It is larger than at the start.
    Grows,
    /// None of these: it stays where it is.
    Stagnates,
}

impl ResidualHistory {
    /// Classifies residual norms (mm) that should fall below `tolerance`.
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
        let period = PERIODS.into_iter().find(|&period| cycles(norms, period));
        if let Some(period) = period {
            return Self::Cycles(period);
        }
        let before = norms[count - 3];
        if last < STILL_FALLING * before {
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
        let tail = &norms[norms.len().saturating_sub(TAIL)..];
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
                format!(
                    "repeats itself every {period} iterations, between {least:.1e} and {most:.1e} mm"
                )
            }
            Self::Grows => format!(
                "grows, from {:.1e} to {last:.1e} mm",
                norms.first().copied().unwrap_or(f64::NAN)
            ),
            Self::Stagnates => format!("stagnates between {least:.1e} and {most:.1e} mm"),
        }
    }
}

/// Whether the last two periods of `period` norms are the same, and a period has more than one value.
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
    fn each_residual_history_has_its_name() {
        let of = |norms: &[f64]| ResidualHistory::of(norms, 1e-9);
        assert_eq!(of(&[]), ResidualHistory::Short);
        assert_eq!(of(&[1.0, 0.5]), ResidualHistory::Short);
        assert_eq!(of(&[1.0, f64::NAN]), ResidualHistory::NotANumber);
        assert_eq!(of(&[1.0, 1e-3, 1e-10]), ResidualHistory::Small);
        assert_eq!(of(&[1.0, 1e-1, 1e-2]), ResidualHistory::Falls(10.0));
        assert_eq!(
            of(&[1.0, 0.2, 0.1, 0.2, 0.1, 0.2, 0.1]),
            ResidualHistory::Cycles(2)
        );
        assert_eq!(
            of(&[1.0, 0.3, 0.2, 0.1, 0.3, 0.2, 0.1]),
            ResidualHistory::Cycles(3)
        );
        assert_eq!(of(&[1.0, 0.1, 0.1, 0.1, 0.1]), ResidualHistory::Stagnates);
        assert_eq!(of(&[1.0, 3.0, 0.5, 9.0]), ResidualHistory::Grows);
    }
}
