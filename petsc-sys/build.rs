//! Finds PETSc, says what it is, and generates the bindings to it.
//!
//! To crates that depend on this one directly go `DEP_PETSC_VERSION` (as 3.22.5), `DEP_PETSC_LIBRARY` (the folder of a
//! library that the loader does not find by itself) and `DEP_PETSC_MUMPS` (1 if it was built with MUMPS).

use std::{
    env,
    error::Error,
    path::{Path, PathBuf},
};

#[path = "build/facts.rs"]
mod facts;
#[path = "build/find.rs"]
mod find;

use facts::Facts;

/// PETSc functions the bindings hold, as regular expressions. A short list keeps the build at a
/// few seconds: all of PETSc's headers take half a minute.
const FUNCTIONS: &[&str] = &[
    // System: start and end, errors, options, logging, objects.
    "Petsc(Initialize|Initialized|Finalize|Finalized)",
    "PetscGetVersionNumber|PetscHasExternalPackage",
    "PetscPushErrorHandler|PetscErrorMessage",
    "PetscOptions(SetValue|ClearValue|FindPair|Used|LeftGet|LeftRestore|GetAll)",
    "PetscLog(EventRegister|StageRegister|StagePush|StagePop)",
    "petsc_rs_.*", // what is a macro in C or has changed its name: src/shim.h
    "PetscObject(GetComm|Compose|Query)",
    "PetscContainer(Create|Destroy|SetPointer)",
    // Index sets and vectors.
    "IS(CreateGeneral|Destroy|GetIndices|RestoreIndices|GetLocalSize)",
    "Vec(Create|CreateSeq|Destroy|Duplicate|SetSizes|SetType)",
    "VecGet(Array|ArrayRead|LocalSize|Size|OwnershipRange)",
    "VecRestore(Array|ArrayRead)",
    "Vec(Set|Copy|AXPY|AXPBY|AYPX|WAXPY|Scale|Dot|Norm|Sum|PlaceArray|ResetArray)",
    "VecScatter(Create|Destroy|Begin|End)",
    // Matrices and factorisations.
    "Mat(Create|Destroy|Duplicate|SetSizes|SetType|SetOption)",
    "Mat(SetPreallocationCOO|SetValuesCOO|AssemblyBegin|AssemblyEnd|ZeroRowsColumns)",
    "Mat(GetRow|RestoreRow|GetInfo|Mult)",
    "Mat(Copy|GetFactor|GetOrdering|LUFactorSymbolic|LUFactorNumeric|Solve)",
    "Mat(FactorGetError|FactorClearError)",
    "MatCreateShell|MatShellSetOperation",
    "Mat(FactorSetSchurIS|FactorCreateSchurComplement|SetOptionsPrefixFactor)",
    "Mat(FactorGetSchurComplement|FactorRestoreSchurComplement|SetFactorType|SetOperation)",
    "Mat(CholeskyFactorSymbolic|CholeskyFactorNumeric|DenseGetArrayRead|DenseRestoreArrayRead|DenseGetLDA)",
    "Mat(CreateDense|DenseGetArray|DenseRestoreArray|GetSize|GetLocalSize)",
    // Linear solvers.
    "KSP(Create|Destroy|SetOperators|SetFromOptions|SetOptionsPrefix|SetType|GetPC|SetUp|Solve|MatSolve)",
    "KSP(GetConvergedReason|GetIterationNumber)",
    "PC(SetType|GetType|GetOperators|SetFailedReason|FactorGetMatSolverType)",
    "PCShell(SetContext|GetContext|SetSetUp|SetApply)",
    // Nonlinear solvers.
    "SNES(Create|Destroy|SetType|GetType|SetOptionsPrefix|GetOptionsPrefix|SetFromOptions|Solve)",
    "SNES(SetFunction|SetJacobian|GetJacobian|GetFunction|GetSolution|ComputeFunction)",
    "SNES(SetFunctionDomainError|SetComputeInitialGuess|SetUpdate|MonitorSet)",
    "SNES(SetConvergenceTest|ConvergedDefault|GetConvergedReason|GetIterationNumber)",
    "SNES(GetLinearSolveIterations|GetNumberFunctionEvals|GetFunctionNorm)",
    "SNES(GetKSP|GetLineSearch|VISetVariableBounds|VIGetActiveSetIS)",
    "SNESSetMaxLinearSolveFailures",
    "SNESLineSearch(SetType|GetVecs|GetNorms|SetNorms|SetLambda)",
    "SNESLineSearch(GetSNES|SetReason|PreCheck)",
    // Time integration.
    "TS(Create|Destroy|SetType|GetType|SetProblemType|SetOptionsPrefix|SetFromOptions|Solve)",
    "TSSet(FunctionDomainError|I2Function|I2Jacobian|IFunction|IJacobian|Solution|PreStep|PreStage|PostStage|PostStep)",
    "TS(MonitorSet|GetSNES|GetAdapt|GetTime|SetTime|GetTimeStep|SetTimeStep|GetMaxTime|SetMaxTime)",
    "TS(GetMaxSteps|SetMaxSteps|GetStepNumber|SetStepNumber|GetSNESFailures|GetStepRejections)",
    "TS(GetSNESIterations|GetKSPIterations|SetMaxSNESFailures|SetMaxStepRejections|RestartStep)",
    "TS(SetErrorIfStepFails|SetExactFinalTime|GetExactFinalTime|GetConvergedReason|SetConvergedReason|GetPrevTime)",
    "TS(GetSolution|2GetSolution|2SetSolution|Alpha2SetRadius|Alpha2SetParams|Alpha2GetParams)",
    "TSAdaptSetScaleSolveFailed",
    // Optimisation.
    "Tao(Create|Destroy|SetType|SetFromOptions|SetSolution|SetVariableBounds|SetTolerances|Solve)",
    "Tao(SetResidualRoutine|SetJacobianResidualRoutine|GetConvergedReason|GetIterationNumber)",
];

/// PETSc's globals and constants the bindings hold.
const VARIABLES: &[&str] = &[
    "petsc_rs_err_user|PETSC_(DECIDE|DETERMINE)",
    "PETSC_VERSION_(MAJOR|MINOR|SUBMINOR)",
    "PetscTrFree",
    "MAT(AIJ|SOLVERMUMPS|SOLVERPETSC|ORDERINGND)|VECSTANDARD|PCSHELL|SNESLINESEARCHSHELL",
    "TS(ALPHA2|BEULER)",
    "TAOBRGN",
];

/// Types used by no listed function's signature.
const TYPES: &[&str] = &[
    "MatOption",
    "MatReuse",
    "SNESLineSearchReason",
    "TSExactFinalTimeOption",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    println!("cargo::rerun-if-changed=src");
    if let Err(error) = build() {
        // One sentence instead of the text of a panic.
        println!("cargo::error={error}");
        std::process::exit(1);
    }
}

fn build() -> Result<(), Box<dyn Error>> {
    let place = find::petsc()?;
    let mpi = build_probe_mpi::probe().map_err(|_| {
        "no MPI was found: mpicc (or the compiler that the variable MPICC names) must be on the PATH"
    })?;
    let include: Vec<&Path> = (place.include.iter().chain(&mpi.include_paths))
        .map(PathBuf::as_path)
        .collect();
    let facts = Facts::read(&place.include)?;
    facts.require_supported()?;
    for line in facts.cargo_lines(&place.rpath) {
        println!("{line}");
    }

    let mut shim = cc::Build::new();
    shim.file("src/shim.c").includes(&include);
    shim.try_compile("petsc_rs_shim").map_err(|error| {
        format!(
            "the C compiler does not accept PETSc's headers in {}; is it built with the MPI whose mpicc \
             is on the PATH? ({error})",
            place.include.first().map_or(Path::new("?"), PathBuf::as_path).display()
        )
    })?;
    for line in &place.link {
        println!("{line}"); // after the shim, which needs the library
    }

    let mut builder = bindgen::builder()
        .header("src/shim.h")
        .clang_args(include.iter().map(|path| format!("-I{}", path.display())))
        .blocklist_item("MPI_.*|ompi_.*|PMPI_.*")
        .blocklist_item("_IO_.*|FILE|va_list|__va_list_tag|__builtin_va_list")
        .default_enum_style(bindgen::EnumVariation::NewType {
            is_bitfield: false,
            is_global: true,
        })
        .prepend_enum_name(false)
        .generate_cstr(true)
        .generate_comments(false)
        .derive_default(true)
        .layout_tests(false);
    for function in FUNCTIONS {
        builder = builder.allowlist_function(function);
    }
    for variable in VARIABLES {
        builder = builder.allowlist_var(variable);
    }
    for name in TYPES {
        builder = builder.allowlist_type(name);
    }
    builder
        .generate()?
        .write_to_file(PathBuf::from(env::var("OUT_DIR")?).join("petsc.rs"))?;
    Ok(())
}
