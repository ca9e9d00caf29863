//! Least squares by PETSc's bounded Gauss-Newton method, in the unit box of the bounds.
//!
//! The runs are collective, so every rank has an optimiser of its own and gives it the same numbers.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use petsc::{CallbackError, Failure, Matrix, Tao, TaoReason, Vector, options};

use super::InverseError;
use super::search::Search;

/// What PETSc is asked for unless the user asks for something else.
const DEFAULTS: &[(&str, &str)] = &[
    // The plain problem: what the curve cannot tell is found from its derivatives, not hidden by a preference.
    ("tao_brgn_regularizer_weight", "0"),
    // The only line search that comes back from where a run cannot be solved.
    ("tao_brgn_subsolver_tao_ls_type", "armijo"),
    // A step that leads nowhere at 1/64 of its length leads nowhere.
    ("tao_brgn_subsolver_tao_ls_max_funcs", "7"),
    // Some unknowns: the linear systems are solved to rounding.
    ("tao_brgn_subsolver_tao_bnk_ksp_rtol", "1e-12"),
];

/// Of the norm of the gradient by the scaled parameters.
const GRADIENT_TOLERANCE: f64 = 1e-6;

/// Why the search ended.
pub(super) enum Ended {
    ByPetsc(TaoReason),
    Near,
    RunsUsedUp,
}

impl Ended {
    pub fn sentence(&self) -> String {
        match self {
            Self::ByPetsc(reason) => reason.sentence().to_owned(),
            Self::Near => InverseError::Near.to_string(),
            Self::RunsUsedUp => InverseError::RunsUsedUp.to_string(),
        }
    }
}

/// Lets the optimiser read its options, before anything is made.
///
/// # Errors
/// PETSc's words about a value.
pub(super) fn read_options() -> Result<(), InverseError> {
    for (name, value) in DEFAULTS {
        options::set_default(name, value)?;
    }
    Ok(Tao::new(&SimpleCommunicator::self_comm())?.set_from_options()?)
}

/// Goes from the start of the search to the least sum of squares, or to where it is this `near` in standard errors; all that
/// was tried stays in the search. Collective.
///
/// PETSc's own measure is the norm of the gradient where that is small against the distance from the bounds, which knows no
/// uncertainty: its tolerance only ends what cannot be made better.
///
/// # Errors
/// If a run is refused or PETSc fails.
pub(super) fn fit(search: &Rc<RefCell<Search>>, near: f64) -> Result<Ended, InverseError> {
    let alone = SimpleCommunicator::self_comm();
    let start = search.borrow().start();
    let (rows, columns) = (search.borrow().measured().len(), start.len());
    let mut x = Vector::new(&alone, columns)?;
    x.write()?.copy_from_slice(&start);
    let (mut lower, mut upper) = (x.duplicate()?, x.duplicate()?);
    lower.set_all(0.0)?;
    upper.set_all(1.0)?;

    let mut tao = Tao::new(&alone)?;
    tao.set_variable_bounds(&lower, &upper)?;
    let shared = Rc::clone(search);
    // Below the residuals zeros, which the curvature beyond Gauss and Newton's belongs to.
    let all_rows = rows + 2 * columns;
    let template = Vector::new(&alone, all_rows)?;
    tao.set_residual(&template, move |x, r| {
        let at = x.read()?.to_vec();
        let mut search = shared.borrow_mut();
        search.at(&at)?.ok_or(Failure::Domain)?;
        let fit = search.known(&at).ok_or(Failure::Domain)?;
        if search.way_left(fit) <= near {
            return Err(InverseError::Near.into());
        }
        let mut r = r.write()?;
        r.fill(0.0);
        r[..fit.residual.len()].copy_from_slice(&fit.residual);
        Ok(())
    })?;
    let (m, n) = (all_rows as i32, columns as i32);
    let at_row: Vec<i32> = (0..m).flat_map(|row| (0..n).map(move |_| row)).collect();
    let at_column: Vec<i32> = (0..m).flat_map(|_| 0..n).collect();
    let matrix = Matrix::rectangular_from_coo(&alone, [all_rows, columns], &at_row, &at_column)?;
    let shared = Rc::clone(search);
    tao.set_residual_jacobian(matrix, move |x, matrix| {
        let at = x.read()?.to_vec();
        let search = shared.borrow();
        let fit = search
            .known(&at)
            .ok_or("a derivative where there is no run")?;
        let mut entries = fit.entries();
        entries.extend(search.around(fit).rows());
        Ok(matrix.set_values_coo(&entries)?)
    })?;
    tao.set_gradient_tolerance(GRADIENT_TOLERANCE)?;
    tao.set_from_options()?;
    match tao.solve(&mut x) {
        Ok(reason) => Ok(Ended::ByPetsc(reason)),
        Err(petsc::Error::Callback { source, traceback }) => own(source).map_or_else(
            |source| Err(petsc::Error::Callback { source, traceback }.into()),
            |error| match error {
                InverseError::RunsUsedUp => Ok(Ended::RunsUsedUp),
                InverseError::Near => Ok(Ended::Near),
                error => Err(error),
            },
        ),
        Err(error) => Err(error.into()),
    }
}

/// The error of a search that went through PETSc.
fn own(source: CallbackError) -> Result<InverseError, CallbackError> {
    source.downcast().map(|error| *error)
}
