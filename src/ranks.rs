//! What ranks have to settle between them: who failed first, and lists of different lengths.

use mpi::collective::SystemOperation;
use mpi::datatype::{Equivalence, PartitionMut};
use mpi::traits::{Communicator, CommunicatorCollectives, Root};

/// The lowest rank on which something failed, the same on every rank; none if all went well.
/// Collective.
pub fn lowest_failing(comm: &impl Communicator, failed: bool) -> Option<i32> {
    let vote = if failed { comm.rank() } else { i32::MAX };
    let mut lowest = i32::MAX;
    comm.all_reduce_into(&vote, &mut lowest, SystemOperation::min());
    (lowest < i32::MAX).then_some(lowest)
}

/// The bytes that rank `root` has, on every rank; what the other ranks pass is ignored. Collective.
pub fn broadcast_bytes(comm: &impl Communicator, root: i32, mut bytes: Vec<u8>) -> Vec<u8> {
    let root = comm.process_at_rank(root);
    let mut length = bytes.len() as u64;
    root.broadcast_into(&mut length);
    bytes.resize(length as usize, 0);
    root.broadcast_into(&mut bytes[..]);
    bytes
}

/// The lists of all ranks, one after the other in the order of the ranks, on every rank. Collective.
pub fn gather_lists<T: Equivalence + Clone + Default>(
    comm: &impl Communicator,
    mine: &[T],
) -> Vec<T> {
    let mut counts = vec![0_i32; comm.size().unsigned_abs() as usize];
    comm.all_gather_into(&(mine.len() as i32), &mut counts[..]);
    let starts = starts(&counts);
    let mut all = vec![T::default(); counts.iter().sum::<i32>().unsigned_abs() as usize];
    comm.all_gather_varcount_into(mine, &mut PartitionMut::new(&mut all[..], counts, starts));
    all
}

/// The lists of all ranks, one after the other in the order of the ranks, on rank 0, and nothing on the others. Collective.
pub fn gather_on_first<T: Equivalence + Clone + Default>(
    comm: &impl Communicator,
    mine: &[T],
) -> Option<Vec<T>> {
    let first = comm.process_at_rank(0);
    let count = mine.len() as i32;
    if comm.rank() != 0 {
        first.gather_into(&count);
        first.gather_varcount_into(mine);
        return None;
    }
    let mut counts = vec![0_i32; comm.size().unsigned_abs() as usize];
    first.gather_into_root(&count, &mut counts[..]);
    let starts = starts(&counts);
    let mut all = vec![T::default(); counts.iter().sum::<i32>().unsigned_abs() as usize];
    let mut parts = PartitionMut::new(&mut all[..], counts, starts);
    first.gather_varcount_into_root(mine, &mut parts);
    Some(all)
}

/// Where lists of these lengths start when they follow each other.
fn starts(counts: &[i32]) -> Vec<i32> {
    counts
        .iter()
        .scan(0, |end, count| Some(std::mem::replace(end, *end + count)))
        .collect()
}

/// The rows of a list that was flat on its way; what is left over at its end is dropped.
pub fn rows<T: Copy, const N: usize>(flat: &[T]) -> Vec<[T; N]> {
    flat.chunks_exact(N)
        .filter_map(|row| row.try_into().ok())
        .collect()
}

/// The sums of these numbers over the ranks. Collective.
pub fn sums<T: Equivalence + Default + Copy, const N: usize>(
    comm: &impl Communicator,
    mine: [T; N],
) -> [T; N] {
    let mut all = [T::default(); N];
    comm.all_reduce_into(&mine[..], &mut all[..], SystemOperation::sum());
    all
}

/// The largest of each of these numbers over the ranks. Collective.
pub fn maxima<const N: usize>(comm: &impl Communicator, mine: [f64; N]) -> [f64; N] {
    let mut all = [0.0; N];
    comm.all_reduce_into(&mine[..], &mut all[..], SystemOperation::max());
    all
}

/// The smallest of these numbers over the ranks. Collective.
pub fn smallest(comm: &impl Communicator, mine: f64) -> f64 {
    let mut all = 0.0;
    comm.all_reduce_into(&mine, &mut all, SystemOperation::min());
    all
}

/// The value if every rank has one; otherwise, on every rank, the sentence of the lowest rank that failed. Collective.
///
/// # Errors
/// That sentence.
pub fn agree_in_words<T, E: std::fmt::Display>(
    comm: &impl Communicator,
    mine: Result<T, E>,
) -> Result<T, String> {
    let Some(lowest) = lowest_failing(comm, mine.is_err()) else {
        return mine.map_err(|error| error.to_string());
    };
    let sentence = mine
        .err()
        .map_or_else(String::new, |error| error.to_string());
    let sentence = broadcast_bytes(comm, lowest, sentence.into_bytes());
    Err(String::from_utf8_lossy(&sentence).into_owned())
}

/// Gives every rank the numbers of rank 0, to the last bit. Collective.
pub fn from_first(comm: &impl Communicator, numbers: &mut [f64]) {
    comm.process_at_rank(0).broadcast_into(numbers);
}
