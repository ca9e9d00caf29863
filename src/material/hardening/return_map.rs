//! The radial return for any hardening law.

use super::{Law, PlasticStep};

/// Newton steps before only halving is left; a concave law needs five or so.
const MOST_NEWTON: usize = 40;
/// With halving from there on: enough to take any bracket to rounding.
const MOST: usize = 140;

/// Solves r(dp) = `q_trial` - 3G dp - σ(`p_n` + dp) = 0 by Newton's method within a bracket.
///
/// r falls with a slope of at least 3G, so the root lies between 0 and r(0) / 3G. For a concave law r is convex and Newton's
/// method from 0 moves up to the root without overshooting; across a kink the bracket takes care, and where Newton's
/// method leaves it or takes too long the bracket is halved.
pub(super) fn iterate(
    law: &(impl Law + ?Sized),
    q_trial: f64,
    p_n: f64,
    three_g: f64,
) -> PlasticStep {
    let (mut yield_stress, mut slope) = law.flow_stress(p_n);
    let excess = q_trial - yield_stress;
    if excess <= 0.0 || excess.is_nan() {
        return PlasticStep {
            dp: if excess.is_nan() { excess } else { 0.0 },
            yield_stress,
            slope,
        };
    }
    let mut dp = 0.0;
    let (mut low, mut high) = (0.0, excess / three_g);
    for iteration in 0..MOST {
        let residual = q_trial - three_g * dp - yield_stress;
        if residual.abs() <= f64::EPSILON * q_trial {
            break;
        }
        if residual > 0.0 {
            low = dp;
        } else {
            high = dp;
        }
        let newton = dp + residual / (three_g + slope);
        let next = if iteration < MOST_NEWTON && (low..=high).contains(&newton) {
            newton
        } else {
            0.5 * (low + high)
        };
        if next == dp {
            break;
        }
        dp = next;
        (yield_stress, slope) = law.flow_stress(p_n + dp);
    }
    PlasticStep {
        dp,
        yield_stress,
        slope,
    }
}
