//! Why a solve was refused, in words.

use std::fmt;

use petsc::SnesReason;

use super::solve_watch::{Course, Flip, SolveWatch};
use crate::mesh::SurfaceSide;
use crate::output::number;
use crate::system::{ContactPlace, ElementFailure, FailedElement, System};

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
    /// How they went.
    pub course: Course,
    /// Contact points that flip between iterations.
    pub flips: Vec<(ContactPlace, Flip)>,
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
        const MARKS: [Flip; 2] = [Flip::Closing, Flip::Slipping];
        let marked = |flip| u8::from(flip == Flip::Slipping);
        let mine: Vec<_> = watch
            .flips()
            .map(|(point, flip)| (point, marked(flip)))
            .collect();
        let places = system.share_places(&mine);
        Self {
            time,
            dt,
            reason,
            iterations,
            norms: watch.norms().to_vec(),
            course: Course::of(watch.norms(), tolerance),
            flips: places
                .into_iter()
                .map(|place| (place, MARKS[usize::from(place.mark)]))
                .collect(),
            element: FailedElement::over_ranks(system.comm(), failure),
        }
    }

    /// Whether the iterations were used up, and nothing worse happened.
    pub fn out_of_iterations(&self) -> bool {
        self.reason == SnesReason::DivergedIterations && self.element.is_none()
    }

    /// The points that flip in one way, in words; nothing if there are none.
    pub fn flips_in_words(&self, kind: Flip) -> Option<String> {
        let how = match kind {
            Flip::Closing => "open and close",
            Flip::Slipping => "stick and slip",
        };
        let of_face = |side: SurfaceSide, tool: &str| {
            let flips = self
                .flips
                .iter()
                .filter(|(place, flip)| *flip == kind && place.side == side);
            let places: Vec<f64> = flips.map(|(place, _)| place.along).collect();
            let (first, last) = (places.first()?, places.last()?);
            let range = if places.len() == 1 {
                format!("{first:.2} mm")
            } else {
                format!("{first:.2} to {last:.2} mm")
            };
            Some(
                format!("{} under the {tool} at {range}", places.len())
                    .replace("under the die", "on the die"),
            )
        };
        let faces = [
            of_face(SurfaceSide::Top, "punch"),
            of_face(SurfaceSide::Bottom, "die"),
        ];
        let faces: Vec<String> = faces.into_iter().flatten().collect();
        (!faces.is_empty()).then(|| {
            format!(
                "contact points {how} between iterations: {} along the sheet",
                faces.join(", ")
            )
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
            seen.push(format!("the residual {}", self.course.words(&self.norms)));
        }
        let flips = [Flip::Closing, Flip::Slipping];
        seen.extend(
            flips
                .into_iter()
                .filter_map(|kind| self.flips_in_words(kind)),
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
