//! The derivatives of the angle to which the sheet springs back when the tools vanish.

use petsc::VectorRef;

use super::solve::on_reduced_set;
use super::step::Sensitivity;
use crate::ranks;
use crate::system::{
    CondensedSolve, Directions, EvaluationError, History, LocalStep, System, SystemError, Workspace,
};

/// Derivatives of a released angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReleasedSlopes {
    /// Time at which the tools vanished, ms.
    pub t_ms: f64,
    /// In the order of the parameters, degrees per unit; NaN where there is none.
    pub angles: Vec<f64>,
}

/// A sheet without tools that is at rest, whose material remembers what it did when the tools were there.
pub struct ReleasedState<'a> {
    /// The sheet; point A is held at its height.
    pub system: &'a System,
    /// Solves with its tangent.
    pub solve: &'a CondensedSolve,
    /// Its history.
    pub history: &'a History,
    /// Its displacements.
    pub unknowns: &'a VectorRef,
    /// Time at which the tools vanished, ms.
    pub t_ms: f64,
    /// Whether it came to rest without yielding.
    pub elastic: bool,
}

impl Sensitivity {
    /// Derivatives of the angle of a sheet that was released from the last accepted state. If it yielded until it was at rest there
    /// are none: they would depend on the steps. Collective.
    ///
    /// # Errors
    /// If PETSc fails, or an element cannot be evaluated.
    pub fn release(&mut self, state: &ReleasedState<'_>) -> Result<(), SystemError> {
        let mut angles = vec![f64::NAN; self.tracked.len()];
        if state.elastic && !self.lost {
            self.release_elastically(state, &mut angles)?;
        }
        let t_ms = state.t_ms;
        self.released.push(ReleasedSlopes { t_ms, angles });
        Ok(())
    }

    fn release_elastically(
        &mut self,
        state: &ReleasedState<'_>,
        angles: &mut [f64],
    ) -> Result<(), SystemError> {
        let (system, end) = (state.system, 1.0);
        let comm = system.comm();
        let u = system.local_values(state.unknowns)?;
        let still = vec![0.0; u.len()];
        let mut entries = system.jacobian_entries();
        let evaluated = system.jacobian(state.history, end, state.unknowns, 0.0, &mut entries);
        let failed = match evaluated {
            Err(EvaluationError::Petsc(error)) => return Err(error.into()),
            Err(EvaluationError::Element(_)) => true,
            Ok(()) => false,
        };
        if ranks::lowest_failing(comm, failed).is_some() || !state.solve.factor(&entries, &[])? {
            return Ok(());
        }
        let step = LocalStep {
            before: state.history,
            after: state.history,
            flowing: &state.history.flowing(state.history),
            t: end,
            u: &u,
            a: &still,
        };
        let mut work = Workspace::new(system.local());
        for (tracked, angle) in self.tracked.iter().zip(angles) {
            let variation = tracked.variation.released(system);
            // Contact unknowns come last.
            let mut guess = self.system.local_values(&tracked.unknowns)?;
            guess.truncate(u.len());
            let along = Directions {
                history: &tracked.history.without_contact(),
                u: &guess,
                a: &still,
            };
            let mut shares = still.clone();
            let evaluated = variation.residual_slope(&step, &along, &mut work, &mut shares);
            if ranks::lowest_failing(comm, evaluated.is_err()).is_some() {
                continue;
            }
            let mut right_side = system.vector()?;
            system.sum_of_shares(&shares, &mut right_side)?;
            right_side.scale(-1.0)?;
            let correction = on_reduced_set(system, state.solve, &[], &right_side)?;
            let mut du = system.local_values(&correction)?;
            du.iter_mut()
                .zip(&guess)
                .for_each(|(du, guess)| *du += guess);
            [_, *angle] = variation.shape_slopes(&u, &du).over_ranks(comm);
        }
        Ok(())
    }
}
