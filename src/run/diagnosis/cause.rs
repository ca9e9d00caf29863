//! What kept a solve from converging.

use petsc::SnesReason;

use super::refusal::Refusal;
use super::residual_history::ResidualHistory;
use super::solve_watch::Chattering;

/// What kept a solve from converging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// The matrix could not be factorised.
    Matrix,
    /// An element could not be evaluated.
    Element,
    /// There were not enough iterations.
    Iterations,
    /// Contact points open and close.
    OpenClose,
    /// Contact points stick and slip.
    StickSlip,
    /// The residual does not fall, and no contact point chatters.
    Residual,
}

impl Cause {
    /// The cause of a refused solve.
    pub fn of(refusal: &Refusal) -> Self {
        let chatters = |kind: Chattering| refusal.chattering.iter().any(|(_, how)| *how == kind);
        if refusal.element.is_some() {
            Self::Element
        } else if refusal.reason == SnesReason::DivergedLinearSolve {
            Self::Matrix
        } else if matches!(
            refusal.history,
            ResidualHistory::Short | ResidualHistory::Falls(_) | ResidualHistory::Small
        ) {
            Self::Iterations
        } else if chatters(Chattering::OpenClose) {
            Self::OpenClose
        } else if chatters(Chattering::StickSlip) {
            Self::StickSlip
        } else {
            Self::Residual
        }
    }

    /// In a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Matrix => {
                "The matrix cannot be factorised: some part of the model is not held in place."
            }
            Self::Element => {
                "An element became inverted during the solve, or too distorted to be evaluated."
            }
            Self::Iterations => "The solve was converging, but its iterations were used up.",
            Self::OpenClose => {
                "Contact points open and close from iteration to iteration, and the residual does not fall."
            }
            Self::StickSlip => {
                "Contact points stick and slip from iteration to iteration, and the residual does not fall."
            }
            Self::Residual => {
                "The residual does not fall although contact does not change, so the material or the mesh \
                 is the reason."
            }
        }
    }
}
