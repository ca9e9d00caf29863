//! How long the next step is: from the iterations of the last one, and so that certain times are
//! hit exactly.

use crate::case::{self, Case, CaseError};

/// The step may grow up to this number of Newton iterations.
const EASY_ITERATIONS: usize = 14;
/// Beyond this number it shrinks.
const HARD_ITERATIONS: usize = 20;
/// Factor of growth and shrinkage.
const FACTOR: f64 = 1.5;
/// Steps without growth after a refused solve.
const CALM_STEPS: usize = 2;
/// What steps begin with after an abrupt change of the motion, as a share of what they were.
const ABRUPT: f64 = 0.2;
/// A step shorter than planned by more than this share was cut because its solve was refused.
const AS_PLANNED: f64 = 1e-6;
/// Two times closer than this share of the whole are the same.
const SAME_TIME: f64 = 1e-10;

/// Step size control.
#[derive(Clone, Debug)]
pub struct StepControl {
    /// Step the control would take if no landmark were near, ms.
    wanted: f64,
    /// Step handed out last, ms.
    planned: f64,
    largest: f64,
    /// Whether steps of a given number are to be equal: then they are short because landmarks are near, not because longer
    /// ones are hard, and the wanted step grows while they are.
    equal: bool,
    /// Times to hit exactly, ascending; the last one ends the run.
    landmarks: Vec<f64>,
    calm: usize,
    /// Whether the planned step ends where a new part of the sheet touches down.
    touches_down: bool,
}

impl StepControl {
    /// Starts with `first` and never exceeds `largest` (ms). `landmarks` are hit exactly; the last
    /// is the end.
    pub fn new(first: f64, largest: f64, mut landmarks: Vec<f64>) -> Self {
        landmarks.sort_by(f64::total_cmp);
        let mut control = Self {
            wanted: first.min(largest),
            planned: first,
            largest,
            equal: false,
            landmarks,
            calm: 0,
            touches_down: false,
        };
        control.planned = control.clip(0.0);
        control
    }

    /// Lets steps be as long as landmarks are apart again, once they have been shorter.
    pub(super) fn with_equal_steps(mut self, equal: bool) -> Self {
        self.equal = equal;
        self
    }

    /// What the control remembers besides its settings: the step it wants (ms), and steps without growth to come.
    pub(super) fn memory(&self) -> (f64, usize) {
        let Self {
            wanted,
            calm,
            planned: _,
            largest: _,
            equal: _,
            landmarks: _,
            touches_down: _,
        } = self;
        (*wanted, *calm)
    }

    /// Goes on at time `t` (ms) with the memory of another control.
    pub(super) fn recall(&mut self, t: f64, (wanted, calm): (f64, usize)) {
        self.wanted = wanted.min(self.largest);
        self.calm = calm;
        self.planned = self.clip(t);
    }

    /// The step planned last, ms.
    pub fn planned(&self) -> f64 {
        self.planned
    }

    /// The end of the run, ms.
    pub fn end(&self) -> f64 {
        self.landmarks.last().copied().unwrap_or(0.0)
    }

    /// Whether `t` is the time `mark`.
    pub fn is_at(&self, t: f64, mark: f64) -> bool {
        (t - mark).abs() <= SAME_TIME * self.end()
    }

    /// Next step after one of length `dt` to time `t` was accepted with `iterations` iterations; a
    /// `dt` shorter than planned shows that solves were refused.
    pub fn accepted(&mut self, t: f64, dt: f64, iterations: usize) -> f64 {
        if self.was_cut(dt) {
            self.wanted = dt;
            self.calm = CALM_STEPS;
        } else if iterations > HARD_ITERATIONS {
            self.wanted = dt / FACTOR;
        } else if self.calm > 0 {
            self.calm -= 1;
        } else if iterations <= EASY_ITERATIONS {
            // A step that was clipped to a landmark does not shorten the ones after it.
            let easy = if self.equal { self.wanted } else { dt };
            self.wanted = self.wanted.max(easy * FACTOR).min(self.largest);
        }
        self.touches_down = false;
        self.planned = self.clip(t);
        self.planned
    }

    /// Ends the planned step where a new part of the sheet touches down: after this share of it.
    pub fn end_at_touchdown(&mut self, share: f64) {
        self.planned *= share;
        self.touches_down = true;
    }

    /// Whether a step of length `dt`, before it is [accepted](Self::accepted), ended where a new part of the sheet has
    /// touched down.
    pub fn has_touched_down(&self, dt: f64) -> bool {
        self.touches_down && !self.was_cut(dt)
    }

    /// Plans the step after time `t` where the motion changes abruptly: it is shorter than the ones before.
    pub fn start_anew(&mut self, t: f64) {
        self.wanted *= ABRUPT;
        self.planned = self.clip(t);
    }

    fn was_cut(&self, dt: f64) -> bool {
        dt < (1.0 - AS_PLANNED) * self.planned
    }

    /// The wanted step, shortened so that the next landmark is hit by equal steps.
    fn clip(&self, t: f64) -> f64 {
        let next = self
            .landmarks
            .iter()
            .find(|&&mark| mark > t && !self.is_at(t, mark));
        let Some(next) = next else {
            return self.wanted;
        };
        let left = next - t;
        if left <= self.wanted * (1.0 + 1e-9) {
            left
        } else if left < 2.0 * self.wanted {
            0.5 * left
        } else {
            self.wanted
        }
    }
}

/// Times to hit exactly: both ends, where reference values are compared, and where the user wants a row.
pub(super) fn landmarks(case: &Case) -> Result<Vec<f64>, CaseError> {
    let motion = case.loading.motion();
    let mut depths = case.stepping.report_strokes.clone();
    for value in case.reference_values()? {
        if let case::Instant::Travel(depth) = value.when {
            depths.push(depth);
        }
    }
    depths.retain(|&depth| depth < motion.stroke);
    let mut times: Vec<f64> = depths
        .iter()
        .map(|&depth| motion.time_at_depth(depth))
        .collect();
    let back = motion.unload_fraction * motion.stroke;
    let returns = case.stepping.report_returns.iter();
    times.extend(
        returns
            .filter(|&&way| way < back)
            .map(|&way| motion.time_at_return(way)),
    );
    times.extend([motion.time_load, motion.end()]);
    let equal = |start: f64, end: f64, count: usize| {
        (1..count).map(move |k| start + (end - start) * k as f64 / count as f64)
    };
    times.extend(equal(0.0, motion.time_load, case.stepping.fixed_steps_load));
    if motion.end() > motion.time_load {
        let count = case.stepping.fixed_steps_unload;
        times.extend(equal(motion.time_load, motion.end(), count));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn landmarks_are_hit_and_growth_goes_on_after_them() {
        let mut control = StepControl::new(1.0, 9.0, vec![900.0, 30.0, 1000.0]);
        let (mut t, mut steps, mut hit) = (0.0, 0, 0);
        let mut dt = control.planned();
        while !control.is_at(t, control.end()) {
            assert!(dt > 0.0 && dt <= 9.0);
            t += dt;
            steps += 1;
            hit += [30.0, 900.0, 1000.0]
                .iter()
                .filter(|&&m| control.is_at(t, m))
                .count();
            dt = control.accepted(t, dt, 5);
        }
        assert_eq!(hit, 3);
        assert!(steps < 125, "{steps} steps");
    }

    #[test]
    fn equal_steps_are_whole_again_some_time_after_a_refused_solve() {
        let marks: Vec<f64> = (1..=30).map(|k| 7.0 * f64::from(k)).collect();
        let lengths = |equal| {
            let mut control = StepControl::new(9.0, 9.0, marks.clone()).with_equal_steps(equal);
            let (mut t, mut taken) = (0.0, vec![]);
            while !control.is_at(t, control.end()) {
                let dt = if t == 7.0 { 1.75 } else { control.planned() };
                t += dt;
                taken.push(dt);
                control.accepted(t, dt, 5);
            }
            taken
        };
        let equal = lengths(true);
        assert!(equal.len() < 45, "{equal:?}");
        assert!(
            equal
                .iter()
                .rev()
                .take(15)
                .all(|dt| (dt - 7.0).abs() < 1e-9),
            "{equal:?}"
        );
        // Steps that are free to grow are halved between such landmarks.
        assert!(lengths(false).len() > 55);
    }

    #[test]
    fn steps_end_at_the_strokes_and_returns_asked_for_and_at_none_beyond() {
        let mut case = Case::reference().unwrap();
        let before = landmarks(&case).unwrap();
        let motion = case.loading.motion();
        case.stepping.report_strokes.extend([3.0, 40.0]);
        case.stepping.report_returns = vec![0.57, 2.85, 5.0];
        let after = landmarks(&case).unwrap();
        let new: Vec<f64> = after.into_iter().filter(|t| !before.contains(t)).collect();
        let depths: Vec<f64> = new.iter().map(|&t| motion.depth(t)).collect();
        assert!(depths.len() == 2, "{depths:?}");
        assert!((depths[0] - 3.0).abs() < 1e-12 && (depths[1] - 27.93).abs() < 1e-12);
        assert!(new[0] < motion.time_load && new[1] > motion.time_load);
    }

    #[test]
    fn a_touchdown_ends_a_step_and_the_next_ones_are_short() {
        let mut control = StepControl::new(8.0, 8.0, vec![1000.0]);
        control.end_at_touchdown(0.25);
        assert_eq!(control.planned(), 2.0);
        assert!(control.has_touched_down(2.0) && !control.has_touched_down(0.8));
        assert_eq!(control.accepted(2.0, 2.0, 6), 8.0);
        assert!(!control.has_touched_down(2.0));
        control.start_anew(2.0);
        assert_eq!(control.planned(), 1.6);
    }

    #[test]
    fn a_refused_solve_shortens_the_steps_after_it() {
        let mut control = StepControl::new(8.0, 9.0, vec![1000.0]);
        assert_eq!(control.accepted(2.0, 2.0, 6), 2.0);
        assert_eq!(control.accepted(4.0, 2.0, 6), 2.0);
        assert_eq!(control.accepted(6.0, 2.0, 6), 2.0);
        assert_eq!(control.accepted(8.0, 2.0, 6), 3.0);
        assert_eq!(control.accepted(11.0, 3.0, 25), 2.0);
    }
}
