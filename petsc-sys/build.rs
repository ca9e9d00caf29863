//! Finds PETSc with pkg-config, hands its version on, and generates the bindings.

use std::{env, error::Error, path::PathBuf};

/// PETSc functions the bindings hold, as regular expressions. A short list keeps the build at a
/// few seconds: all of PETSc's headers take half a minute.
const FUNCTIONS: &[&str] = &[
    // System: start and end, errors, options, logging, objects.
    "Petsc(Initialize|Initialized|Finalize|Finalized)",
    "PetscGetVersionNumber|PetscHasExternalPackage|PetscMemoryGetCurrentUsage",
    "PetscPushErrorHandler|PetscPopErrorHandler|PetscErrorMessage",
    "PetscOptions(SetValue|ClearValue|HasName|FindPair|Used|LeftGet|LeftRestore|GetAll|InsertFile|InsertString)",
    "PetscLog(EventRegister|StageRegister|StagePush|StagePop)",
    "PetscLog(Push|Pop)CurrentEvent_Internal",
    "PetscObject(Reference|Dereference|GetComm|Compose|Query|GetOptionsPrefix|SetName|TypeCompare)",
    "PetscContainer(Create|Destroy|GetPointer|SetPointer|SetUserDestroy)",
    // Index sets and vectors.
    "IS(CreateGeneral|Destroy|GetIndices|RestoreIndices|GetLocalSize)",
    "Vec(Create|CreateSeq|CreateMPI|Destroy|Duplicate|SetSizes|SetType|SetFromOptions)",
    "VecGet(Array|ArrayRead|LocalSize|Size|OwnershipRange)",
    "VecRestore(Array|ArrayRead)",
    "Vec(Set|Copy|AXPY|AXPBY|AYPX|WAXPY|Scale|Dot|Norm|Sum|PlaceArray|ResetArray|PointwiseMult)",
    "VecScatter(Create|Destroy|Begin|End)",
    // Matrices and factorisations.
    "Mat(Create|Destroy|Duplicate|SetSizes|SetType|SetOption|SetOptionsPrefix|SetFromOptions|SetUp)",
    "Mat(SetPreallocationCOO|SetValuesCOO|AssemblyBegin|AssemblyEnd|ZeroEntries|ZeroRowsColumns)",
    "Mat(GetLocalSize|GetSize|GetOwnershipRange|GetRow|RestoreRow|GetInfo|Norm|Mult|MultTranspose)",
    "Mat(Copy|Scale|Shift|AXPY|GetDiagonal|CreateVecs|GetFactor|LUFactorSymbolic|LUFactorNumeric|Solve)",
    "Mat(FactorInfoInitialize|FactorGetSolverType|FactorGetError|FactorClearError)",
    "MatCreateShell|MatShellSetOperation",
    "Mat(FactorSetSchurIS|FactorCreateSchurComplement|SetOptionsPrefixFactor)",
    "Mat(CholeskyFactorSymbolic|CholeskyFactorNumeric|DenseGetArrayRead|DenseRestoreArrayRead|DenseGetLDA)",
    "MatMumps(SetIcntl|GetIcntl|GetInfo|GetInfog|GetRinfog|SetCntl)",
    // Linear solvers.
    "KSP(Create|Destroy|SetOperators|SetFromOptions|SetOptionsPrefix|SetType|GetPC|SetUp|Solve|Reset)",
    "KSP(GetConvergedReason|GetIterationNumber|GetResidualNorm|SetTolerances)",
    "PC(FactorSetMatOrderingType|RedundantGetKSP)",
    "PC(SetType|GetType|GetOperators|SetFailedReason|FactorGetMatSolverType|FactorSetMatSolverType)",
    "PCShell(SetContext|GetContext|SetSetUp|SetApply|SetName)",
    // Nonlinear solvers.
    "SNES(Create|Destroy|SetType|GetType|SetOptionsPrefix|GetOptionsPrefix|SetFromOptions|SetUp|Solve)",
    "SNES(SetFunction|SetJacobian|GetJacobian|GetFunction|GetSolution|GetSolutionUpdate|ComputeFunction)",
    "SNES(SetFunctionDomainError|GetFunctionDomainError|SetComputeInitialGuess|SetUpdate|MonitorSet)",
    "SNES(SetConvergenceTest|ConvergedDefault|GetConvergedReason|SetConvergedReason|GetIterationNumber)",
    "SNES(GetLinearSolveIterations|GetNumberFunctionEvals|GetFunctionNorm|SetTolerances|GetTolerances)",
    "SNES(GetKSP|GetLineSearch|VISetVariableBounds|VIGetActiveSetIS)",
    "SNESSet(MaxLinearSolveFailures|MaxNonlinearStepFailures|LagJacobian|LagPreconditioner|ForceIteration)",
    "SNESLineSearch(SetType|GetType|ShellSetUserFunc|GetVecs|GetNorms|SetNorms|GetLambda|SetLambda)",
    "SNESLineSearch(GetSNES|SetReason|GetVIFunctions|ComputeNorms|PreCheck|PostCheck)",
    // Time integration.
    "TS(Create|Destroy|SetType|GetType|SetProblemType|SetOptionsPrefix|SetFromOptions|SetUp|Solve)",
    "TSSet(FunctionDomainError|I2Function|I2Jacobian|IFunction|IJacobian|Solution|PreStep|PreStage|PostStage|PostStep)",
    "TS(MonitorSet|GetSNES|GetAdapt|GetTime|SetTime|GetTimeStep|SetTimeStep|GetMaxTime|SetMaxTime)",
    "TS(GetMaxSteps|SetMaxSteps|GetStepNumber|SetStepNumber|GetSNESFailures|GetStepRejections)",
    "TS(GetSNESIterations|GetKSPIterations|SetMaxSNESFailures|SetMaxStepRejections|RestartStep)",
    "TS(SetErrorIfStepFails|SetExactFinalTime|GetExactFinalTime|GetConvergedReason|SetConvergedReason|GetPrevTime)",
    "TS(GetSolution|2GetSolution|2SetSolution|Alpha2SetRadius|Alpha2SetParams|Alpha2GetParams)",
    "TSAdapt(SetType|GetType|SetScaleSolveFailed|GetScaleSolveFailed|SetStepLimits|GetStepLimits)",
];

/// PETSc's globals and constants the bindings hold.
const VARIABLES: &[&str] = &[
    "PETSC_(ERR_USER|ERR_MIN_VALUE|ERR_MAX_VALUE|DECIDE|DETERMINE|DEFAULT|CURRENT)",
    "PETSC_VERSION_(MAJOR|MINOR|SUBMINOR)",
    "PetscLogPLB|PetscLogPLE|petsc_stageLog|PetscTrFree",
    "MAT(AIJ|SOLVERMUMPS|SOLVERPETSC)|VECSTANDARD|PC(SHELL|LU)|KSPPREONLY|SNESLINESEARCHSHELL",
    "TS(ALPHA2|BEULER)|TSADAPT(NONE|BASIC)|SNES(NEWTONLS|VINEWTONRSLS|VINEWTONSSLS)",
];

/// Types used by no listed function's signature.
const TYPES: &[&str] = &[
    "MatOption",
    "MatReuse",
    "SNESLineSearchReason",
    "TSExactFinalTimeOption",
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=src/petsc.h");

    let petsc = pkg_config::Config::new()
        .range_version("3.18".."3.19") // enumerations and VI details below are those of 3.18
        .probe("petsc")?;
    println!("cargo:version={}", petsc.version);

    let mpi = build_probe_mpi::probe().map_err(|errors| format!("no MPI found: {errors:?}"))?;
    let include = petsc.include_paths.iter().chain(&mpi.include_paths);

    let mut builder = bindgen::builder()
        .header("src/petsc.h")
        .clang_args(include.map(|path| format!("-I{}", path.display())))
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
