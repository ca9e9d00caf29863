//! Factors that leave some unknowns over, for somebody else to solve: the part of one rank in a solve by substructures.

use std::{
    cell::Cell,
    ffi::{c_int, c_void},
    ptr::{self, NonNull},
    rc::Rc,
    slice,
};

use petsc_sys as sys;

use crate::{
    CallbackError, FactorKind, Factorization, VectorRef,
    callback::{run, table},
    error::{Error, Result, check},
    factorization::without_mumps,
    matrix::MatrixRef,
    session::c_string,
    vector::index,
};

type SolveKept<'a> = dyn FnMut(&mut [f64]) -> std::result::Result<(), CallbackError> + 'a;

/// Who solves for the kept unknowns while a solve is under way: a pointer to a `&mut SolveKept`.
#[derive(Default)]
struct KeptTable {
    solve: Cell<Option<NonNull<c_void>>>,
}

/// # Safety
/// `schur` is alive.
unsafe fn kept_table(schur: sys::Mat) -> Result<Rc<KeptTable>> {
    // SAFETY: a live object, and a name used for this type only.
    unsafe { table(schur.cast(), c"petsc.rs: solve of the kept unknowns") }
}

impl Factorization {
    /// Analyses the pattern of a matrix on one rank, of which the unknowns `kept` are not eliminated: what
    /// is left for them is [`Factorization::schur_complement`], and [`Factorization::solve_with`] asks for their
    /// solution in the middle of a solve.
    ///
    /// # Errors
    /// If MUMPS is missing, the matrix is distributed, or the analysis fails.
    pub fn keeping(
        matrix: &MatrixRef,
        kind: FactorKind,
        kept: &[i32],
        prefix: &str,
    ) -> Result<Self> {
        let prefix = c_string(prefix)?;
        // SAFETY: a live matrix and a C string, which PETSc copies.
        check(unsafe { sys::MatSetOptionsPrefixFactor(matrix.raw(), prefix.as_ptr()) })?;
        let mut this = Self::begin(matrix, kind)?;
        if !this.mumps {
            return Err(without_mumps());
        }
        this.kept = kept.len();
        let mut set = ptr::null_mut();
        // SAFETY: a live factor; the index set copies the array, is referred to by nobody after the call
        // that copies it in turn, and is destroyed once.
        unsafe {
            check(sys::ISCreateGeneral(
                mpi_sys::RSMPI_COMM_SELF,
                index(kept.len())?,
                kept.as_ptr(),
                sys::PETSC_COPY_VALUES,
                &mut set,
            ))?;
            let taken = check(sys::MatFactorSetSchurIS(this.raw, set));
            check(sys::ISDestroy(&mut set))?;
            taken?;
        }
        this.analyse(matrix)?;
        // Forward, the kept unknowns, backward; whatever the options say.
        // SAFETY: a live MUMPS factor.
        check(unsafe { sys::petsc_rs_mumps_set_icntl(this.raw, 26, -1) })?;
        Ok(this)
    }

    /// What the eliminated unknowns leave for the kept ones, row by row in the order they were given.
    ///
    /// # Errors
    /// If there are no usable factors or the length of `out` is not the square of the kept unknowns.
    pub fn schur_complement(&self, out: &mut [f64]) -> Result<()> {
        if !self.is_ready() || out.len() != self.kept * self.kept {
            return Err(Error::usage("no Schur complement of this size"));
        }
        let (mut matrix, mut data, mut stride) = (ptr::null_mut(), ptr::null(), 0);
        // SAFETY: a live MUMPS factor; PETSc writes a new dense matrix of kept x kept numbers, stored by
        // columns, which is destroyed here; its array is read between loan and return.
        unsafe {
            let none = ptr::null_mut();
            check(sys::MatFactorCreateSchurComplement(
                self.raw,
                &mut matrix,
                none,
            ))?;
            check(sys::MatDenseGetLDA(matrix, &mut stride))?;
            check(sys::MatDenseGetArrayRead(matrix, &mut data))?;
            let stride = usize::try_from(stride).unwrap_or(self.kept);
            for (i, row) in out.chunks_exact_mut(self.kept.max(1)).enumerate() {
                for (j, value) in row.iter_mut().enumerate() {
                    *value = *data.add(j * stride + i);
                }
            }
            check(sys::MatDenseRestoreArrayRead(matrix, &mut data))?;
            check(sys::MatDestroy(&mut matrix))
        }
    }

    /// Solves `A x = b` with the last factors, the kept unknowns by `solve_kept`: it is given what the eliminated
    /// ones leave of their right-hand side, b_K - A_KE A_EE^-1 b_E, in the order of `kept`, and puts their solution
    /// in its place; the eliminated unknowns follow from that. That is one forward and one backward substitution. Without
    /// kept unknowns `solve_kept` is not called. Collective.
    ///
    /// # Errors
    /// If there are no usable factors, the layouts do not fit, or `solve_kept` fails.
    pub fn solve_with(
        &self,
        b: &VectorRef,
        x: &mut VectorRef,
        mut solve_kept: impl FnMut(&mut [f64]) -> std::result::Result<(), CallbackError>,
    ) -> Result<()> {
        if self.kept == 0 {
            return self.substitute(b, x);
        }
        let mut closure: &mut SolveKept = &mut solve_kept;
        // SAFETY: the complement lives as long as its factor.
        let table = unsafe { kept_table(self.kept_matrix()?)? };
        table.solve.set(Some(NonNull::from(&mut closure).cast()));
        let solved = self.substitute(b, x);
        table.solve.set(None);
        solved
    }

    /// Makes PETSc ask [`on_solve`] where it would factorise the complement and solve with that: the complement passes for
    /// factorised, with a solve of its own. PETSc forgets so with every factorisation.
    pub(crate) fn hand_over_kept(&self) -> Result<()> {
        let mut schur = self.kept_matrix()?;
        // SAFETY: a live factor and its complement; PETSc calls the function with the signature that belongs to
        // the operation.
        unsafe {
            let function: OnSolve = on_solve;
            let function = std::mem::transmute::<OnSolve, unsafe extern "C" fn()>(function);
            check(sys::MatSetOperation(
                schur,
                sys::MATOP_MAT_SOLVE,
                Some(function),
            ))?;
            check(sys::MatSetFactorType(schur, sys::MAT_FACTOR_LU))?;
            check(sys::MatFactorRestoreSchurComplement(
                self.raw,
                &mut schur,
                sys::MAT_FACTOR_SCHUR_FACTORED,
            ))
        }
    }

    /// PETSc's own matrix for the kept unknowns, which the factor owns.
    fn kept_matrix(&self) -> Result<sys::Mat> {
        let (mut schur, none) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: a live factor with kept unknowns; one pointer to write, and a null one for what is not wanted.
        check(unsafe { sys::MatFactorGetSchurComplement(self.raw, &mut schur, none) })?;
        Ok(schur)
    }
}

type OnSolve = unsafe extern "C" fn(sys::Mat, sys::Mat, sys::Mat) -> c_int;

/// Finds the solution of the kept unknowns, in dense matrices of one column that may be the same.
unsafe extern "C" fn on_solve(schur: sys::Mat, right_side: sys::Mat, solution: sys::Mat) -> c_int {
    run(schur.cast(), || {
        let (mut rows, mut columns) = (0, 0);
        let (mut given, mut found) = (ptr::null(), ptr::null_mut());
        // SAFETY: PETSc's live objects; numbers and pointers to write. The closure is on the stack of `solve_with`,
        // which waits for PETSc, and is taken out, so nobody else has it. The arrays have `rows` numbers; where they are
        // the same one, only the mutable slice is used.
        unsafe {
            let closure = (kept_table(schur)?.solve.take())
                .filter(|_| {
                    check(sys::MatGetSize(solution, &mut rows, &mut columns)).is_ok()
                        && columns == 1
                })
                .ok_or_else(|| {
                    Error::usage("the kept unknowns are solved for one right-hand side at a time")
                })?;
            check(sys::MatDenseGetArrayRead(right_side, &mut given))?;
            check(sys::MatDenseGetArray(solution, &mut found))?;
            let size = usize::try_from(rows)?;
            if !ptr::eq(given, found) {
                ptr::copy_nonoverlapping(given, found, size);
            }
            let solved =
                closure.cast::<&mut SolveKept>().as_mut()(slice::from_raw_parts_mut(found, size));
            check(sys::MatDenseRestoreArray(solution, &mut found))?;
            check(sys::MatDenseRestoreArrayRead(right_side, &mut given))?;
            solved
        }
    })
}
