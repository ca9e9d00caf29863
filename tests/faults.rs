//! Runs that are killed, or whose disk is full: what was reached stays, and the run goes on from it to the same end.
//! `scripts/faults.py` does the same many more times.

mod program;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use program::{command, history, run, scratch, send, summary};
use rustix::process::Signal;

const CASE: &str = "-sheet_nx 40 -sheet_ny 2 -stroke 8 -time_load 252 -unload_fraction 0 -report_strokes none \
                    -dt_max 3 -checkpoint_every 4";

fn words<'a>(folder: &'a Path, more: &'a str) -> Vec<&'a str> {
    let mut words: Vec<&str> = CASE.split_whitespace().collect();
    words.extend(more.split_whitespace());
    words.extend(["-output_dir", folder.to_str().unwrap()]);
    words
}

fn rows(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("history.csv")).unwrap_or_default()
}

fn spawn(folder: &Path, ranks: usize, more: &str) -> Child {
    command(ranks, &words(folder, more))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn checkpoints(folder: &Path) -> Vec<PathBuf> {
    ssnp155::output::checkpoint::complete(folder)
}

/// The same places in every run of the test; the seed is shown if it fails.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % end
    }
}

#[test]
fn a_run_killed_again_and_again_comes_to_the_same_end() {
    let folder = scratch("faults-kill");
    let (unbroken, killed) = (folder.join("unbroken"), folder.join("killed"));
    let began = Instant::now();
    assert_eq!(run(1, 120, &words(&unbroken, "")).code, Some(0));
    let whole = began.elapsed().as_millis() as u64;
    const SEED: u64 = 20_155;
    println!("seed {SEED}, whole run {whole} ms");
    let mut random = Random(SEED);
    let mut kills = 0;
    loop {
        let again = !checkpoints(&killed).is_empty();
        let mut child = spawn(&killed, 1, if again { "-restart" } else { "" });
        if kills == 4 {
            assert_eq!(child.wait().unwrap().code(), Some(0));
            break;
        }
        std::thread::sleep(Duration::from_millis(whole / 8 + random.below(whole / 2)));
        if let Some(ended) = child.try_wait().unwrap() {
            assert_eq!(ended.code(), Some(0));
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        for checkpoint in checkpoints(&killed) {
            ssnp155::output::checkpoint::verify(&checkpoint).unwrap();
        }
        // Not a word of an end that there was not: a summary is there only if the kill came while the last figures were
        // drawn, and then everything below must hold.
        if killed.join("summary.json").exists() {
            break;
        }
    }
    assert!(kills > 0);
    assert_eq!(rows(&killed), rows(&unbroken), "{kills} kills");
    assert_eq!(program::fields(&killed), program::fields(&unbroken));
    assert_eq!(summary(&killed)["status"], "finished");
}

/// Processes started by a process.
fn children(of: u32) -> Vec<u32> {
    let path = format!("/proc/{of}/task/{of}/children");
    let text = std::fs::read_to_string(path).unwrap_or_default();
    text.split_whitespace()
        .map(|id| id.parse().unwrap())
        .collect()
}

#[test]
fn one_rank_that_is_killed_ends_them_all() {
    let folder = scratch("faults-rank").join("results");
    let mut child = spawn(&folder, 3, "");
    let began = Instant::now();
    while checkpoints(&folder).is_empty() {
        assert!(began.elapsed() < Duration::from_secs(60), "no checkpoint");
        std::thread::sleep(Duration::from_millis(10));
    }
    let ranks = children(child.id());
    assert_eq!(ranks.len(), 3);
    send(ranks[1], Signal::KILL);
    let ended = child.wait().unwrap();
    assert!(!ended.success(), "{ended}");
    assert!(!folder.join("summary.json").exists());
    let times = history(&folder)["t_ms"].len();
    assert!(times >= 4, "{times} rows");
    let newest = &checkpoints(&folder)[0];
    ssnp155::output::checkpoint::verify(newest).unwrap();
    assert_eq!(run(2, 120, &words(&folder, "-restart")).code, Some(0));
}

/// A file system in memory, gone with the value.
struct SmallDisk(PathBuf);

impl SmallDisk {
    /// None where mounting is not permitted.
    fn mount(at: PathBuf, size: &str) -> Option<Self> {
        std::fs::create_dir_all(&at).unwrap();
        let size = format!("size={size}");
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &size, "tmpfs"])
            .arg(&at)
            .stderr(Stdio::null())
            .status();
        mounted
            .is_ok_and(|status| status.success())
            .then_some(Self(at))
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

/// What is said of a full disk. A collective write that meets one has other words, if any.
const ADVICE: &str =
    "; make room and go on with -restart, or choose another folder with -output_dir";

#[test]
fn a_disk_too_small_to_begin_on_is_refused() {
    let Some(disk) = SmallDisk::mount(scratch("faults-small"), "256k") else {
        println!("SKIPPED: a small file system cannot be mounted here (only root may)");
        return;
    };
    for ranks in [1, 2] {
        let folder = disk.0.join(ranks.to_string());
        let ended = run(ranks, 120, &words(&folder, ""));
        assert_eq!(ended.code, Some(2), "{ranks} ranks: {}", ended.text());
        let told = ended.stderr.lines().filter(|line| line.contains(ADVICE));
        assert_eq!(told.count(), 1, "{}", ended.stderr);
        assert_eq!(rows(&folder), "");
        std::fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn a_full_disk_is_an_error_that_leaves_what_was_there() {
    for (size, checkpoint) in [("1800k", true), ("2600k", false)] {
        let Some(disk) = SmallDisk::mount(scratch("faults-disk"), size) else {
            println!("SKIPPED: a small file system cannot be mounted here (only root may)");
            return;
        };
        for ranks in [1, 2] {
            let folder = disk.0.join(ranks.to_string());
            let more = if checkpoint {
                ""
            } else {
                "-checkpoint_every 0"
            };
            let ended = run(ranks, 120, &words(&folder, more));
            assert_eq!(
                ended.code,
                Some(2),
                "{size}, {ranks} ranks: {}",
                ended.text()
            );
            let last = ended
                .stderr
                .lines()
                .filter(|line| line.starts_with("ssnp155: "));
            let last: Vec<&str> = last.collect();
            assert_eq!(last.len(), 1, "{}", ended.stderr);
            assert!(last[0].contains(folder.to_str().unwrap()), "{}", last[0]);
            assert!(last[0].contains(ADVICE), "{}", last[0]);
            assert!(!ended.says("FINISHED"), "{}", ended.stdout);
            assert!(!folder.join("summary.json").exists());
            let found = checkpoints(&folder);
            assert_eq!(found.is_empty(), !checkpoint, "{size}, {ranks} ranks");
            for path in found {
                ssnp155::output::checkpoint::verify(&path).unwrap();
            }
            let rows = history(&folder)["t_ms"].len();
            let file = hdf5::File::open(folder.join("fields.vtkhdf")).unwrap();
            let steps = file.group("VTKHDF/Steps").unwrap();
            let steps: i64 = steps.attr("NSteps").unwrap().read_scalar().unwrap();
            assert!(
                rows >= 4 && steps >= rows as i64,
                "{rows} rows, {steps} steps"
            );
            drop(file);
            std::fs::remove_dir_all(folder).unwrap();
        }
    }
}
