//! Why a solver stopped, in plain words.

use std::fmt;

use petsc_sys as sys;

macro_rules! reasons {
    (
        $(#[$doc:meta])* $name:ident($raw:ident);
        $($variant:ident = $value:ident, $sentence:literal;)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name {
            $(#[doc = $sentence] $variant,)*
            /// A value this crate does not know.
            Unknown(i32),
        }

        impl $name {
            #[allow(unreachable_patterns, reason = "PETSc 3.19 has made one value of two reasons")]
            pub(crate) fn from_raw(raw: sys::$raw) -> Self {
                match raw {
                    $(sys::$value => Self::$variant,)*
                    sys::$raw(value) => Self::Unknown(value),
                }
            }

            #[allow(dead_code, reason = "not every reason can be set")]
            pub(crate) fn to_raw(self) -> sys::$raw {
                match self {
                    $(Self::$variant => sys::$value,)*
                    Self::Unknown(value) => sys::$raw(value),
                }
            }

            /// Whether the solver has finished with success.
            pub fn is_converged(self) -> bool {
                self.to_raw().0 > 0
            }

            /// Whether the solver has given up.
            pub fn is_diverged(self) -> bool {
                self.to_raw().0 < 0
            }

            /// The reason in plain words, without a full stop.
            pub fn sentence(self) -> &'static str {
                match self {
                    $(Self::$variant => $sentence,)*
                    Self::Unknown(_) => "PETSc gave a reason that is not known here",
                }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.sentence())
            }
        }
    };
}

reasons! {
    /// Why the nonlinear solver stopped.
    SnesReason(SNESConvergedReason);
    Iterating = SNES_CONVERGED_ITERATING, "the nonlinear solver is still at work";
    ConvergedAbsolute = SNES_CONVERGED_FNORM_ABS,
        "the residual norm is below the absolute tolerance";
    ConvergedRelative = SNES_CONVERGED_FNORM_RELATIVE,
        "the residual norm has fallen by the relative tolerance";
    ConvergedStep = SNES_CONVERGED_SNORM_RELATIVE,
        "the Newton step is small compared with the solution";
    ConvergedIterations = SNES_CONVERGED_ITS,
        "the prescribed number of iterations is done";
    DivergedFunctionDomain = SNES_DIVERGED_FUNCTION_DOMAIN,
        "the residual cannot be computed at the new iterate";
    DivergedFunctionCount = SNES_DIVERGED_FUNCTION_COUNT,
        "the allowed number of residual evaluations is used up";
    DivergedLinearSolve = SNES_DIVERGED_LINEAR_SOLVE,
        "the linear solver failed";
    DivergedNan = SNES_DIVERGED_FNORM_NAN,
        "the residual norm is not a number";
    DivergedIterations = SNES_DIVERGED_MAX_IT,
        "the allowed number of iterations is used up";
    DivergedLineSearch = SNES_DIVERGED_LINE_SEARCH,
        "the line search found no better point";
    DivergedInner = SNES_DIVERGED_INNER,
        "the inner solver failed";
    DivergedLocalMinimum = SNES_DIVERGED_LOCAL_MIN,
        "the residual norm has a local minimum that is not zero";
    DivergedTolerance = SNES_DIVERGED_DTOL,
        "the residual norm has grown beyond the divergence tolerance";
    DivergedJacobianDomain = SNES_DIVERGED_JACOBIAN_DOMAIN,
        "the tangent matrix cannot be computed at the iterate";
    DivergedTrustRegion = SNES_DIVERGED_TR_DELTA,
        "the trust region has become too small";
}

reasons! {
    /// Why the time integration stopped.
    TsReason(TSConvergedReason);
    Iterating = TS_CONVERGED_ITERATING, "the time integration is still at work";
    ConvergedTime = TS_CONVERGED_TIME, "the final time is reached";
    ConvergedSteps = TS_CONVERGED_ITS, "the prescribed number of steps is done";
    ConvergedUser = TS_CONVERGED_USER, "the program asked the time integration to stop";
    ConvergedEvent = TS_CONVERGED_EVENT, "an event stopped the time integration";
    ConvergedPseudoAbsolute = TS_CONVERGED_PSEUDO_FATOL,
        "the steady residual is below the absolute tolerance";
    ConvergedPseudoRelative = TS_CONVERGED_PSEUDO_FRTOL,
        "the steady residual has fallen by the relative tolerance";
    DivergedNonlinearSolve = TS_DIVERGED_NONLINEAR_SOLVE,
        "the nonlinear solver failed too often";
    DivergedStepRejected = TS_DIVERGED_STEP_REJECTED,
        "the time step was refused too often";
    ForwardDivergedLinearSolve = TSFORWARD_DIVERGED_LINEAR_SOLVE,
        "the linear solver of the forward sensitivities failed";
    AdjointDivergedLinearSolve = TSADJOINT_DIVERGED_LINEAR_SOLVE,
        "the linear solver of the adjoint failed";
}

reasons! {
    /// Why the linear solver stopped.
    KspReason(KSPConvergedReason);
    Iterating = KSP_CONVERGED_ITERATING, "the linear solver is still at work";
    ConvergedRelativeNormal = KSP_CONVERGED_RTOL_NORMAL,
        "the residual of the normal equations has fallen by the relative tolerance";
    ConvergedAbsoluteNormal = KSP_CONVERGED_ATOL_NORMAL,
        "the residual of the normal equations is below the absolute tolerance";
    ConvergedRelative = KSP_CONVERGED_RTOL, "the residual has fallen by the relative tolerance";
    ConvergedAbsolute = KSP_CONVERGED_ATOL, "the residual is below the absolute tolerance";
    ConvergedIterations = KSP_CONVERGED_ITS, "the prescribed number of iterations is done";
    ConvergedNegativeCurvature = KSP_CONVERGED_CG_NEG_CURVE,
        "a direction of negative curvature was found";
    ConvergedConstrained = KSP_CONVERGED_CG_CONSTRAINED, "the step has met its constraint";
    ConvergedStepLength = KSP_CONVERGED_STEP_LENGTH, "the step has reached its allowed length";
    ConvergedHappyBreakdown = KSP_CONVERGED_HAPPY_BREAKDOWN,
        "the exact solution was found early";
    DivergedNull = KSP_DIVERGED_NULL, "the method broke down";
    DivergedIterations = KSP_DIVERGED_ITS, "the allowed number of iterations is used up";
    DivergedTolerance = KSP_DIVERGED_DTOL, "the residual has grown beyond the divergence tolerance";
    DivergedBreakdown = KSP_DIVERGED_BREAKDOWN, "the Krylov method broke down";
    DivergedBreakdownBicg = KSP_DIVERGED_BREAKDOWN_BICG, "the bi-conjugate gradient broke down";
    DivergedNonsymmetric = KSP_DIVERGED_NONSYMMETRIC,
        "the matrix or preconditioner is not symmetric but the method needs it so";
    DivergedIndefinitePreconditioner = KSP_DIVERGED_INDEFINITE_PC,
        "the preconditioner is indefinite";
    DivergedNan = KSP_DIVERGED_NANORINF, "a number in the linear solver is not finite";
    DivergedIndefiniteMatrix = KSP_DIVERGED_INDEFINITE_MAT, "the matrix is indefinite";
    DivergedPreconditioner = KSP_DIVERGED_PC_FAILED,
        "the matrix could not be factorised, or the preconditioner not be built";
}

reasons! {
    /// Why the optimisation stopped.
    TaoReason(TaoConvergedReason);
    Iterating = TAO_CONTINUE_ITERATING, "the optimisation is still at work";
    ConvergedAbsolute = TAO_CONVERGED_GATOL, "the gradient is below the absolute tolerance";
    ConvergedRelative = TAO_CONVERGED_GRTOL, "the gradient is small compared with the objective";
    ConvergedReduction = TAO_CONVERGED_GTTOL, "the gradient has fallen by the relative tolerance";
    ConvergedStep = TAO_CONVERGED_STEPTOL, "the step is below its tolerance";
    ConvergedMinimum = TAO_CONVERGED_MINF, "the objective is below its least wanted value";
    ConvergedUser = TAO_CONVERGED_USER, "the program was content with the point";
    DivergedIterations = TAO_DIVERGED_MAXITS, "the allowed number of iterations is used up";
    DivergedNan = TAO_DIVERGED_NAN, "a number in the optimisation is not finite";
    DivergedFunctionCount = TAO_DIVERGED_MAXFCN,
        "the allowed number of evaluations is used up";
    DivergedLineSearch = TAO_DIVERGED_LS_FAILURE, "the line search found no better point";
    DivergedTrustRegion = TAO_DIVERGED_TR_REDUCTION, "the trust region has become too small";
    DivergedUser = TAO_DIVERGED_USER, "the program asked the optimisation to stop";
}
