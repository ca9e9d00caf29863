//! What the terminal shows while a run goes on, and the log of it: a header, and one line per accepted step.

use std::collections::VecDeque;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use super::{OutputError, StepRecord};
use crate::text::fitted;
use crate::tool::PunchMotion;

/// Steps whose speed is that of the rest.
const RECENT: usize = 20;
/// Steps, and share of the way, before which the time left is not estimated.
const LEAST_STEPS: usize = 10;
const LEAST_SHARE: f64 = 0.1;

/// The header above the step lines, without a line break.
pub fn header() -> String {
    format!(
        "{:>6} {:>7} {:>8} {:>9} {:>8} {:>7} {:>6} {:>6} {:>8} {:>5}",
        "done",
        "left",
        "t ms",
        "stroke mm",
        "force N",
        "dt ms",
        "Newton",
        "active",
        "gap A mm",
        "tries"
    )
}

/// The line of one accepted step, without a line break: `done` is the share of the punch's travel, `left` the time the
/// rest will take if that is known, and the last number counts the solves it took, those refused included.
pub fn step_line(record: &StepRecord, done: f64, left: Option<Duration>) -> String {
    let left = left.map_or_else(String::new, clock);
    format!(
        "{:>5}% {left:>7} {:>8} {:>9} {:>8} {:>7} {:>6} {:>6} {:>8} {:>5}",
        decimal(100.0 * done, 1, 5),
        decimal(record.t_ms, 3, 8),
        decimal(record.stroke_mm, 4, 9),
        decimal(record.force_N, 3, 8),
        decimal(record.dt_ms, 4, 7),
        record.newton_iterations,
        record.active_points,
        decimal(record.gap_A_mm, 5, 8),
        record.refused_solves + 1,
    )
}

/// The value with as many of these decimals as the width leaves room for.
fn decimal(value: f64, most: usize, width: usize) -> String {
    (0..=most)
        .rev()
        .map(|decimals| format!("{value:.decimals$}"))
        .find(|text| text.len() <= width)
        .unwrap_or_else(|| format!("{value:.1e}"))
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
    /// Travel where the clock began, mm.
    from: f64,
    /// When the last steps ended, and how far the punch had gone, mm.
    recent: VecDeque<(Instant, f64)>,
}

impl Progress {
    fn new(motion: PunchMotion) -> Self {
        Self {
            motion,
            from: 0.0,
            recent: VecDeque::new(),
        }
    }

    fn whole(&self) -> f64 {
        self.motion.travel(self.motion.end())
    }

    /// Starts the clock at `t` (ms), now.
    fn start(&mut self, t: f64, now: Instant) {
        self.from = self.motion.travel(t);
        self.recent.clear();
        self.take(t, now);
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

    /// None before there is something to judge by: the first steps are shorter than the rest, and they are few.
    fn left(&self) -> Option<Duration> {
        let ((start, from), (end, to)) = (self.recent.front()?, self.recent.back()?);
        let share = (to - self.from) / (self.whole() - self.from);
        if self.recent.len() <= LEAST_STEPS || share < LEAST_SHARE {
            return None;
        }
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
    quiet: bool,
    progress: Progress,
}

impl<W: Write> Monitor<W> {
    /// A monitor of rank `rank` for a run along `motion`. `out` may be a `&mut dyn Write`.
    pub fn new(rank: i32, out: W, motion: PunchMotion) -> Self {
        Self {
            out: (rank == 0).then_some(out),
            log: None,
            quiet: false,
            progress: Progress::new(motion),
        }
    }

    /// Shows only what is told from now on ([`Monitor::tell`]); the log has everything.
    pub fn be_quiet(&mut self) {
        self.quiet = true;
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
        self.progress.start(t, Instant::now());
        self.show(&(header() + "\n"));
    }

    /// Shows [`step_line`].
    pub fn step(&mut self, record: &StepRecord) {
        self.progress.take(record.t_ms, Instant::now());
        let line = step_line(record, self.progress.done(), self.progress.left());
        self.show(&(line + "\n"));
    }

    /// Shows any other text, broken where it is wider than a terminal.
    pub fn show(&mut self, text: &str) {
        self.put(text, !self.quiet);
    }

    /// As [`Monitor::show`], also to who asked for quiet: warnings, verdicts and last words.
    pub fn tell(&mut self, text: &str) {
        self.put(text, true);
    }

    fn put(&mut self, text: &str, on_screen: bool) {
        let text = fitted(text);
        if let Some(out) = self.out.as_mut().filter(|_| on_screen) {
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
    fn step_lines_stand_under_their_header_and_fit_a_terminal() {
        let line = step_line(&record(), 0.5, Some(Duration::from_secs(83)));
        assert_eq!(
            header(),
            "  done    left     t ms stroke mm  force N   dt ms Newton active gap A mm tries"
        );
        assert_eq!(
            line,
            " 50.0%    1:23  450.000   14.2500  168.123  2.5000      5     42  0.00125     3"
        );
        let wide = StepRecord {
            t_ms: 123_456.789,
            stroke_mm: 1e5,
            force_N: -1e7,
            dt_ms: 12_345.0,
            gap_A_mm: -99.5,
            newton_iterations: 1000,
            active_points: 100_000,
            refused_solves: 998,
            ..StepRecord::default()
        };
        let line = step_line(&wide, 1.0, Some(Duration::from_secs(99 * 3600)));
        assert!(line.chars().count() <= 80, "{line}");
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
        let mut progress = Progress::new(MOTION);
        progress.start(0.0, start);
        for step in 1_u64..=10 {
            // Half of the travel down in 10 s: 14.25 of 31.35 mm.
            assert_eq!(progress.left(), None);
            progress.take(45.0 * step as f64, start + Duration::from_secs(step));
        }
        assert!((progress.done() - 14.25 / 31.35).abs() < 1e-12);
        assert_eq!(clock(progress.left().unwrap()), "0:12");
        progress.take(1000.0, start + Duration::from_secs(20));
        assert_eq!(progress.left(), Some(Duration::ZERO));
        assert_eq!(clock(Duration::from_secs(3723)), "1:02:03");
    }

    #[test]
    fn no_time_left_is_named_in_the_first_tenth_of_the_way_also_after_a_restart() {
        let start = Instant::now();
        let mut progress = Progress::new(MOTION);
        for (from, step) in [(0.0, 9.0), (700.0, 2.0)] {
            progress.start(from, start);
            let way = MOTION.travel(1000.0) - MOTION.travel(from);
            for count in 1_u32..=30 {
                let t = from + step * f64::from(count);
                progress.take(t, start + Duration::from_secs(u64::from(count)));
                let share = (MOTION.travel(t) - MOTION.travel(from)) / way;
                assert_eq!(
                    progress.left().is_some(),
                    share >= 0.1 && count >= 10,
                    "{t}"
                );
            }
        }
    }

    #[test]
    fn quiet_shows_what_is_told_only() {
        let mut shown = Vec::new();
        let mut monitor = Monitor::new(0, &mut shown as &mut dyn Write, MOTION);
        monitor.be_quiet();
        monitor.header(0.0);
        monitor.step(&record());
        monitor.show("more\n");
        monitor.tell("the end\n");
        assert_eq!(shown, b"the end\n");
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
