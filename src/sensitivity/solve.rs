//! The linear solve for the derivatives of the unknowns, on the reduced set.

use petsc::{Vector, VectorRef};

use super::tracked::{Scheme, Tracked};
use crate::system::{CondensedSolve, EvaluatedStep, History, JacobianEntries, System};

/// A solve that adds no more than this share of the whole is the last one. What a direct solve adds is known to 1e-8 in a
/// thin sheet, which is a thousand times stiffer along than across.
const ADDS_LITTLE: f64 = 0.2;
const MOST_SOLVES: u64 = 3;

/// The tangent of a converged state, and its factors.
pub(super) struct Tangent<'a> {
    pub system: &'a System,
    pub entries: &'a JacobianEntries,
    pub solve: &'a CondensedSolve,
    /// Ascending global rows of this rank's gaps that are closed.
    pub closed: &'a [i32],
    /// None in statics.
    pub scheme: Option<&'a Scheme>,
}

impl Tracked {
    /// The derivatives of the unknowns from a `guess` at them, where the history before the step moves by `history`, and the
    /// number of solves: iterative refinement. Collective.
    pub fn solve(
        &self,
        step: &EvaluatedStep<'_>,
        tangent: &Tangent<'_>,
        mut guess: Vector,
        history: &History,
    ) -> petsc::Result<(Vector, u64)> {
        let Tangent {
            system, entries, ..
        } = tangent;
        let mut acceleration = system.vector()?;
        if let Some(scheme) = tangent.scheme {
            self.held_acceleration(scheme, system.owned_displacements(), &mut acceleration)?;
        }
        let a = system.local_values(&acceleration)?;
        let mut held = vec![0.0; a.len()];
        self.variation.residual_slope(step, history, &a, &mut held);
        let mut right_side = system.vector()?;
        tangent.hold(&mut guess)?;
        let mut solves = 0;
        loop {
            let mut shares = held.clone();
            let moved = system.local_values(&guess)?;
            entries.add_product(system.local(), &moved, &mut shares);
            system.sum_of_shares(&shares, &mut right_side)?;
            right_side.scale(-1.0)?;
            let added = tangent.on_reduced_set(&right_side)?;
            guess.axpy(1.0, &added)?;
            solves += 1;
            if solves == MOST_SOLVES || added.norm2()? <= ADDS_LITTLE * guess.norm2()? {
                return Ok((guess, solves));
            }
        }
    }
}

impl Tangent<'_> {
    /// Takes the gaps that are closed out of the derivatives of the unknowns.
    fn hold(&self, unknowns: &mut VectorRef) -> petsc::Result<()> {
        let first = unknowns.ownership_range()?.start;
        let mut write = unknowns.write()?;
        for row in self.closed {
            if let Ok(own) = usize::try_from(row - first) {
                write[own] = 0.0;
            }
        }
        Ok(())
    }

    /// Solves for the right-hand side `r`, whose entries at the closed gaps do not count: these stay as they are. Collective.
    fn on_reduced_set(&self, r: &VectorRef) -> petsc::Result<Vector> {
        let Self { system, solve, .. } = self;
        let first = r.ownership_range()?.start;
        let closed: Vec<usize> = self
            .closed
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
}
