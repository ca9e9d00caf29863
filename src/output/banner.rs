//! The last words of a run: a frame that shows from afar how it ended, a headline, and facts.

use super::summary::Status;
use crate::text::{COLUMNS as WIDTH, wrapped};

/// The character of the frame.
fn frame(status: Status) -> char {
    match status {
        Status::Finished => '=',
        Status::NotConverged => '#',
        Status::Interrupted => '~',
    }
}

/// The banner of a run that ended so, with facts as aligned pairs of name and text. Ends with a line break.
pub fn banner(status: Status, headline: &str, facts: &[(&str, String)]) -> String {
    let frame = frame(status);
    let rule = frame.to_string().repeat(WIDTH);
    let names = facts
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let mut text = format!("{rule}\n{frame}  {headline}\n");
    for (name, value) in facts {
        // The value keeps to its own column also where it takes several lines.
        for (index, line) in wrapped(value, WIDTH.saturating_sub(names + 6))
            .iter()
            .enumerate()
        {
            let name = if index == 0 { name } else { "" };
            text.push_str(&format!("{frame}  {name:<names$}  {line}\n"));
        }
    }
    text + &rule + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_reason_keeps_to_its_column_and_the_width() {
        let reason = "Newton's iteration diverged 12 times in a row while the step shrank from 5 ms to 0.001 ms; \
                      the last attempt ended with a residual of 3.2e-4 mm.";
        let facts = [
            (
                "where",
                "step 311, t = 612.3 ms, stroke 19.39 mm".to_owned(),
            ),
            ("why", reason.to_owned()),
        ];
        let text = banner(Status::NotConverged, "FAILED", &facts);
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
        let good = banner(Status::Finished, "FINISHED", &[("steps", "191".into())]);
        assert!(good.contains("FINISHED") && !good.contains('#'));
    }
}
