//! Why a solve was refused, in words.

use std::fmt;

use petsc::SnesReason;

use super::residual_history::ResidualHistory;
use super::solve_watch::{Chattering, SolveWatch};
use crate::mesh::SurfaceSide;
use crate::system::{ContactPlace, ElementFailure, FailedElement, System};
use crate::text::number;

/// Every kind of chattering; the place in this list is its number among the ranks.
const KINDS: [Chattering; 2] = [Chattering::OpenClose, Chattering::StickSlip];

/// A Newton solve that did not converge. The same on every rank.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// Time the step was to reach, ms.
    pub time: f64,
    /// Length of the step, ms.
    pub dt: f64,
    /// What PETSc says.
    pub reason: SnesReason,
    /// Newton iterations made.
    pub iterations: u32,
    /// Residual norms, mm.
    pub norms: Vec<f64>,
    /// How they developed.
    pub history: ResidualHistory,
    /// Contact points that chatter.
    pub chattering: Vec<(ContactPlace, Chattering)>,
    /// The element that could not be evaluated, if any.
    pub element: Option<FailedElement>,
}

impl Refusal {
    /// From what this rank watched of the solve of a step to `time` of length `dt` (ms). Collective.
    pub(in crate::run) fn new(
        system: &System,
        watch: &SolveWatch,
        (time, dt): (f64, f64),
        reason: SnesReason,
        iterations: u32,
        tolerance: f64,
        failure: Option<ElementFailure>,
    ) -> Self {
        let mark = |kind| u8::from(kind == KINDS[1]);
        let mine: Vec<_> = watch
            .chattering()
            .map(|(point, kind)| (point, mark(kind)))
            .collect();
        let places = system.share_places(&mine);
        Self {
            time,
            dt,
            reason,
            iterations,
            norms: watch.norms().to_vec(),
            history: ResidualHistory::of(watch.norms(), tolerance),
            chattering: places
                .into_iter()
                .map(|place| (place, KINDS[usize::from(place.mark)]))
                .collect(),
            element: FailedElement::over_ranks(system.comm(), failure),
        }
    }

    /// Whether the iterations were used up, and nothing worse happened.
    pub fn out_of_iterations(&self) -> bool {
        self.reason == SnesReason::DivergedIterations && self.element.is_none()
    }

    /// The points that chatter so and where they are, in words; nothing if there are none.
    pub fn chattering_in_words(&self, kind: Chattering) -> Option<String> {
        let how = match kind {
            Chattering::OpenClose => "open and close",
            Chattering::StickSlip => "stick and slip",
        };
        let faces = [
            (SurfaceSide::Top, "under the punch"),
            (SurfaceSide::Bottom, "on the die"),
        ];
        let faces: Vec<String> = faces
            .into_iter()
            .filter_map(|(side, place)| self.range_of(kind, side, place))
            .collect();
        (!faces.is_empty()).then(|| {
            format!(
                "contact points {how} between iterations: {} along the sheet",
                faces.join(", ")
            )
        })
    }

    /// Number and range of the points of one face that chatter so.
    fn range_of(&self, kind: Chattering, side: SurfaceSide, place: &str) -> Option<String> {
        let points = self
            .chattering
            .iter()
            .filter(|(point, how)| *how == kind && point.side == side);
        let along: Vec<f64> = points.map(|(point, _)| point.along).collect();
        let (first, last) = (along.first()?, along.last()?);
        Some(match along.len() {
            1 => format!("1 {place} at {first:.2} mm"),
            count => format!("{count} {place} at {first:.2} to {last:.2} mm"),
        })
    }

    /// What was seen of the solve, without its time and length.
    pub fn seen(&self) -> Vec<String> {
        let mut seen = Vec::new();
        if let Some(element) = &self.element {
            seen.push(format!(
                "element {} at ({:.2}, {:.2}) mm, {}",
                element.element, element.position[0], element.position[1], element.cause
            ));
        } else {
            seen.push(format!("the residual {}", self.history.words(&self.norms)));
        }
        seen.extend(
            KINDS
                .into_iter()
                .filter_map(|kind| self.chattering_in_words(kind)),
        );
        seen
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "step to {:.4} ms (dt {} ms), {} iteration{}",
            self.time,
            number(self.dt),
            self.iterations,
            if self.iterations == 1 { "" } else { "s" },
        )?;
        if !self.out_of_iterations() && self.element.is_none() {
            write!(f, ", {}", self.reason.sentence())?;
        }
        write!(f, ": {}", self.seen().join("; "))
    }
}
