//! What the terminal shows while a run goes on, and the log of it: a header, and one line per accepted step.

use std::collections::VecDeque;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use super::{OutputError, StepRecord};
use crate::tool::PunchMotion;

/// Steps whose speed is that of the rest.
const RECENT: usize = 20;

/// The header above the step lines, without a line break.
pub fn header() -> String {
    format!(
        "{:>7} {:>7}  {:>9}  {:>9}  {:>9}  {:>8}  {:>6}  {:>6}  {:>9}",
        "done", "left", "t ms", "stroke mm", "force N", "dt ms", "Newton", "active", "gap A mm"
    )
}

/// The line of one accepted step, without a line break: `done` is the share of the punch's travel, `left` the time the
/// rest will take if that is known.
pub fn step_line(record: &StepRecord, done: f64, left: Option<Duration>) -> String {
    let share = 100.0 * done;
    let left = left.map_or_else(String::new, clock);
    let refused = match record.refused_solves {
        0 => String::new(),
        count => format!("  {count} refused"),
    };
    format!(
        "{share:>5.1} % {left:>7}  {:>9.3}  {:>9.4}  {:>9.3}  {:>8.4}  {:>6}  {:>6}  {:>9.5}{refused}",
        record.t_ms,
        record.stroke_mm,
        record.force_N,
        record.dt_ms,
        record.newton_iterations,
        record.active_points,
        record.gap_A_mm,
    )
}

/// A time as h:mm:ss or m:ss.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

/// How much of the punch's travel is done, and how long the rest will take at the speed of the last steps. Steps shorten
/// where the solution is hard, so it is an estimate and no promise.
struct Progress {
    motion: PunchMotion,
    /// When the last steps ended, and how far the punch had gone, mm.
    recent: VecDeque<(Instant, f64)>,
}

impl Progress {
    fn whole(&self) -> f64 {
        self.motion.travel(self.motion.end())
    }

    /// Takes a step that ended at `t` (ms), now.
    fn take(&mut self, t: f64, now: Instant) {
        if self.recent.len() > RECENT {
            self.recent.pop_front();
        }
        self.recent.push_back((now, self.motion.travel(t)));
    }

    fn done(&self) -> f64 {
        self.recent
            .back()
            .map_or(0.0, |(_, travel)| travel / self.whole())
    }

    fn left(&self) -> Option<Duration> {
        let ((start, from), (end, to)) = (self.recent.front()?, self.recent.back()?);
        let speed = (to - from) / end.duration_since(*start).as_secs_f64();
        Duration::try_from_secs_f64((self.whole() - to) / speed).ok()
    }
}

/// Writes the lines above on rank 0 and nothing on the others.
///
/// A terminal or a pipe that went away must not end a run: after a failure to write nothing more is shown, and the log
/// goes on.
pub struct Monitor<W: Write> {
    out: Option<W>,
    log: Option<File>,
    progress: Progress,
}

impl<W: Write> Monitor<W> {
    /// A monitor of rank `rank` for a run along `motion`. `out` may be a `&mut dyn Write`.
    pub fn new(rank: i32, out: W, motion: PunchMotion) -> Self {
        Self {
            out: (rank == 0).then_some(out),
            log: None,
            progress: Progress {
                motion,
                recent: VecDeque::new(),
            },
        }
    }

    /// Writes everything that is shown from now on to a file too: behind what it holds if the run is `resumed`, else in
    /// its place. To be called on rank 0 only.
    ///
    /// # Errors
    /// [`OutputError::Write`] if the file cannot be made.
    pub fn log_to(&mut self, path: &Path, resumed: bool) -> Result<(), OutputError> {
        let mut options = OpenOptions::new();
        options
            .create(true)
            .append(resumed)
            .truncate(!resumed)
            .write(true);
        let log = options.open(path);
        self.log = Some(log.map_err(|error| OutputError::write(path, error))?);
        Ok(())
    }

    /// Shows nothing any more; the log goes on.
    pub fn silence(&mut self) {
        self.out = None;
    }

    /// Shows [`header`]; from now on the clock runs for a run that is at time `t` (ms).
    pub fn header(&mut self, t: f64) {
        self.progress.take(t, Instant::now());
        self.show(&(header() + "\n"));
    }

    /// Shows [`step_line`].
    pub fn step(&mut self, record: &StepRecord) {
        self.progress.take(record.t_ms, Instant::now());
        let line = step_line(record, self.progress.done(), self.progress.left());
        self.show(&(line + "\n"));
    }

    /// Shows any other text, a banner or the verdict table for example, as it is.
    pub fn show(&mut self, text: &str) {
        if let Some(out) = &mut self.out {
            let shown = out.write_all(text.as_bytes()).and_then(|()| out.flush());
            if shown.is_err() {
                self.out = None;
            }
        }
        if let Some(log) = &mut self.log {
            // A full disk ends the run at the table's next row.
            let _ = log.write_all(text.as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> StepRecord {
        StepRecord {
            t_ms: 450.0,
            stroke_mm: 14.25,
            force_N: 168.123,
            dt_ms: 2.5,
            newton_iterations: 5,
            active_points: 42,
            gap_A_mm: 1.25e-3,
            refused_solves: 2,
            ..StepRecord::default()
        }
    }

    #[test]
    fn step_lines_stand_under_their_header() {
        let line = step_line(&record(), 0.5, Some(Duration::from_secs(83)));
        assert_eq!(
            header(),
            "   done    left       t ms  stroke mm    force N     dt ms  Newton  active   gap A mm"
        );
        assert_eq!(
            line,
            " 50.0 %    1:23    450.000    14.2500    168.123    2.5000       5      42    0.00125  2 refused"
        );
    }

    const MOTION: PunchMotion = PunchMotion {
        stroke: 28.5,
        unload_fraction: 0.1,
        time_load: 900.0,
        time_unload: 100.0,
    };

    #[test]
    fn the_time_left_follows_the_travel_and_not_the_time_of_the_motion() {
        let start = Instant::now();
        let mut progress = Progress {
            motion: MOTION,
            recent: VecDeque::new(),
        };
        assert_eq!(progress.left(), None);
        progress.take(0.0, start);
        // Half of the travel down in 10 s: 14.25 of 31.35 mm.
        progress.take(450.0, start + Duration::from_secs(10));
        assert!((progress.done() - 14.25 / 31.35).abs() < 1e-12);
        assert_eq!(clock(progress.left().unwrap()), "0:12");
        progress.take(1000.0, start + Duration::from_secs(20));
        assert_eq!(progress.left(), Some(Duration::ZERO));
        assert_eq!(clock(Duration::from_secs(3723)), "1:02:03");
    }

    #[test]
    fn only_rank_0_shows_anything() {
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for (rank, out) in [(0, &mut first), (1, &mut second)] {
            let mut monitor = Monitor::new(rank, out as &mut dyn Write, MOTION);
            monitor.header(0.0);
            monitor.step(&record());
        }
        assert_eq!(first.iter().filter(|&&byte| byte == b'\n').count(), 2);
        assert!(second.is_empty());
    }
}
