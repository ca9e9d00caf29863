//! From the texts of options to a checked case.

use std::collections::BTreeMap;

use super::error::CaseError;
use super::hardening::{constants, has};
use super::model::{
    Case, Discretisation, Friction, Inverse, Loading, Material, Output, Resuming, Sheet, Stepping,
};
use super::option::{self, OptionSource};
use super::{geometry, inverse, table, tools};
use crate::material::hardening::{Declaration, Hardening, LAWS};
use crate::text::shortened;

impl Case {
    /// The case the options describe; options that are not given have their defaults, which are the reference case.
    ///
    /// # Errors
    /// The first option that is malformed or out of range, a hardening law that cannot be used, or a combination
    /// that cannot work.
    pub fn read(options: &dyn OptionSource) -> Result<Case, CaseError> {
        let case = Case {
            sheet: Sheet {
                length: table::SHEET_LENGTH.read(options)?,
                thickness: table::SHEET_THICKNESS.read(options)?,
                width: table::SHEET_WIDTH.read(options)?,
            },
            tools: tools::read(options)?,
            loading: Loading {
                stroke: table::STROKE.read(options)?,
                unload_fraction: table::UNLOAD_FRACTION.read(options)?,
                time_load: table::TIME_LOAD.read(options)?,
                time_unload: table::TIME_UNLOAD.read(options)?,
                dynamics: table::DYNAMICS.read(options)?,
            },
            material: read_material(options)?,
            friction: Friction {
                coefficient: table::FRICTION_COEFFICIENT.read(options)?,
                compliance: table::FRICTION_COMPLIANCE.read(options)?,
            },
            discretisation: Discretisation {
                nx: table::SHEET_NX.read(options)?,
                ny: table::SHEET_NY.read(options)?,
                points_along: table::QUADRATURE.read(options)?,
                points_through: table::QUADRATURE_THICKNESS.read(options)?,
                contact_location: table::CONTACT_LOCATION.read(options)?,
                contact_points_per_edge: table::CONTACT_POINTS_PER_EDGE.read(options)?,
                contact_compliance: table::CONTACT_COMPLIANCE.read(options)?,
                penetration_limit: table::PENETRATION_LIMIT.read(options)?,
            },
            stepping: Stepping {
                dt_initial: table::DT_INITIAL.read(options)?,
                dt_min: table::DT_MIN.read(options)?,
                dt_max: table::DT_MAX.read(options)?,
                fixed_steps_load: table::FIXED_STEPS_LOAD.read(options)?,
                fixed_steps_unload: table::FIXED_STEPS_UNLOAD.read(options)?,
                report_strokes: table::REPORT_STROKES.read(options)?,
                report_returns: table::REPORT_RETURNS.read(options)?,
                extrapolate: table::EXTRAPOLATE.read(options)?,
                newton_tolerance: table::NEWTON_TOLERANCE.read(options)?,
                newton_max_iterations: table::NEWTON_MAX_ITERATIONS.read(options)?,
            },
            output: Output {
                dir: table::OUTPUT_DIR.read(options)?,
                every: table::OUTPUT_EVERY.read(options)?,
                iterations: table::MONITOR_ITERATIONS.read(options)?,
                dry_run: table::DRY_RUN.read(options)?,
                quiet: table::QUIET.read(options)?,
                silent: false,
                compare: table::COMPARE.read(options)?,
                sensitivity: table::SENSITIVITY.read(options)?,
            },
            resuming: Resuming {
                checkpoint_every: table::CHECKPOINT_EVERY.read(options)?,
                checkpoint_minutes: table::CHECKPOINT_MINUTES.read(options)?,
                wall_limit: table::WALL_LIMIT.read(options)?,
                restart: table::RESTART.read(options)?,
                overwrite: table::OVERWRITE.read(options)?,
            },
            inverse: Inverse {
                identify: table::IDENTIFY.read(options)?,
                design: table::DESIGN.read(options)?,
                parameters: table::PARAMETERS.read(options)?,
                most_runs: table::MOST_RUNS.read(options)?,
                tolerance: table::DESIGN_TOLERANCE.read(options)?,
                refinement: table::DESIGN_REFINEMENT.read(options)?,
            },
        };
        case.parameters()?;
        geometry::check(&case)?;
        check_step_order(&case.stepping)?;
        inverse::check(&case)?;
        Ok(case)
    }

    /// The frictionless reference case: every option at its default.
    ///
    /// # Errors
    /// None unless the program's own table is broken, which the tests exclude.
    pub fn reference() -> Result<Case, CaseError> {
        Case::read(&BTreeMap::new())
    }
}

fn read_material(options: &dyn OptionSource) -> Result<Material, CaseError> {
    let young_modulus = table::YOUNG_MODULUS.read(options)?;
    let (law, constants, file, hardening) = read_hardening(options, young_modulus)?;
    Ok(Material {
        young_modulus,
        poisson_ratio: table::POISSON_RATIO.read(options)?,
        density: table::DENSITY.read(options)?,
        hardening_law: law,
        hardening_constants: constants,
        hardening_file: file,
        hardening,
    })
}

/// Law, values of its constants, path of the table, and the law itself.
type Read = (&'static Declaration, Vec<f64>, String, Hardening);

/// Reads what the law in use needs, and refuses what belongs to another law.
fn read_hardening(options: &dyn OptionSource, young_modulus: f64) -> Result<Read, CaseError> {
    let law = table::HARDENING.read(options)?;
    let file = table::HARDENING_FILE.read(options)?;
    let benchmark = file == table::BENCHMARK_TABLE;
    if law.build.is_some() && !benchmark {
        return Err(CaseError::OtherLaw {
            option: table::HARDENING_FILE.name,
            given: shortened(&file),
            owner: LAWS
                .iter()
                .filter(|law| law.build.is_none())
                .map(|law| law.name)
                .collect(),
            law: law.name,
        });
    }
    for constant in constants().filter(|constant| !has(law, constant)) {
        if let Some(given) = options.get(constant.name)? {
            let owners: Vec<&str> = LAWS
                .iter()
                .filter(|law| has(law, constant))
                .map(|law| law.name)
                .collect();
            return Err(CaseError::OtherLaw {
                option: constant.name,
                given: shortened(&given),
                owner: owners.join(" or "),
                law: law.name,
            });
        }
    }
    let values = law
        .constants
        .iter()
        .map(|constant| option::read(constant, &constant.kind(), options))
        .collect::<Result<Vec<f64>, CaseError>>()?;
    let hardening = match law.build {
        Some(build) => build(&values, young_modulus)?,
        None => {
            let table = match benchmark {
                true => Hardening::benchmark(young_modulus)?,
                false => Hardening::from_file(std::path::Path::new(&file), young_modulus)?,
            };
            table.scaled(values[0])
        }
    };
    Ok((law, values, file, hardening))
}

fn check_step_order(stepping: &Stepping) -> Result<(), CaseError> {
    let Stepping {
        dt_min,
        dt_initial,
        dt_max,
        ..
    } = *stepping;
    if dt_min <= dt_initial && dt_initial <= dt_max {
        Ok(())
    } else {
        Err(CaseError::StepOrder {
            dt_min,
            dt_initial,
            dt_max,
        })
    }
}
