//! The linear solves for the derivatives of the unknowns, on the reduced set, by all parameters side by side.

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

/// What is solved for: the derivatives by one parameter.
pub(super) struct Wanted<'a> {
    pub tracked: &'a Tracked,
    /// Of the history before the step.
    pub history: &'a History,
    /// A guess at those of the unknowns, and what the solve makes of it.
    pub unknowns: Vector,
}

impl Wanted<'_> {
    /// This rank's share of what the step's residual moves by at held unknowns. Collective.
    fn held_residual(
        &self,
        step: &EvaluatedStep<'_>,
        tangent: &Tangent<'_>,
    ) -> petsc::Result<Vec<f64>> {
        let system = tangent.system;
        let mut acceleration = system.vector()?;
        if let Some(scheme) = tangent.scheme {
            let count = system.owned_displacements();
            self.tracked
                .held_acceleration(scheme, count, &mut acceleration)?;
        }
        let a = system.local_values(&acceleration)?;
        let mut held = vec![0.0; a.len()];
        let variation = &self.tracked.variation;
        variation.residual_slope(step, self.history, &a, &mut held);
        Ok(held)
    }
}

impl Tangent<'_> {
    /// Solves for the derivatives of the unknowns by several parameters side by side and returns the number of solves:
    /// iterative refinement of the guesses. Collective.
    pub fn solve(&self, step: &EvaluatedStep<'_>, wanted: &mut [Wanted<'_>]) -> petsc::Result<u64> {
        for one in &mut *wanted {
            self.hold(&mut one.unknowns)?;
        }
        let held = wanted.iter().map(|one| one.held_residual(step, self));
        let held: Vec<Vec<f64>> = held.collect::<petsc::Result<_>>()?;
        let mut open: Vec<usize> = (0..wanted.len()).collect();
        let (mut solves, mut rounds) = (0, 0);
        while !open.is_empty() && rounds < MOST_SOLVES {
            let added = self.add_what_is_missing(&held, wanted, &open)?;
            (solves, rounds) = (solves + added.len() as u64, rounds + 1);
            let mut little = added.into_iter();
            open.retain(|_| !little.next().unwrap_or(true));
        }
        Ok(solves)
    }

    /// A solve for those of the derivatives that are `open`, and whether it adds little to each.
    fn add_what_is_missing(
        &self,
        held: &[Vec<f64>],
        wanted: &mut [Wanted<'_>],
        open: &[usize],
    ) -> petsc::Result<Vec<bool>> {
        let system = self.system;
        let moved = open
            .iter()
            .map(|&k| system.local_values(&wanted[k].unknowns));
        let moved: Vec<Vec<f64>> = moved.collect::<petsc::Result<_>>()?;
        let mut shares: Vec<Vec<f64>> = open.iter().map(|&k| held[k].clone()).collect();
        self.entries
            .add_products(system.local(), &moved, &mut shares);
        let added = self.on_reduced_set(&shares)?;
        let takes = |(&k, added): (&usize, &Vector)| {
            let unknowns = &mut wanted[k].unknowns;
            unknowns.axpy(-1.0, added)?;
            Ok(added.norm2()? <= ADDS_LITTLE * unknowns.norm2()?)
        };
        open.iter().zip(&added).map(takes).collect()
    }

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

    /// Solves for these shares of right-hand sides, whose entries at the closed gaps do not count: these stay as they are.
    /// Collective.
    fn on_reduced_set(&self, shares: &[Vec<f64>]) -> petsc::Result<Vec<Vector>> {
        let system = self.system;
        let mut whole = system.vector()?;
        let free = self.free_rows(&whole)?;
        let mut right_sides = Vec::with_capacity(shares.len());
        for shares in shares {
            system.sum_of_shares(shares, &mut whole)?;
            let mut reduced = Vector::new(system.comm(), free.len())?;
            let whole: &[f64] = &whole.read()?;
            for (value, &row) in reduced.write()?.iter_mut().zip(&free) {
                *value = whole[row];
            }
            right_sides.push(reduced);
        }
        let steps = right_sides.iter().map(|reduced| reduced.duplicate());
        let mut steps: Vec<Vector> = steps.collect::<petsc::Result<_>>()?;
        self.solve.solve_all(&right_sides, &mut steps)?;
        let expanded = |step: &Vector| {
            let mut all = system.vector()?;
            let mut write = all.write()?;
            let whole: &mut [f64] = &mut write;
            for (value, &row) in step.read()?.iter().zip(&free) {
                whole[row] = *value;
            }
            drop(write);
            Ok(all)
        };
        steps.iter().map(expanded).collect()
    }

    /// Places of this rank's unknowns that are not closed gaps.
    fn free_rows(&self, unknowns: &VectorRef) -> petsc::Result<Vec<usize>> {
        let own = unknowns.ownership_range()?;
        let mut closed = self.closed.iter().peekable();
        let free = own.clone().filter(|row| closed.next_if_eq(&row).is_none());
        Ok(free
            .filter_map(|row| usize::try_from(row - own.start).ok())
            .collect())
    }
}
