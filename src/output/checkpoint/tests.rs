//! Checkpoints without a run: which are kept, and that damage is found wherever it is.

use super::manifest::{LAST_LINE, TITLE};
use super::*;

const FILES: [(&str, usize); 3] = [("state.h5", 5000), ("history.csv", 700), ("empty", 0)];

fn scratch(name: &str) -> PathBuf {
    let name = format!("ssnp155-checkpoint-{name}-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Numbers without a pattern (Marsaglia's xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

fn make(folder: &Path, step: u64) -> PathBuf {
    let mut random = Random(step + 1);
    write(folder, step, |to| {
        for (name, size) in FILES {
            let bytes: Vec<u8> = (0..size).map(|_| random.below(256) as u8).collect();
            fs::write(to.join(name), bytes).unwrap();
        }
        Ok(())
    })
    .unwrap();
    path(folder, step)
}

#[test]
fn the_two_newest_are_kept() {
    let folder = scratch("kept");
    for step in [7, 999_999, 1_000_000, 1_000_002] {
        make(&folder, step);
    }
    let kept = [1_000_002, 1_000_000].map(|step| path(&folder, step));
    assert_eq!(complete(&folder), kept);
    make(&folder, 1_000_002);
    assert_eq!(complete(&folder), kept);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
    fs::create_dir(folder.join("checkpoint-2000000.part")).unwrap();
    assert_eq!(complete(&folder), kept);
    remove_newer(&folder, Some(1_000_000)).unwrap();
    assert_eq!(complete(&folder), kept[1..]);
    remove_newer(&folder, None).unwrap();
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_could_not_be_filled_leaves_the_earlier_ones() {
    let folder = scratch("unfilled");
    let first = make(&folder, 3);
    let error = OutputError::write(&folder, std::io::Error::from_raw_os_error(28));
    assert!(matches!(error, OutputError::NoSpace { .. }), "{error}");
    let written = write(&folder, 5, |to| {
        fs::write(to.join("state.h5"), "half").unwrap();
        Err(error.clone())
    });
    assert_eq!(written, Err(error));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    verify(&first).unwrap();
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_flipped_bit_or_a_missing_end_is_found_wherever_it_is() {
    let folder = scratch("flips");
    let made = make(&folder, 12);
    verify(&made).unwrap();
    let mut random = Random(155);
    for name in ["state.h5", "history.csv", MANIFEST] {
        let file = made.join(name);
        let whole = fs::read(&file).unwrap();
        let refused = |bytes: &[u8], what: &str| {
            fs::write(&file, bytes).unwrap();
            let error = verify(&made).unwrap_err().to_string();
            assert!(error.starts_with("the checkpoint "), "{what}: {error}");
            assert!(
                error.contains(name) || error.contains("format"),
                "{what}: {error}"
            );
        };
        // Every bit of the manifest, and some of the others.
        let flips: Vec<usize> = if name == MANIFEST {
            (0..8 * whole.len()).collect()
        } else {
            (0..400).map(|_| random.below(8 * whole.len())).collect()
        };
        for bit in flips {
            let mut bytes = whole.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            refused(&bytes, &format!("{name}, bit {bit}"));
        }
        for _ in 0..100 {
            let end = random.below(whole.len());
            refused(&whole[..end], &format!("{name}, {end} bytes"));
        }
        fs::write(&file, [&whole[..], b" "].concat()).unwrap();
        assert!(verify(&made).is_err());
        fs::remove_file(&file).unwrap();
        assert!(verify(&made).is_err());
        fs::write(&file, &whole).unwrap();
    }
    verify(&made).unwrap();
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn another_format_is_said_so() {
    let folder = scratch("format");
    let made = make(&folder, 1);
    let lines = format!("{TITLE}{}\n", FORMAT + 1);
    let sum = crc32fast::hash(lines.as_bytes());
    fs::write(
        made.join(MANIFEST),
        format!("{lines}{LAST_LINE}{sum:08x}\n"),
    )
    .unwrap();
    let error = verify(&made).unwrap_err().to_string();
    let expected = format!(
        "it has format {}, and this program reads format {FORMAT}",
        FORMAT + 1
    );
    assert!(error.contains(&expected), "{error}");
    fs::remove_dir_all(folder).unwrap();
}
