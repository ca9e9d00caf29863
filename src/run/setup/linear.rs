//! Who solves the linear systems of the Newton iterations: our condensed solve, or PETSc by itself.

use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Failure, Matrix, SnesRef, options};

use crate::system::{CondensedSolve, System};

/// The nonlinear solver whose reduced set the condensed solve works on.
const SOLVER: &str = "vinewtonrsls";

/// Options that ask PETSc to solve the linear systems, with what it then needs by default.
const LEFT_TO_PETSC: &str = "pc_type";
const PETSC_DEFAULTS: &[(&str, &str)] = &[
    ("ksp_type", "preonly"),
    ("pc_type", "lu"),
    ("pc_factor_mat_solver_type", "mumps"),
    // In two dimensions approximate minimum degree orders fastest and fills hardly more.
    ("mat_mumps_icntl_7", "0"),
];

/// The direct solver of the condensed system.
const PACKAGE: &str = "condensed_pc_factor_mat_solver_type";
const DEFAULT_PACKAGE: &str = "mumps";
/// What it needs by default.
const PACKAGE_DEFAULTS: &[(&str, &str)] = &[
    // METIS where MUMPS has it: the analysis is done once, so the fill counts. Debian's MUMPS has none and orders as it
    // would by itself: AMF for the benchmark, PORD for 680 x 20, where all its orderings are within 4 % in time.
    ("condensed_mat_mumps_icntl_7", "5"),
    // No permutation by the entries' sizes: the analysis must not depend on the matrix it happens to see first, which
    // after a restart is another one. MUMPS would choose none by itself on the benchmark.
    ("condensed_mat_mumps_icntl_6", "0"),
];

/// For a PETSc without MUMPS, on one rank.
const WITHOUT_MUMPS: &[(&str, &str)] = &[
    (PACKAGE, "petsc"),
    // A long thin sheet is a narrow band.
    ("condensed_pc_factor_mat_ordering_type", "rcm"),
];
/// PETSc's own factorisation works on one rank: on several, each factorises the whole system.
const WITHOUT_MUMPS_ON_RANKS: &[(&str, &str)] = &[
    (PACKAGE, "petsc"),
    ("condensed_pc_type", "redundant"),
    ("condensed_redundant_pc_type", "lu"),
    ("condensed_redundant_pc_factor_mat_ordering_type", "rcm"),
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

/// Puts the choice for a PETSc without MUMPS into the option database, where the user has not chosen.
fn do_without_mumps(comm: &SimpleCommunicator) -> petsc::Result<()> {
    let choice = if comm.size() == 1 {
        WITHOUT_MUMPS
    } else {
        WITHOUT_MUMPS_ON_RANKS
    };
    for (name, value) in choice {
        options::set_default(name, value)?;
    }
    Ok(())
}

/// Whether the option has the value that this program gave it for the linear solves.
pub(super) fn is_default(name: &str, value: Option<&str>) -> bool {
    PETSC_DEFAULTS
        .iter()
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

/// The linear solve the options ask for.
pub(in crate::run) struct LinearSolve {
    condensed: Option<Rc<CondensedSolve>>,
}

impl LinearSolve {
    /// Decides by the options, and gives PETSc's own solve its defaults. Collective.
    pub fn chosen(system: &Rc<System>) -> petsc::Result<Self> {
        let mumps = petsc::has_external_package("mumps")?;
        let other_solver = options::get("snes_type")?.is_some_and(|given| given != SOLVER);
        if options::is_given(LEFT_TO_PETSC)? || other_solver {
            for (name, value) in PETSC_DEFAULTS {
                if mumps || !(name.contains("mumps") || *value == "mumps") {
                    options::set_default(name, value)?;
                }
            }
            return Ok(Self { condensed: None });
        }
        if !mumps {
            do_without_mumps(system.comm())?;
        }
        options::set_default(PACKAGE, DEFAULT_PACKAGE)?;
        if options::get(PACKAGE)?.as_deref() == Some(DEFAULT_PACKAGE) {
            for (name, value) in PACKAGE_DEFAULTS {
                options::set_default(name, value)?;
            }
        }
        let condensed = CondensedSolve::new(Rc::clone(system))?;
        Ok(Self {
            condensed: Some(Rc::new(condensed)),
        })
    }

    /// The Jacobian's matrix: without entries if nobody reads them.
    pub fn matrix(&self, system: &System) -> petsc::Result<Matrix> {
        let mut read = self.condensed.is_none();
        for name in NEED_ENTRIES {
            read |= options::is_given(name)?;
        }
        if read {
            system.matrix()
        } else {
            system.placeholder_matrix()
        }
    }

    /// Makes the nonlinear solver use it. Call it before the solver reads its options.
    pub fn install(&self, snes: &mut SnesRef) -> petsc::Result<()> {
        let Some(condensed) = &self.condensed else {
            return Ok(());
        };
        snes.ksp_mut()?.set_type("preonly")?;
        let (for_setup, for_apply) = (Rc::clone(condensed), Rc::clone(condensed));
        snes.set_shell_preconditioner(
            move |snes, _| {
                if for_setup.factor(&snes.active_set()?)? {
                    Ok(())
                } else {
                    Err(Failure::Domain)
                }
            },
            move |r, step| Ok(for_apply.solve(r, step)?),
        )
    }

    /// The package that factorises.
    pub fn factor_solver(&self, snes: &SnesRef) -> petsc::Result<Option<String>> {
        match &self.condensed {
            Some(condensed) => condensed.factor_solver(),
            None => snes.ksp()?.factor_solver(),
        }
    }
}
