//! Which BLAS the direct solver works with. It decides how fast MUMPS is, and with threads of its own it can fight the
//! other ranks for the cores; so it is looked at where it is loaded, not where it was meant to be.

use std::fmt;
use std::path::Path;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use crate::ranks::lowest_failing;
use crate::run::error::RunError;

/// The BLAS in the process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::run) struct Blas {
    /// The variant's name, which is that of its folder: `openblas-serial`, `blas`, ...
    variant: String,
    /// Threads it may use on each rank.
    threads: usize,
}

/// Names of the optimised ones, as they appear in the variant.
const FAST: &[&str] = &["openblas", "blis", "mkl", "atlas"];
/// Names of the variants with threads.
const THREADED: &[&str] = &["pthread", "openmp", "mkl", "libopenblas"];
/// How their threads are limited.
const LIMITS: &[&str] = &["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"];

impl Blas {
    /// The one that is loaded; none where the operating system does not show it.
    pub(in crate::run) fn loaded() -> Option<Self> {
        let maps = std::fs::read_to_string("/proc/self/maps").ok()?;
        let limit = LIMITS
            .iter()
            .find_map(|name| std::env::var(name).ok()?.parse().ok());
        Self::among(&maps, limit, cores())
    }

    /// The one in a list of mapped files as Linux writes it.
    fn among(maps: &str, limit: Option<usize>, cores: usize) -> Option<Self> {
        let path = maps
            .lines()
            .filter_map(|line| line.split_whitespace().nth(5).map(Path::new))
            .find(|path| {
                let name = path.file_name().and_then(|name| name.to_str());
                name.is_some_and(|name| name.starts_with("libblas.so"))
            })?;
        let variant = path.parent()?.file_name()?.to_str()?.to_owned();
        let threaded = THREADED.iter().any(|name| variant.contains(name));
        Some(Self {
            threads: if threaded { limit.unwrap_or(cores) } else { 1 },
            variant,
        })
    }

    /// What is wrong with it for this many ranks on a machine with this number of cores, and what to do; each a
    /// sentence.
    fn complaints(&self, ranks: usize, cores: usize) -> Vec<String> {
        let mut complaints = Vec::new();
        if !FAST.iter().any(|name| self.variant.contains(name)) {
            complaints.push(format!(
                "the BLAS in use ({}) is the reference one, which is slow; install an optimised one \
                 (Debian: libopenblas0-serial)",
                self.variant
            ));
        }
        if self.threads > 1 && self.threads * ranks > cores {
            complaints.push(format!(
                "{ranks} ranks with {} BLAS threads each share {cores} cores; set OPENBLAS_NUM_THREADS=1",
                self.threads
            ));
        }
        complaints
    }
}

impl fmt::Display for Blas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.threads == 1 { "" } else { "s" };
        write!(f, "{}, {} thread{plural}", self.variant, self.threads)
    }
}

/// What OpenBLAS takes at its first product, once a thread, bytes. Where it cannot have it, it asks again for ever.
const BUFFER: usize = 128 << 20;
/// What is to be left besides, for the factors of a small case.
const MARGIN: usize = 64 << 20;

/// Refuses to run where a limit on memory leaves no room for the BLAS: it would not fail but hang. Collective.
///
/// # Errors
/// [`RunError::NoRoom`], on every rank.
pub(in crate::run) fn find_room(comm: &SimpleCommunicator) -> Result<(), RunError> {
    // Memory that is not touched costs address space only, which is what ulimit -v limits.
    let room = Vec::<u8>::new().try_reserve_exact(BUFFER + MARGIN).is_ok();
    match lowest_failing(comm, !room) {
        None => Ok(()),
        Some(_) => Err(RunError::NoRoom {
            megabytes: (BUFFER + MARGIN) >> 20,
        }),
    }
}

/// The line about it above a run, and a warning for each complaint, with line breaks. Collective.
pub(in crate::run) fn report(comm: &SimpleCommunicator) -> String {
    let beside = comm.split_shared(comm.rank()).size().unsigned_abs() as usize;
    let Some(blas) = Blas::loaded() else {
        return String::new();
    };
    let warnings = blas.complaints(beside, cores());
    warnings.iter().fold(format!("BLAS: {blas}\n"), |text, w| {
        format!("{text}warning: {w}\n")
    })
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps(variant: &str) -> String {
        let line = |path: &str| format!("7f00-7f01 r-xp 00000000 08:01 42   {path}\n");
        line("/usr/lib/libCombBLAS.so.1") + &line(&format!("/usr/lib/{variant}/libblas.so.3"))
    }

    #[test]
    fn the_loaded_one_is_named_and_judged() {
        let serial = Blas::among(&maps("openblas-serial"), None, 8).unwrap();
        assert_eq!(serial.to_string(), "openblas-serial, 1 thread");
        assert!(serial.complaints(8, 8).is_empty());
        let slow = Blas::among(&maps("blas"), Some(4), 8).unwrap();
        assert!(slow.complaints(1, 8)[0].contains("reference"));
        let threaded = Blas::among(&maps("openblas-pthread"), None, 8).unwrap();
        assert_eq!(threaded.to_string(), "openblas-pthread, 8 threads");
        assert!(threaded.complaints(1, 8).is_empty());
        assert!(threaded.complaints(2, 8)[0].contains("OPENBLAS_NUM_THREADS"));
        let limited = Blas::among(&maps("openblas-pthread"), Some(1), 8).unwrap();
        assert!(limited.complaints(8, 8).is_empty());
        assert_eq!(Blas::among("", None, 8), None);
    }
}
