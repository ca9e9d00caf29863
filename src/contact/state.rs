//! What a contact point does, from the law to the pictures.

/// State of a contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactState {
    /// It carries no force.
    #[default]
    Open,
    /// It carries a force and does not slip; without friction every closed point is in this state.
    Stick,
    /// It slips along increasing arc length of the tool's outline.
    SlipForward,
    /// It slips along decreasing arc length of the tool's outline.
    SlipBackward,
}

impl ContactState {
    /// The state of a point that slips against this friction force on the sheet, which counts along increasing arc
    /// length: friction opposes the slip.
    pub fn slipping_against(friction: f64) -> Self {
        if friction < 0.0 {
            Self::SlipForward
        } else {
            Self::SlipBackward
        }
    }

    /// Whether the point carries a force.
    pub fn is_closed(self) -> bool {
        self != Self::Open
    }

    /// Whether friction is at its limit.
    pub fn slips(self) -> bool {
        matches!(self, Self::SlipForward | Self::SlipBackward)
    }

    /// The number by which files know the state: 0 open, 1 stick, 2 slip forward, 3 slip backward.
    pub fn code(self) -> i32 {
        match self {
            Self::Open => 0,
            Self::Stick => 1,
            Self::SlipForward => 2,
            Self::SlipBackward => 3,
        }
    }
}
