//! How far a Newton step goes, and how much inertia its tangent has.

/// Full steps are trusted up to this iteration.
const TRUSTED_ITERATIONS: usize = 5;
/// A residual that fell by less than this factor over two iterations stagnates.
const STAGNATION: f64 = 0.7;
/// Length of a damped step.
const DAMPING: f64 = 0.5;

/// Damping of stagnating Newton solves.
///
/// A Gauss point that is elastic at the solution can jump between opposite sides of the yield
/// surface for ever, because the plastic tangent is much softer than the elastic one and a full step
/// overshoots. Half a step lands between them.
#[derive(Clone, Debug, Default)]
pub struct Damping {
    /// Residual norms of the solve so far, mm.
    norms: Vec<f64>,
    last_was_full: bool,
}

impl Damping {
    /// Length of the step from an iterate with residual norm `norm` at `iteration` (0 starts a new
    /// solve).
    pub fn step_length(&mut self, iteration: usize, norm: f64) -> f64 {
        if iteration == 0 {
            self.norms.clear();
            self.last_was_full = true;
        }
        self.norms.push(norm);
        let stagnates = iteration >= TRUSTED_ITERATIONS
            && self.norms.len() > 2
            && norm > STAGNATION * self.norms[self.norms.len() - 3];
        let length = if stagnates && self.last_was_full {
            DAMPING
        } else {
            1.0
        };
        self.last_was_full = length == 1.0;
        length
    }
}

/// A correction may move the sheet by this share of what the step in time is expected to.
const CORRECTION_SHARE: f64 = 0.3;

/// Length of a Newton step whose largest displacement is `correction` (mm), in a time step expected to
/// move the sheet by `expected` (mm). The first step of a solve is free.
///
/// When all points slip, the arm of the sheet is almost a mechanism: a full Newton step throws it far
/// off, a hundred points touch down, and the solve is lost.
pub(super) fn limited_length(iteration: usize, correction: f64, expected: f64) -> f64 {
    if iteration == 0 || correction <= CORRECTION_SHARE * expected {
        1.0
    } else {
        CORRECTION_SHARE * expected / correction
    }
}

/// Factor by which the tangent's inertia grows after a limited step, and shrinks after a free one.
const INERTIA_FACTOR: f64 = 4.0;
/// Most inertia in the tangent, times its own.
const MOST_INERTIA: f64 = 1e4;

/// Inertia in the tangent of a Newton solve, as a multiple of its own.
///
/// A step that [`limited_length`] cuts shows that the tangent is nearly singular or indefinite: the sheet
/// snaps through. More mass in the next tangent, as a shorter time step would bring, makes it definite;
/// the residual, and so the solution, stays the same (pseudo-transient continuation: Kelley and Keyes
/// 1998, SIAM J. Numer. Anal. 35, 508-523). Without mass in the case it changes nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentInertia(f64);

impl Default for TangentInertia {
    fn default() -> Self {
        Self::OWN
    }
}

impl TangentInertia {
    /// The tangent's own inertia, with which a solve begins.
    pub(super) const OWN: Self = Self(1.0);

    /// The multiple for the next tangent.
    pub(super) fn multiple(self) -> f64 {
        self.0
    }

    /// [`limited_length`] gave a step this length.
    pub(super) fn follow(&mut self, length: f64) {
        self.0 = if length < 1.0 {
            (self.0 * INERTIA_FACTOR).min(MOST_INERTIA)
        } else {
            (self.0 / INERTIA_FACTOR).max(1.0)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_stagnation_is_damped_and_only_every_other_time() {
        let mut damping = Damping::default();
        let falling = (0..12).map(|k| damping.step_length(k, 0.1_f64.powi(k as i32)));
        assert!(falling.into_iter().all(|l| l == 1.0));
        let hanging: Vec<f64> = (0..9).map(|k| damping.step_length(k, 1e-3)).collect();
        assert_eq!(hanging, [1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 1.0, 0.5, 1.0]);
    }

    #[test]
    fn inertia_grows_while_steps_are_limited_and_goes_back() {
        let mut inertia = TangentInertia::OWN;
        let multiples = [1.0, 0.2, 0.5, 1.0, 1.0, 1.0].map(|length| {
            inertia.follow(length);
            inertia.multiple()
        });
        assert_eq!(multiples, [1.0, 4.0, 16.0, 4.0, 1.0, 1.0]);
    }
}
