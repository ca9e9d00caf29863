//! The kinds of values an option can have: how a text is read, and how a value is shown.

use std::ops::{Bound, RangeBounds};

use crate::text::show_real;

/// Why a text is not a value, in words that fit after "option -name text: ".
pub(crate) type Problem = &'static str;

const OUT_OF_RANGE: Problem = "the value is out of range";

/// What values an option can have.
pub(crate) trait Kind {
    /// The Rust type of a value.
    type Value;
    /// The value a text stands for, or what is wrong with it.
    fn parse(&self, text: &str) -> Result<Self::Value, Problem>;
    /// The text of a value; parsing it again gives the same value.
    fn show(&self, value: &Self::Value) -> String;
    /// What kind of value is wanted, as in "a real number".
    fn noun(&self) -> &'static str;
    /// The range or the choices.
    fn allowed(&self) -> String;
    /// Whether the option may stand without a value.
    fn value_may_be_missing(&self) -> bool {
        false
    }
    /// Whether the values are real numbers.
    fn is_real(&self) -> bool {
        false
    }
}

/// A finite real number in an interval.
pub(crate) struct Real(pub(crate) Bound<f64>, pub(crate) Bound<f64>);

impl Real {
    /// 0 < value <= `greatest`.
    pub(crate) const fn positive(greatest: f64) -> Self {
        Real(Bound::Excluded(0.0), Bound::Included(greatest))
    }
}

impl Kind for Real {
    type Value = f64;

    fn parse(&self, text: &str) -> Result<f64, Problem> {
        let value: f64 = text.parse().map_err(|_| {
            let with_e = text.replace(['d', 'D'], "e");
            if with_e != text && with_e.parse::<f64>().is_ok() {
                "the exponent is written with e, as in 1e-3"
            } else if text.replace(',', ".").parse::<f64>().is_ok() {
                "the decimal sign is a point, as in 28.5"
            } else {
                "this is not a number"
            }
        })?;
        if !value.is_finite() {
            return Err("the number is not finite");
        }
        if (self.0, self.1).contains(&value) {
            Ok(value)
        } else {
            Err(OUT_OF_RANGE)
        }
    }

    fn show(&self, value: &f64) -> String {
        show_real(*value)
    }

    fn noun(&self) -> &'static str {
        "a real number"
    }

    fn allowed(&self) -> String {
        let lower = match self.0 {
            Bound::Included(bound) => format!("{} <= ", show_real(bound)),
            Bound::Excluded(bound) => format!("{} < ", show_real(bound)),
            Bound::Unbounded => String::new(),
        };
        let upper = match self.1 {
            Bound::Included(bound) => format!(" <= {}", show_real(bound)),
            Bound::Excluded(bound) => format!(" < {}", show_real(bound)),
            Bound::Unbounded => String::new(),
        };
        format!("{lower}value{upper}")
    }

    fn is_real(&self) -> bool {
        true
    }
}

/// A whole number in a closed interval.
pub(crate) struct Integer(pub(crate) usize, pub(crate) usize);

impl Kind for Integer {
    type Value = usize;

    fn parse(&self, text: &str) -> Result<usize, Problem> {
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err("this is not a whole number");
        }
        match text.parse() {
            Ok(value) if (self.0..=self.1).contains(&value) => Ok(value),
            _ => Err(OUT_OF_RANGE),
        }
    }

    fn show(&self, value: &usize) -> String {
        value.to_string()
    }

    fn noun(&self) -> &'static str {
        "a whole number"
    }

    fn allowed(&self) -> String {
        format!("{} <= value <= {}", self.0, self.1)
    }
}

/// Finite real numbers with commas between, each 0 < number <= a greatest one; the word none means an empty list.
pub(crate) struct List(pub(crate) f64);

const EMPTY_LIST: &str = "none";

impl Kind for List {
    type Value = Vec<f64>;

    fn parse(&self, text: &str) -> Result<Vec<f64>, Problem> {
        if text == EMPTY_LIST {
            return Ok(Vec::new());
        }
        let number = Real::positive(self.0);
        text.split(',')
            .map(|part| match part.trim() {
                "" => Err("a number is missing between the commas"),
                part => number.parse(part),
            })
            .collect()
    }

    fn show(&self, value: &Vec<f64>) -> String {
        if value.is_empty() {
            return EMPTY_LIST.to_owned();
        }
        let numbers: Vec<String> = value.iter().map(|number| show_real(*number)).collect();
        numbers.join(",")
    }

    fn noun(&self) -> &'static str {
        "real numbers with commas between and no spaces"
    }

    fn allowed(&self) -> String {
        format!("0 < each <= {}, or {EMPTY_LIST}", show_real(self.0))
    }
}

/// One of a few words.
pub(crate) struct Choice<T: 'static>(pub(crate) &'static [(&'static str, T)]);

impl<T: Copy + PartialEq> Kind for Choice<T> {
    type Value = T;

    fn parse(&self, text: &str) -> Result<T, Problem> {
        self.0
            .iter()
            .find(|(word, _)| *word == text)
            .map(|(_, value)| *value)
            .ok_or("this is none of the choices")
    }

    fn show(&self, value: &T) -> String {
        self.0
            .iter()
            .find(|(_, known)| known == value)
            .map(|(word, _)| (*word).to_owned())
            .unwrap_or_default()
    }

    fn noun(&self) -> &'static str {
        "one of the words"
    }

    fn allowed(&self) -> String {
        self.0
            .iter()
            .map(|(word, _)| *word)
            .collect::<Vec<_>>()
            .join(" or ")
    }
}

/// A path; what it points to is checked where it is read.
pub(crate) struct Path;

impl Kind for Path {
    type Value = String;

    fn parse(&self, text: &str) -> Result<String, Problem> {
        if text.contains('\0') {
            Err("a path cannot contain a zero byte")
        } else {
            Ok(text.to_owned())
        }
    }

    fn show(&self, value: &String) -> String {
        value.clone()
    }

    fn noun(&self) -> &'static str {
        "a path"
    }

    fn allowed(&self) -> String {
        "path".to_owned()
    }
}

/// On or off, in PETSc's words; the bare option means on.
pub(crate) struct Flag;

impl Kind for Flag {
    type Value = bool;

    fn parse(&self, text: &str) -> Result<bool, Problem> {
        match text.to_ascii_lowercase().as_str() {
            "" | "1" | "true" | "yes" | "on" => Ok(true),
            "0" | "false" | "no" | "off" => Ok(false),
            _ => Err("this is neither true nor false"),
        }
    }

    fn show(&self, value: &bool) -> String {
        value.to_string()
    }

    fn noun(&self) -> &'static str {
        "one of the words"
    }

    fn allowed(&self) -> String {
        "true or false".to_owned()
    }

    fn value_may_be_missing(&self) -> bool {
        true
    }
}
