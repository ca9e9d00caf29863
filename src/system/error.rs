//! What can fail: the partition, PETSc, sizes, or an element, as its own rank knows it and as every rank knows it.

use mpi::traits::Communicator;
use petsc::Failure;

use crate::element::GaussPointFailure;
use crate::mesh::PartitionError;
use crate::ranks::{broadcast_bytes, lowest_failing, rows};

/// The system could not be set up, or an accepted state not be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum SystemError {
    /// METIS refused.
    #[error(transparent)]
    Partition(#[from] PartitionError),
    /// An accepted state cannot be evaluated; the same on every rank.
    #[error(transparent)]
    Element(#[from] FailedElement),
    /// PETSc failed.
    #[error(transparent)]
    Petsc(#[from] petsc::Error),
}

/// Why this rank could not evaluate a trial state.
///
/// It is no `std::error::Error` on purpose: PETSc's [`Failure`] takes every such error for fatal, and an element that
/// cannot be evaluated only asks for a shorter step.
#[derive(Debug)]
pub enum EvaluationError {
    /// An element of this rank.
    Element(ElementFailure),
    /// PETSc failed.
    Petsc(petsc::Error),
}

impl From<ElementFailure> for EvaluationError {
    fn from(failure: ElementFailure) -> Self {
        Self::Element(failure)
    }
}

impl From<petsc::Error> for EvaluationError {
    fn from(error: petsc::Error) -> Self {
        Self::Petsc(error)
    }
}

impl From<EvaluationError> for Failure {
    fn from(error: EvaluationError) -> Self {
        match error {
            EvaluationError::Element(_) => Self::Domain,
            EvaluationError::Petsc(error) => error.into(),
        }
    }
}

/// An element of this rank that cannot be evaluated.
#[derive(Clone, Debug, thiserror::Error)]
#[error("element {element} at ({:.3}, {:.3}) mm, {cause}", position[0], position[1])]
pub struct ElementFailure {
    /// Mesh number of the element.
    pub element: usize,
    /// Its current position, mm.
    pub position: [f64; 2],
    /// What is wrong.
    pub cause: GaussPointFailure,
}

/// An element that cannot be evaluated, the same on every rank.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("element {element} at ({:.3}, {:.3}) mm, {cause}", position[0], position[1])]
pub struct FailedElement {
    /// Mesh number of the element.
    pub element: usize,
    /// Its current position, mm.
    pub position: [f64; 2],
    /// What is wrong.
    pub cause: String,
}

impl From<ElementFailure> for FailedElement {
    fn from(failure: ElementFailure) -> Self {
        Self {
            element: failure.element,
            position: failure.position,
            cause: failure.cause.to_string(),
        }
    }
}

impl FailedElement {
    /// The failure of the lowest rank that has one, on every rank; none if no rank has one. Collective.
    pub fn over_ranks(comm: &impl Communicator, mine: Option<ElementFailure>) -> Option<Self> {
        let lowest = lowest_failing(comm, mine.is_some())?;
        let (mut numbers, mut cause) = (Vec::new(), Vec::new());
        if let (Some(mine), true) = (mine, comm.rank() == lowest) {
            let [x, y] = mine.position;
            numbers = [mine.element as f64, x, y].map(f64::to_ne_bytes).concat();
            cause = mine.cause.to_string().into_bytes();
        }
        let numbers = broadcast_bytes(comm, lowest, numbers);
        let cause = broadcast_bytes(comm, lowest, cause);
        let numbers = rows(&numbers);
        let number = |k: usize| {
            let bytes = numbers.get(k);
            bytes.map_or(f64::NAN, |bytes| f64::from_ne_bytes(*bytes))
        };
        Some(Self {
            element: number(0) as usize,
            position: [number(1), number(2)],
            cause: String::from_utf8_lossy(&cause).into_owned(),
        })
    }

    /// This rank's value if every rank has one, otherwise the failure of the lowest rank that has none: nobody goes on
    /// alone into the next collective call. Collective.
    pub(super) fn agree<T>(
        comm: &impl Communicator,
        mine: Result<T, ElementFailure>,
    ) -> Result<T, Self> {
        match mine {
            Ok(value) => Self::over_ranks(comm, None).map_or(Ok(value), Err),
            Err(own) => {
                Err(Self::over_ranks(comm, Some(own.clone())).unwrap_or_else(|| own.into()))
            }
        }
    }
}

/// A list that does not belong to this problem.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} have {found} numbers instead of {expected}")]
pub struct WrongSize {
    /// What the list describes, in the plural.
    pub what: &'static str,
    /// Numbers it has.
    pub found: usize,
    /// Numbers it should have.
    pub expected: usize,
}

impl WrongSize {
    pub(super) fn check(what: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected {
            Ok(())
        } else {
            Err(Self {
                what,
                found,
                expected,
            })
        }
    }
}

/// Unknowns that cannot be put into a vector.
#[derive(Debug, thiserror::Error)]
pub enum MeshOrderError {
    /// There are too few or too many.
    #[error(transparent)]
    Size(#[from] WrongSize),
    /// PETSc failed.
    #[error(transparent)]
    Petsc(#[from] petsc::Error),
}
