//! What the terminal shows while a run goes on: a header, one line per accepted step, a banner at the end.

use std::collections::VecDeque;
use std::io::Write;
use std::time::{Duration, Instant};

use super::StepRecord;
use crate::tool::PunchMotion;

/// Width of the banners, characters.
const WIDTH: usize = 80;
/// Steps whose speed tells how long the rest will take.
const RECENT: usize = 20;

/// The header above the step lines, without a line break.
pub fn header() -> String {
    format!(
        "{:>7} {:>7}  {:>9}  {:>9}  {:>9}  {:>8}  {:>6}  {:>6}  {:>9}",
        "done", "left", "t ms", "stroke mm", "force N", "dt ms", "Newton", "active", "gap A mm"
    )
}

/// The line of one accepted step, without a line break: `done` is the share of the punch's way, `left` the time the rest
/// will take if that is known.
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

/// How much of the punch's way is done, and how long the rest will take at the speed of the last steps. Steps shorten
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
            .map_or(0.0, |(_, way)| way / self.whole())
    }

    fn left(&self) -> Option<Duration> {
        let ((start, from), (end, to)) = (self.recent.front()?, self.recent.back()?);
        let speed = (to - from) / end.duration_since(*start).as_secs_f64();
        Duration::try_from_secs_f64((self.whole() - to) / speed).ok()
    }
}

/// The banner of a run that computed everything asked for. `facts` are shown as aligned pairs. Ends with a line break.
pub fn finished_banner(title: &str, facts: &[(&str, String)]) -> String {
    banner('=', &format!("FINISHED: {title}"), facts)
}

/// The banner of a run that did not: `place` says where (time, stroke, step), `reason` why. It cannot be mistaken for
/// the other one. Ends with a line break.
pub fn failed_banner(place: &str, reason: &str, facts: &[(&str, String)]) -> String {
    let mut all = vec![("where", place.to_owned()), ("why", reason.to_owned())];
    all.extend(facts.iter().cloned());
    banner('#', "FAILED: the run did not finish", &all)
}

/// The banner of a run that was ended before its end, and can go on: `place` says where, `reason` why, `resume` how.
/// Ends with a line break.
pub fn interrupted_banner(
    place: &str,
    reason: &str,
    resume: &str,
    facts: &[(&str, String)],
) -> String {
    let mut all = vec![
        ("where", place.to_owned()),
        ("why", reason.to_owned()),
        ("resume", resume.to_owned()),
    ];
    all.extend(facts.iter().cloned());
    banner(
        '~',
        "INTERRUPTED: the run is not finished and can go on",
        &all,
    )
}

fn banner(frame: char, title: &str, facts: &[(&str, String)]) -> String {
    let rule = frame.to_string().repeat(WIDTH);
    let names = facts
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut text = format!("{rule}\n{frame}  {title}\n");
    for (name, value) in facts {
        // The value keeps to its own column also where it takes several lines.
        for (index, line) in wrap(value, WIDTH.saturating_sub(names + 6))
            .iter()
            .enumerate()
        {
            let name = if index == 0 { name } else { "" };
            text.push_str(&format!("{frame}  {name:<names$}  {line}\n"));
        }
    }
    text + &rule + "\n"
}

/// Breaks at spaces; a word longer than a line stays whole.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > width {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

/// Writes the lines above on rank 0 and nothing on the others.
///
/// A terminal that went away must not end a run, so failures to write are ignored; everything shown is in the files.
pub struct Monitor<W: Write> {
    out: Option<W>,
    progress: Progress,
}

impl<W: Write> Monitor<W> {
    /// A monitor of rank `rank` for a run along `motion`. `out` may be a `&mut dyn Write`.
    pub fn new(rank: i32, out: W, motion: PunchMotion) -> Self {
        Self {
            out: (rank == 0).then_some(out),
            progress: Progress {
                motion,
                recent: VecDeque::new(),
            },
        }
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
            let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
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
    fn the_time_left_follows_the_way_and_not_the_time_of_the_motion() {
        let start = Instant::now();
        let mut progress = Progress {
            motion: MOTION,
            recent: VecDeque::new(),
        };
        assert_eq!(progress.left(), None);
        progress.take(0.0, start);
        // Half of the way down in 10 s: 14.25 of 31.35 mm.
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

    #[test]
    fn a_failed_run_says_where_and_why_within_the_width() {
        let reason = "Newton's iteration diverged 12 times in a row while the step shrank from 5 ms to 0.001 ms; \
                      the last attempt ended with a residual of 3.2e-4 mm.";
        let text = failed_banner("step 311, t = 612.3 ms, stroke 19.39 mm", reason, &[]);
        assert!(
            text.contains("FAILED")
                && text.contains("where  step 311")
                && text.contains("why    Newton's")
        );
        assert!(
            text.lines()
                .all(|line| line.starts_with('#') && line.chars().count() <= WIDTH),
            "{text}"
        );
        let good = finished_banner("4 of 4 hold", &[("steps", "191".into())]);
        assert!(good.contains("FINISHED: 4 of 4 hold") && !good.contains('#'));
    }
}
