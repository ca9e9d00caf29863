//! Linear solves on the reduced set with vectors of all unknowns.

use petsc::{Vector, VectorRef};

use crate::system::{CondensedSolve, System};

/// Solves with the present factor for the right-hand side `r`, whose entries at the closed gaps (ascending global rows of
/// this rank) do not count: these stay as they are. Collective.
pub(super) fn on_reduced_set(
    system: &System,
    solve: &CondensedSolve,
    closed: &[i32],
    r: &VectorRef,
) -> petsc::Result<Vector> {
    let first = r.ownership_range()?.start;
    let closed: Vec<usize> = closed
        .iter()
        .filter_map(|row| usize::try_from(row - first).ok())
        .collect();
    let r = r.read()?;
    let mut reduced = Vector::new(system.comm(), r.len() - closed.len())?;
    let free = || {
        let mut closed = closed.iter().peekable();
        (0..r.len()).filter(move |row| closed.next_if_eq(&row).is_none())
    };
    for (value, row) in reduced.write()?.iter_mut().zip(free()) {
        *value = r[row];
    }
    let mut step = reduced.duplicate()?;
    solve.solve(&reduced, &mut step)?;
    let mut all = system.vector()?;
    let (step, mut write) = (step.read()?, all.write()?);
    for (value, row) in step.iter().zip(free()) {
        write[row] = *value;
    }
    drop(write);
    Ok(all)
}
