//! Coulomb friction with an elastic slip that is remembered from step to step.
//!
//! With s the arc length of the foot point along the tool, in the tool's frame, and the index n for the last accepted step,
//!
//! ```text
//! traction   λ_t = clamp( λ_tn - (s - s_n) / ε_t , -μ λ, μ λ )        F_u -= λ_t ∇s N_a
//! ```
//!
//! which is the return map of perfect plasticity (Simo and Laursen 1992, Comput. Struct. 42, 97-116). The memory matters:
//! without it the sticking traction vanishes as a step is cut, and cutting does not lead back to the last accepted state.
//! λ_t is a function of the other unknowns, so the cone holds exactly at every iterate.

use super::ContactState;
use crate::plane::Vector;

/// Multipliers up to this size are rounding, not contact, mm.
const NO_CONTACT: f64 = 1e-13;

/// A committed traction that reaches this share of its limit slips: the limit itself is known to rounding.
const AT_THE_LIMIT: f64 = 1.0 - 1e-9;

/// Coulomb friction with elastic slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient of friction μ.
    pub coefficient: f64,
    /// Elastic slip for a unit traction, ε_t; scaled as the compliance of [`super::ContactLaw`].
    pub compliance: f64,
}

/// What a contact point remembers of the last accepted step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionState {
    /// Friction force along the tool divided by Young's modulus, mm.
    pub traction: f64,
    /// Arc length of the foot point in the tool's frame, mm.
    pub arc_length: f64,
    /// The edge's nodes in the tool's frame, mm: a moving point has no past of its own, but the point of
    /// the sheet where it is now has one.
    pub nodes: [Vector; 3],
}

/// Friction of a point with its slopes, and what the point does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traction {
    /// Force on the sheet along increasing arc length divided by Young's modulus, mm.
    pub value: f64,
    /// Derivative by the arc length.
    pub by_arc_length: f64,
    /// Derivative by the multiplier.
    pub by_multiplier: f64,
    /// State for a multiplier that counts, that is where the gap is at its bound; see [`Traction::state_at`].
    state: ContactState,
}

impl Traction {
    /// Of a point with this multiplier (mm) and what slid since the last accepted step (mm); without `friction` only the
    /// state.
    pub(super) fn of(
        friction: Option<Friction>,
        multiplier: f64,
        slip: f64,
        before: &FrictionState,
    ) -> Self {
        let closed = if multiplier > 0.0 {
            ContactState::Stick
        } else {
            ContactState::Open
        };
        let Some(friction) = friction.filter(|_| multiplier > NO_CONTACT) else {
            return Self {
                state: closed,
                ..Self::default()
            };
        };
        let trial = before.traction - slip / friction.compliance;
        let limit = friction.coefficient * multiplier;
        if trial.abs() <= limit {
            Self {
                value: trial,
                by_arc_length: -1.0 / friction.compliance,
                by_multiplier: 0.0,
                state: closed,
            }
        } else {
            Self {
                value: limit.copysign(trial),
                by_arc_length: 0.0,
                by_multiplier: friction.coefficient.copysign(trial),
                state: ContactState::slipping_against(trial),
            }
        }
    }

    /// State of the point during a solve, at its gap unknown (mm): a point off its bound is open whatever its multiplier.
    pub fn state_at(&self, gap: f64) -> ContactState {
        if gap > 0.0 {
            ContactState::Open
        } else {
            self.state
        }
    }
}

impl Friction {
    /// State of a closed point with this multiplier (mm) whose committed state is `committed`.
    pub(super) fn committed_state(
        &self,
        multiplier: f64,
        committed: &FrictionState,
    ) -> ContactState {
        let limit = self.coefficient * multiplier;
        if committed.traction.abs() >= AT_THE_LIMIT * limit {
            ContactState::slipping_against(committed.traction)
        } else {
            ContactState::Stick
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRICTION: Friction = Friction {
        coefficient: 0.2,
        compliance: 100.0,
    };

    /// Traction and state at a multiplier after this slip from rest, the gap at its bound.
    fn after(friction: Option<Friction>, multiplier: f64, slip: f64) -> (f64, ContactState) {
        let traction = Traction::of(friction, multiplier, slip, &FrictionState::default());
        (traction.value, traction.state_at(0.0))
    }

    #[test]
    fn the_law_says_what_the_point_does() {
        let with = Some(FRICTION);
        assert_eq!(after(None, 1e-4, 3.0), (0.0, ContactState::Stick));
        assert_eq!(after(None, 0.0, 3.0), (0.0, ContactState::Open));
        assert_eq!(after(with, -1e-4, 3.0), (0.0, ContactState::Open));
        assert_eq!(after(with, 1e-4, 1e-3), (-1e-5, ContactState::Stick));
        // The sheet moves along increasing arc length, and friction holds it back.
        assert_eq!(after(with, 1e-4, 1.0), (-2e-5, ContactState::SlipForward));
        assert_eq!(after(with, 1e-4, -1.0), (2e-5, ContactState::SlipBackward));
        // Off its bound a point is open whatever its multiplier.
        let slipping = Traction::of(with, 1e-4, 1.0, &FrictionState::default());
        assert_eq!(slipping.state_at(1e-9), ContactState::Open);
    }

    #[test]
    fn what_was_committed_says_the_same_as_the_solve() {
        for slip in [-1.0, -1e-3, 0.0, 1e-3, 1.0] {
            let traction = Traction::of(Some(FRICTION), 1e-4, slip, &FrictionState::default());
            let committed = FrictionState {
                traction: traction.value,
                ..FrictionState::default()
            };
            assert_eq!(
                FRICTION.committed_state(1e-4, &committed),
                traction.state_at(0.0),
                "{slip}"
            );
        }
    }
}
