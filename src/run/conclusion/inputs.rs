//! Checksums of the files a run was made from: enough to see later whether they are still the same.

use std::collections::BTreeMap;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::case::Case;

/// SHA-256 of the option files of the command line, of the hardening table and of the tools by file name, and of all
/// options in effect but the output folder. Folders are left out: they say where, not what. Files read before may be gone by now:
/// then they are left out, too.
pub(super) fn checksums(case: &Case) -> BTreeMap<String, String> {
    let words: Vec<String> = std::env::args().collect();
    let mut files: Vec<String> = words
        .windows(2)
        .filter(|pair| pair[0].eq_ignore_ascii_case("-options_file"))
        .map(|pair| pair[1].strip_suffix(":yaml").unwrap_or(&pair[1]).to_owned())
        .collect();
    files.push(case.material.hardening_file.clone());
    let tools = [&case.tools.die_file, &case.tools.punch_file];
    files.extend(tools.into_iter().flatten().map(|file| file.path.clone()));
    let mut sums: BTreeMap<String, String> = files
        .iter()
        .filter_map(|path| {
            let bytes = std::fs::read(path).ok()?;
            let name = Path::new(path).file_name()?.to_string_lossy().into_owned();
            Some((name, sum(&bytes)))
        })
        .collect();
    let options: String = case
        .options()
        .iter()
        .filter(|(name, _)| *name != "output_dir")
        .map(|(name, value)| format!("-{name} {value}\n"))
        .collect();
    sums.insert("all options in effect".to_owned(), sum(options.as_bytes()));
    sums
}

fn sum(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_standards() {
        // FIPS 180-4, the message "abc".
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sum(b"abc"), expected);
    }

    #[test]
    fn another_option_gives_another_checksum_and_another_folder_does_not() {
        let of = |case: &Case| checksums(case)["all options in effect"].clone();
        let mut case = Case::reference().unwrap();
        let reference = of(&case);
        case.output.dir = "elsewhere".to_owned();
        assert_eq!(of(&case), reference);
        case.sheet.width = 31.0;
        assert_ne!(of(&case), reference);
    }
}
