//! Who solves the linear systems of the Newton iterations: our condensed solve, or PETSc by itself.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{CallbackError, Failure, Ksp, Matrix, MatrixRef, SnesRef, VectorRef, options};

use super::doubtful::value;
use crate::case::{CaseError, condensed_option as condensed};
use crate::system::{
    CondensedMethod, CondensedSolve, EvaluationError, History, JacobianEntries, SolverChoice,
    System,
};

/// The nonlinear solver whose reduced set the condensed solve works on.
pub(super) const SOLVER: &str = "vinewtonrsls";

/// Options that ask PETSc to solve the linear systems, with what it then needs by default.
const LEFT_TO_PETSC: &str = "pc_type";
/// The preconditioner that solves exactly, by MUMPS where it is there.
const DIRECT: &str = "lu";
const PETSC_DEFAULTS: &[(&str, &str)] = &[
    ("pc_type", "lu"),
    ("ksp_type", "preonly"),
    ("pc_factor_mat_solver_type", "mumps"),
    // In two dimensions approximate minimum degree orders fastest and fills hardly more.
    ("mat_mumps_icntl_7", "0"),
];

/// With a preconditioner that does not factorise exactly.
const ITERATIVE_DEFAULTS: &[(&str, &str)] = &[
    // GMRES stagnates with most of them, see docs/hard-use.md.
    ("ksp_type", "bcgs"),
    ("ksp_max_it", "1000"),
];

/// The direct solver of the condensed system.
const PACKAGE: &str = condensed!("pc_factor_mat_solver_type");
/// The only one that can work by substructures.
const DEFAULT_PACKAGE: &str = "mumps";
/// What it needs by default.
const PACKAGE_DEFAULTS: &[(&str, &str)] = &[
    // METIS where MUMPS has it: the analysis is done once, so the fill counts. Debian's MUMPS has none and orders as it
    // would by itself: AMF for the benchmark, PORD for 680 x 20, where all its orderings are within 4 % in time.
    (condensed!("mat_mumps_icntl_7"), "5"),
    // No permutation by the entries' sizes: the analysis must not depend on the matrix it happens to see first, which
    // after a restart is another one. MUMPS would choose none by itself on the benchmark.
    (condensed!("mat_mumps_icntl_6"), "0"),
    // No scaling: every unknown is a displacement and every row a force, so the entries are of one size already.
    (condensed!("mat_mumps_icntl_8"), "0"),
];

/// For a PETSc without MUMPS, on one rank.
const WITHOUT_MUMPS: &[(&str, &str)] = &[
    (PACKAGE, "petsc"),
    // A long thin sheet is a narrow band.
    (condensed!("pc_factor_mat_ordering_type"), "rcm"),
];
/// PETSc's own factorisation works on one rank: on several, each factorises the whole system.
const WITHOUT_MUMPS_ON_RANKS: &[(&str, &str)] = &[
    (PACKAGE, "petsc"),
    (condensed!("pc_type"), "redundant"),
    (condensed!("redundant_pc_type"), "lu"),
    (condensed!("redundant_pc_factor_mat_ordering_type"), "rcm"),
];

/// A line about the factorisation of a PETSc without MUMPS; none otherwise.
pub(in crate::run) fn report(comm: &SimpleCommunicator) -> petsc::Result<String> {
    if petsc::has_external_package("mumps")? {
        return Ok(String::new());
    }
    let ranks = match comm.size() {
        1 => "",
        _ => ", on each rank for the whole sheet, so more ranks gain little",
    };
    Ok(format!(
        "warning: this PETSc was built without MUMPS: its own factorisation is used{ranks}\n"
    ))
}

/// Options that choose a solver of the whole condensed system.
const CHOOSE_WHOLE: &[&str] = &[
    condensed!("ksp_type"),
    condensed!("pc_type"),
    // Old factors of one part and new ones of the others would fit nothing.
    condensed!("ksp_reuse_preconditioner"),
];

/// Whether the option has the value that this program gave it for the linear solves.
pub(super) fn is_default(name: &str, value: Option<&str>) -> bool {
    PETSC_DEFAULTS
        .iter()
        .chain(ITERATIVE_DEFAULTS)
        .chain(&[(PACKAGE, DEFAULT_PACKAGE)])
        .chain(PACKAGE_DEFAULTS)
        .chain(WITHOUT_MUMPS)
        .chain(WITHOUT_MUMPS_ON_RANKS)
        .any(|(ours, default)| *ours == name && value == Some(*default))
}

/// Options that need the entries of the Jacobian even if our solve is used.
const NEED_ENTRIES: &[&str] = &[
    "ksp_type",
    "snes_test_jacobian",
    "snes_test_jacobian_view",
    "snes_fd",
    "snes_fd_color",
    "snes_mf",
    "snes_mf_operator",
];

/// Options with which a Jacobian is solved with after residuals elsewhere, as with those above, but without its matrix.
const NEED_OLD_ENTRIES: &[&str] = &["snes_lag_jacobian"];

/// The linear solve the options ask for, with the Jacobian it works on.
pub(in crate::run) struct LinearSolve {
    system: Rc<System>,
    entries: RefCell<JacobianEntries>,
    condensed: Option<Rc<CondensedSolve>>,
    /// Whether somebody reads the entries from the matrix.
    reads_matrix: bool,
    /// Whether a residual may begin the next Jacobian: no solve will be with the last one.
    begins_jacobian: bool,
}

impl LinearSolve {
    /// Decides by the options, and sets the defaults of what is chosen. Collective.
    pub fn chosen(system: &Rc<System>) -> petsc::Result<Rc<Self>> {
        let choice = choose(system.comm())?;
        let condensed = choice.map(|choice| CondensedSolve::new(system, choice).map(Rc::new));
        let reads_matrix = choice.is_none() || any_given(NEED_ENTRIES)?;
        Ok(Rc::new(Self {
            reads_matrix,
            begins_jacobian: !reads_matrix && !any_given(NEED_OLD_ENTRIES)?,
            entries: RefCell::new(system.jacobian_entries()),
            condensed: condensed.transpose()?,
            system: Rc::clone(system),
        }))
    }

    /// Our own solve; none if the linear systems are left to PETSc.
    pub fn condensed(&self) -> Option<&Rc<CondensedSolve>> {
        self.condensed.as_ref()
    }

    /// The Jacobian's matrix: without entries if nobody reads them.
    pub fn matrix(&self) -> petsc::Result<Matrix> {
        if self.reads_matrix {
            self.system.matrix()
        } else {
            self.system.placeholder_matrix()
        }
    }

    /// Evaluates the residual at time `t`, unknowns `u` and accelerations `a`. Where the Jacobian is `expected` to be asked
    /// for there, too, what both need is evaluated once. Collective.
    ///
    /// # Errors
    /// As [`System::residual`].
    pub fn residual(
        &self,
        history: &History,
        t: f64,
        (u, a): (&VectorRef, Option<&VectorRef>),
        expected: bool,
        out: &mut VectorRef,
    ) -> Result<(), EvaluationError> {
        let entries = &mut *self.entries.borrow_mut();
        if expected && self.begins_jacobian {
            return self
                .system
                .residual_and_stiffness(history, t, (u, a), entries, out);
        }
        entries.forget();
        self.system.residual(history, t, u, a, out)
    }

    /// Evaluates the Jacobian at time `t` and unknowns `u` for the next solve and, unless it is a placeholder, for
    /// `out`; `shift` is the derivative of the acceleration by the unknown. Collective.
    ///
    /// # Errors
    /// If PETSc fails, or if an element cannot be evaluated: the residual was evaluated there before.
    pub fn evaluate(
        &self,
        history: &History,
        t: f64,
        u: &VectorRef,
        shift: f64,
        out: &mut MatrixRef,
    ) -> Result<(), CallbackError> {
        let mut entries = self.entries.borrow_mut();
        let evaluated = self.system.jacobian(history, t, u, shift, &mut entries);
        // Collective: every rank takes part, whatever happened on it.
        if out.takes_values()? {
            out.set_values_coo(entries.values())?;
        }
        evaluated.map_err(|error| match error {
            EvaluationError::Petsc(error) => error.into(),
            EvaluationError::Element(failure) => {
                format!("the tangent cannot be evaluated where the residual was: {failure}").into()
            }
        })
    }

    /// Makes the nonlinear solver use it. Call it before the solver reads its options.
    pub fn install(self: &Rc<Self>, snes: &mut SnesRef) -> petsc::Result<()> {
        if self.condensed.is_none() {
            return Ok(());
        }
        snes.ksp_mut()?.set_type("preonly")?;
        let (for_setup, for_apply) = (Rc::clone(self), Rc::clone(self));
        snes.set_shell_preconditioner(
            move |snes, _| match &for_setup.condensed {
                Some(condensed)
                    if !condensed.factor(&for_setup.entries.borrow(), &snes.active_set()?)? =>
                {
                    Err(Failure::Domain)
                }
                _ => Ok(()),
            },
            move |r, step| match &for_apply.condensed {
                Some(condensed) => Ok(condensed.solve(r, step)?),
                None => Ok(()),
            },
        )
    }

    /// Lets the solver read its options where it factorises, for a state of the sheet at rest. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn read_options(&self, u: &VectorRef, shift: f64) -> Result<(), CallbackError> {
        let history = History::virgin(self.system.local());
        let mut matrix = self.matrix()?;
        self.evaluate(&history, 0.0, u, shift, &mut matrix)?;
        match &self.condensed {
            Some(condensed) => {
                condensed.factor(&self.entries.borrow(), &[])?;
            }
            None => {
                let mut solver = Ksp::new(self.system.comm())?;
                solver.set_operator(&matrix)?;
                solver.set_from_options()?;
                solver.set_up()?;
            }
        }
        Ok(())
    }

    /// The package that factorises.
    pub fn factor_solver(&self, snes: &SnesRef) -> petsc::Result<Option<String>> {
        match &self.condensed {
            Some(condensed) => condensed.factor_solver(),
            None => snes.ksp()?.factor_solver(),
        }
    }
}

/// How the condensed solve is to be done by the options; none if they leave the linear systems to PETSc. Sets the
/// defaults of what is chosen.
fn choose(comm: &SimpleCommunicator) -> petsc::Result<Option<SolverChoice>> {
    let mumps = petsc::has_external_package("mumps")?;
    if left_to_petsc()? {
        if value(LEFT_TO_PETSC)?.is_some_and(|given| given != DIRECT) {
            set_defaults(ITERATIVE_DEFAULTS)?;
            return Ok(None);
        }
        let about_mumps =
            |(name, value): &(&str, &str)| name.contains("mumps") || *value == "mumps";
        let usable = PETSC_DEFAULTS
            .iter()
            .filter(|option| mumps || !about_mumps(option));
        set_defaults(usable)?;
        return Ok(None);
    }
    if !mumps {
        set_defaults(match comm.size() {
            1 => WITHOUT_MUMPS,
            _ => WITHOUT_MUMPS_ON_RANKS,
        })?;
    }
    options::set_default(PACKAGE, DEFAULT_PACKAGE)?;
    let mut method = CondensedMethod::Whole;
    if options::get(PACKAGE)?.as_deref() == Some(DEFAULT_PACKAGE) {
        set_defaults(PACKAGE_DEFAULTS)?;
        if !any_given(CHOOSE_WHOLE)? {
            method = CondensedMethod::Substructures;
        }
    }
    Ok(Some(SolverChoice {
        method,
        options_prefix: condensed!(""),
    }))
}

/// Why a run whose linear systems are left to PETSc has no derivatives.
pub(in crate::run) fn no_derivatives(name: &'static str) -> CaseError {
    CaseError::NoDerivative {
        name,
        reason: "the linear systems are left to PETSc, and derivatives need the program's own solve; leave out \
                 -sensitivity, or -pc_type and -snes_type"
            .to_owned(),
    }
}

/// Whether the linear solver of the Newton iterations applies its preconditioner once.
pub(super) fn is_direct() -> petsc::Result<bool> {
    let method = value("ksp_type")?;
    let iterative = value(LEFT_TO_PETSC)?.is_some_and(|given| given != DIRECT);
    Ok(method.map_or(!iterative, |method| method == "preonly"))
}

/// Whether the options leave the linear systems to PETSc.
pub(in crate::run) fn left_to_petsc() -> petsc::Result<bool> {
    let other_solver = value("snes_type")?.is_some_and(|given| given != SOLVER);
    Ok(options::is_given(LEFT_TO_PETSC)? || other_solver)
}

/// Whether the user has given one of these options.
fn any_given(names: &[&str]) -> petsc::Result<bool> {
    for name in names {
        if options::is_given(name)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Where the user has not chosen.
fn set_defaults<'a>(
    defaults: impl IntoIterator<Item = &'a (&'a str, &'a str)>,
) -> petsc::Result<()> {
    for (name, value) in defaults {
        options::set_default(name, value)?;
    }
    Ok(())
}
