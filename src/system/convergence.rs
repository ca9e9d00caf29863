//! What a Newton solve is judged by, beside the norm of its residual.

use petsc::VectorRef;

use super::System;
use super::numbering::UNKNOWNS_PER_POINT;
use crate::ranks;

impl System {
    /// Vertical sum of the equilibrium rows of a residual as a force of the whole sheet, N. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn vertical_sum(&self, residual: &VectorRef) -> petsc::Result<f64> {
        let count = self.owned_displacements();
        let mine: f64 = residual.read()?[..count]
            .chunks_exact(2)
            .map(|xy| xy[1])
            .sum();
        let [sum] = ranks::sums(self.comm(), [mine]);
        Ok(self.scaled_force() * sum)
    }

    /// Largest tensile contact force of a point among the unknowns `u` as a force of the whole sheet, N; 0 if
    /// none is tensile. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn largest_tensile_force(&self, u: &VectorRef) -> petsc::Result<f64> {
        let first = self.owned_displacements();
        let mine = u.read()?[first..]
            .chunks_exact(UNKNOWNS_PER_POINT)
            .fold(0.0_f64, |largest, point| largest.max(-point[0]));
        let [largest] = ranks::maxima(self.comm(), [mine]);
        Ok(self.scaled_force() * largest)
    }

    /// Largest displacement among the unknowns `u`, mm. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn largest_displacement(&self, u: &VectorRef) -> petsc::Result<f64> {
        let count = self.owned_displacements();
        let mine = u.read()?[..count]
            .iter()
            .fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let [largest] = ranks::maxima(self.comm(), [mine]);
        Ok(largest)
    }

    /// The force of the whole sheet for one millimetre in an equilibrium row, N/mm.
    fn scaled_force(&self) -> f64 {
        let problem = self.problem();
        problem.whole_sheet * problem.young_modulus
    }
}
