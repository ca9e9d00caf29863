//! Two paths as one value: the folders of two runs.

use super::kind::{Kind, Problem};

const NONE: &str = "none";

/// Two paths with a comma between, or none.
pub(crate) struct TwoPaths;

impl Kind for TwoPaths {
    type Value = Option<[String; 2]>;

    fn parse(&self, text: &str) -> Result<Self::Value, Problem> {
        if text == NONE {
            return Ok(None);
        }
        if text.contains('\0') {
            return Err("a path cannot contain a zero byte");
        }
        let paths: Vec<&str> = text.split(',').map(str::trim).collect();
        match paths[..] {
            ["", _] | [_, ""] => Err("a path is missing beside the comma"),
            [one, other] => Ok(Some([one.to_owned(), other.to_owned()])),
            _ => Err("these are not two paths with a comma between"),
        }
    }

    fn show(&self, value: &Self::Value) -> String {
        value
            .as_ref()
            .map_or_else(|| NONE.to_owned(), |paths| paths.join(","))
    }

    fn noun(&self) -> &'static str {
        "two output folders"
    }

    fn allowed(&self) -> String {
        format!("path,path without spaces, or {NONE}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_paths_stand_on_both_sides_of_a_comma() {
        let pair = Some(["a".to_owned(), "b/c".to_owned()]);
        assert_eq!(TwoPaths.parse("a,b/c"), Ok(pair.clone()));
        assert_eq!(TwoPaths.show(&pair), "a,b/c");
        assert_eq!(TwoPaths.parse("none"), Ok(None));
        for text in ["", "a", "a,", ",b", ",", "a,b,c"] {
            assert!(TwoPaths.parse(text).is_err(), "{text}");
        }
    }
}
