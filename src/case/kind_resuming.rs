//! Two kinds of values for stopping and resuming: a time on the clock, and a checkpoint.

use super::kind::{Kind, Problem};
use super::model::Restart;
use crate::text::show_real;

/// A time on the clock in seconds, or none.
pub(crate) struct WallTime;

const NONE: &str = "none";
/// A century.
const GREATEST: f64 = 3.2e9;

impl Kind for WallTime {
    type Value = Option<f64>;

    fn parse(&self, text: &str) -> Result<Option<f64>, Problem> {
        const SHAPE: Problem = "this is neither seconds nor hours:minutes:seconds";
        if text == NONE {
            return Ok(None);
        }
        let parts: Vec<&str> = text.split(':').collect();
        let (whole, seconds) = match parts[..] {
            [seconds] => (0.0, seconds),
            [hours, minutes, seconds] => {
                let hours: u32 = hours.parse().map_err(|_| SHAPE)?;
                let minutes: u32 = minutes.parse().map_err(|_| SHAPE)?;
                if minutes >= 60 {
                    return Err("an hour has 60 minutes");
                }
                (
                    3600.0 * f64::from(hours) + 60.0 * f64::from(minutes),
                    seconds,
                )
            }
            _ => return Err(SHAPE),
        };
        let seconds: f64 = seconds.parse().map_err(|_| SHAPE)?;
        if parts.len() == 3 && !(0.0..60.0).contains(&seconds) {
            return Err("a minute has 60 seconds");
        }
        let time = whole + seconds;
        if time > 0.0 && time <= GREATEST {
            Ok(Some(time))
        } else {
            Err("the value is out of range")
        }
    }

    fn show(&self, value: &Option<f64>) -> String {
        value.map_or_else(|| NONE.to_owned(), show_real)
    }

    fn noun(&self) -> &'static str {
        "a time on the clock"
    }

    fn allowed(&self) -> String {
        "seconds or h:m:s > 0, or none".to_owned()
    }
}

/// Whether to go on from a checkpoint, and which.
pub(crate) struct Restarting;

impl Kind for Restarting {
    type Value = Restart;

    fn parse(&self, text: &str) -> Result<Restart, Problem> {
        match text {
            "no" | "false" | "0" | "off" => Ok(Restart::No),
            "" | "newest" | "yes" | "true" | "1" | "on" => Ok(Restart::Newest),
            _ if text.contains('\0') => Err("a path cannot contain a zero byte"),
            path => Ok(Restart::From(path.to_owned())),
        }
    }

    fn show(&self, value: &Restart) -> String {
        match value {
            Restart::No => "no".to_owned(),
            Restart::Newest => "newest".to_owned(),
            Restart::From(path) => path.clone(),
        }
    }

    fn noun(&self) -> &'static str {
        "a word or a path"
    }

    fn allowed(&self) -> String {
        "no, newest, or a path".to_owned()
    }

    fn value_may_be_missing(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_seconds_or_hours_minutes_and_seconds() {
        for (text, seconds) in [
            ("90", 90.0),
            ("0.5", 0.5),
            ("1:02:03", 3723.0),
            ("0:00:07.5", 7.5),
        ] {
            assert_eq!(WallTime.parse(text), Ok(Some(seconds)), "{text}");
        }
        assert_eq!(WallTime.parse("none"), Ok(None));
        for text in [
            "", "0", "-5", "1:2", "1:60:00", "1:00:60", "1:00:-1", "x", "1:2:3:4", "inf", "NaN",
        ] {
            assert!(WallTime.parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_bare_restart_means_the_newest() {
        assert_eq!(Restarting.parse(""), Ok(Restart::Newest));
        assert_eq!(Restarting.parse("no"), Ok(Restart::No));
        let path = "results/checkpoint-000123";
        assert_eq!(Restarting.parse(path), Ok(Restart::From(path.to_owned())));
    }
}
