//! Every command in README.md and docs/using.md is run as it stands there, in a copy of the files it needs.
//!
//! In the copy the program is a wrapper that appends [`SHORTER`] to what it is given, and `cargo build` finds everything
//! built. A command that cannot run in a test is named in the document, with the reason:
//! `<!-- untested: BEGINNING OF THE COMMAND: REASON -->`.

mod program;

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use program::{FEW_CORES, scratch};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const DOCUMENTS: [&str; 2] = ["README.md", "docs/using.md"];

/// Makes every case small: two millimetres of the same problem on a coarse mesh.
const SHORTER: &str =
    "-sheet_nx 20 -sheet_ny 2 -stroke 0.2 -time_load 6.4 -time_unload 1 -output_every 0";

/// A piece of shell script from a document.
struct Block {
    /// Line of the document.
    line: usize,
    commands: Vec<String>,
}

/// The indented blocks and those fenced with ```sh. Other fences hold no commands.
fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut fence, mut open) = (None, false);
    for (content, line) in text.lines().zip(1..) {
        if let Some(language) = content.strip_prefix("```") {
            fence = if fence.is_some() {
                None
            } else {
                Some(language)
            };
            open = false;
            continue;
        }
        let command = match fence {
            Some(language) => (language == "sh").then_some(content),
            None => content.strip_prefix("    "),
        };
        match command {
            Some(command) if open => blocks.last_mut().unwrap().commands.push(command.to_owned()),
            Some(command) => blocks.push(Block {
                line,
                commands: vec![command.to_owned()],
            }),
            None => {}
        }
        open = command.is_some();
    }
    blocks
}

/// What is not run: how the command begins, and why.
fn untested(text: &str) -> Vec<(&str, &str)> {
    let mark = |line: &'_ str| -> Option<(usize, usize)> {
        let inner = line.strip_prefix("<!-- untested: ")?.strip_suffix(" -->")?;
        Some((inner.find(": ")?, inner.len()))
    };
    text.lines()
        .filter(|line| line.starts_with("<!-- untested"))
        .map(|line| {
            let (colon, length) = mark(line).unwrap_or_else(|| panic!("{line}: no reason"));
            let inner = &line["<!-- untested: ".len()..][..length];
            (&inner[..colon], &inner[colon + 2..])
        })
        .collect()
}

fn write_program(path: &Path, script: &str) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, format!("#!/bin/bash\n{script}\n")).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// A copy of what the commands use, with the wrapper in the place of the program.
fn copy() -> std::path::PathBuf {
    let folder = scratch("docs-commands");
    for name in ["scripts", "inputs"] {
        let copied = Command::new("cp")
            .args(["-r", &format!("{ROOT}/{name}")])
            .arg(&folder)
            .status();
        assert!(copied.unwrap().success());
    }
    write_program(
        &folder.join("target/release/ssnp155"),
        &format!("exec {} \"$@\" {SHORTER}", env!("CARGO_BIN_EXE_ssnp155")),
    );
    write_program(
        &folder.join("bin/cargo"),
        "[ \"$1\" = build ] || { echo \"cargo $* is not for this test\"; exit 1; }",
    );
    folder
}

#[test]
fn every_command_of_the_documents_works() {
    let folder = copy();
    let path = format!(
        "{}:{}",
        folder.join("bin").display(),
        std::env::var("PATH").unwrap()
    );
    let (mut run, mut wrong) = (0, Vec::new());
    for document in DOCUMENTS {
        let text = std::fs::read_to_string(Path::new(ROOT).join(document)).unwrap();
        let untested = untested(&text);
        for (beginning, reason) in &untested {
            assert!(!reason.trim().is_empty());
            let used = |block: &Block| block.commands.iter().any(|c| c.starts_with(beginning));
            assert!(
                blocks(&text).iter().any(used),
                "{document}: '{beginning}' is not there any more"
            );
        }
        for block in blocks(&text) {
            let place = format!("{document}, line {}", block.line);
            for word in block.commands.iter().flat_map(|c| c.split_whitespace()) {
                let ours = word.starts_with("scripts/") || word.starts_with("inputs/");
                if ours && !Path::new(ROOT).join(word).exists() {
                    wrong.push(format!("{place}: {word} does not exist"));
                }
            }
            let kept: Vec<String> = block
                .commands
                .into_iter()
                .filter(|command| !untested.iter().any(|(start, _)| command.starts_with(start)))
                .collect();
            run += kept.len();
            let ended = Command::new("timeout")
                .args(["-k", "5", "120", "bash", "-e", "-c", &kept.join("\n")])
                .env("PATH", &path)
                .env_remove("CARGO_TARGET_DIR")
                .envs(FEW_CORES)
                .current_dir(&folder)
                .output()
                .unwrap();
            if !ended.status.success() {
                wrong.push(format!(
                    "{place}: {} ended with {}\n{}\n{}",
                    kept.join("; "),
                    ended.status,
                    String::from_utf8_lossy(&ended.stdout),
                    String::from_utf8_lossy(&ended.stderr)
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(run >= 20, "only {run} commands were found");
}

#[test]
fn blocks_are_found_as_they_are_written() {
    let text = "text\n\n    one\n    two\n\n    three\n```text\nnot this\n```\n```sh\nfour\n```\n<!-- untested: four: why -->\n";
    let found: Vec<Vec<String>> = blocks(text)
        .into_iter()
        .map(|block| block.commands)
        .collect();
    assert_eq!(found, [vec!["one", "two"], vec!["three"], vec!["four"]]);
    assert_eq!(untested(text), [("four", "why")]);
}
