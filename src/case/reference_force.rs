//! What the force figure of a run is laid beside: a curve, or single values, from elsewhere.

use serde::{Deserialize, Serialize};

use super::error::CaseError;
use super::model::Case;
use super::option::Group;
use super::reference::{Instant, Origin};
use super::table::{self, TABLE};

/// code_aster 15.2 on the same model without friction; the file says what it is.
const CODE_ASTER: &str = include_str!("../../inputs/reference/code_aster-15.2-frictionless.csv");

/// Punch forces of the whole sheet from elsewhere. Empty where nobody has computed the case.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ReferenceForce {
    /// Who computed the curve.
    pub name: String,
    /// Travel of the punch (mm) and force (N), in the order of time; empty if there is no curve.
    pub curve: Vec<[f64; 2]>,
    /// What the points are.
    pub points_name: String,
    /// Travel of the punch (mm), force (N) and how far a result may be from it (N), going down.
    pub points: Vec<[f64; 3]>,
}

#[derive(Deserialize)]
struct Row {
    punch_mm: f64,
    #[serde(rename = "force_punch_N")]
    force: f64,
}

impl Case {
    /// The forces to show beside those of this case: the curve if the physics of loading is the benchmark's without
    /// friction, whatever the mesh and the way back; and the independent forces among [`Case::reference_values`].
    ///
    /// # Errors
    /// None unless the program's own tables are broken, which the tests exclude.
    pub fn reference_force(&self) -> Result<ReferenceForce, CaseError> {
        let values = self.reference_values()?;
        let mut points = Vec::new();
        for value in values
            .iter()
            .filter(|value| value.origin == Origin::Independent)
        {
            if let (true, Instant::Travel(depth)) = (value.id.starts_with("force"), value.when) {
                points.push([depth, value.value, value.allowed_deviation()]);
            }
        }
        let curve = if self.loads_as_the_benchmark()? {
            curve()?
        } else {
            Vec::new()
        };
        Ok(ReferenceForce {
            name: if curve.is_empty() {
                String::new()
            } else {
                "code_aster 15.2, without friction".to_owned()
            },
            curve,
            points_name: if points.is_empty() {
                String::new()
            } else {
                "tested values".to_owned()
            },
            points,
        })
    }

    /// Whether the frictionless benchmark goes down: another mesh or another way back does not change what is modelled.
    fn loads_as_the_benchmark(&self) -> Result<bool, CaseError> {
        let free = [table::UNLOAD_FRACTION.name, table::TIME_UNLOAD.name];
        let discretisation: Vec<&str> = TABLE
            .iter()
            .filter(|option| option.group() == Group::Discretisation)
            .map(|option| option.name())
            .collect();
        // Without friction its elastic slip has no meaning.
        let unused = table::FRICTION_COMPLIANCE.name;
        Ok(self.differences_from_reference()?.iter().all(|difference| {
            let name = difference.option;
            free.contains(&name) || discretisation.contains(&name) || name == unused
        }))
    }
}

fn curve() -> Result<Vec<[f64; 2]>, CaseError> {
    let mut table = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(CODE_ASTER.as_bytes());
    table
        .deserialize::<Row>()
        .map(|row| {
            row.map(|row| [row.punch_mm, row.force])
                .map_err(|error| CaseError::ReferenceValues {
                    line: error.position().map_or(0, csv::Position::line),
                    problem: error.to_string(),
                })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_compiled_in() {
        let curve = curve().unwrap();
        assert!(curve.len() > 190);
        assert!(curve.contains(&[28.5, 268.37]));
    }

    #[test]
    fn only_the_frictionless_benchmark_has_the_curve() {
        let reference = Case::reference().unwrap();
        assert!(!reference.reference_force().unwrap().curve.is_empty());
        assert_eq!(reference.reference_force().unwrap().points.len(), 3);
        let mut coarse = reference.clone();
        coarse.discretisation.nx = 60;
        coarse.loading.unload_fraction = 1.0;
        let force = coarse.reference_force().unwrap();
        assert!(!force.curve.is_empty() && force.points.is_empty());
        let mut rough = reference.clone();
        rough.friction.coefficient = 0.1342;
        let force = rough.reference_force().unwrap();
        assert!(force.curve.is_empty() && force.points.len() == 1);
        let mut thick = reference;
        thick.sheet.thickness = 0.9;
        assert_eq!(thick.reference_force().unwrap(), ReferenceForce::default());
    }
}
