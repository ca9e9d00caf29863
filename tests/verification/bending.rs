//! Pure bending of an elastic-plastic strip in plane strain, and its springback.

use mpi::topology::SimpleCommunicator;
use ssnp155::element::Quadrature;
use ssnp155::mesh::SheetMesh;

use crate::flow::Constants;
use crate::row::{Answer, Case, Result, Row};
use crate::statics::{Statics, Touching, growing, held, nodes_where, problem};

/// Strains are smaller than the sheet's by this factor, so that those of the geometry vanish.
const STIFFER: f64 = 1e3;
const THICKNESS: f64 = 1.0;
const LENGTH: f64 = 0.5;

pub const STRIP: Case = Case {
    name: "bending_strip",
    title: "Elements: elastic-plastic bending and springback in plane strain",
    text: "A column of 16 elements through a sheet of 1 mm, its two ends kept plane and turned against each other, up to a strain at the surface of 2 % \
(radius 25 mm, the benchmark's die), then back by the elastic springback. To compare with small strain theory the material is aluminium with all strains divided by 1000 (E and the slopes multiplied), which is the same problem without the geometry. \
The reference is M(κ) = ∫ σ_x(κ y) y dy with σ_x from the Prandtl-Reuss rates in plane strain (no strain in z, no stress in y), and κ - M/(E' I) after the release. \
Tolerance: the kinks of the stress over the thickness, and 80 steps of first order.",
    quick: true,
    two_ranks: true,
    run: strip,
};

/// Moment per width of a strip of 1 mm at the curvature whose surface strain is `surface`, by the midpoint rule, with strain
/// steps of at most `step`.
pub fn moment(constants: &Constants, surface: f64, step: f64) -> f64 {
    const FIBRES: usize = 2000;
    let half = 0.5 * THICKNESS;
    let height = |k: usize| half * (k as f64 + 0.5) / FIBRES as f64;
    let strains: Vec<f64> = (0..FIBRES).map(|k| surface * height(k) / half).collect();
    let stresses = constants.plane_strain_tension(&strains, step);
    let sum: f64 = stresses
        .iter()
        .enumerate()
        .map(|(k, s)| s[0] * height(k))
        .sum();
    2.0 * sum * half / FIBRES as f64
}

fn strip(world: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "moment-curvature integral, rates integrated independently";
    let constants = Constants::stiffened(STIFFER);
    let stiffness = constants.plane_modulus() * THICKNESS.powi(3) / 12.0;
    let curvature_of = |surface: f64| surface / (0.5 * THICKNESS);
    let marks = [0.003, 0.006, 0.01, 0.02].map(|surface| surface / STIFFER);
    let references = marks.map(|surface| moment(&constants, surface, 1e-5 / STIFFER));
    let last = curvature_of(marks[3]);
    let released = last - references[3] / stiffness;
    let mut rows = Vec::new();
    for quadrature in [Quadrature::Reduced, Quadrature::Full] {
        let mesh = SheetMesh::new(LENGTH, THICKNESS, 1, 16);
        let mut model = problem(mesh.clone(), &constants, quadrature);
        let left = nodes_where(&mesh, |x| x[0] == 0.0);
        let right = nodes_where(&mesh, |x| x[0] == LENGTH);
        model.supports = left.iter().map(|&n| held(n, 0)).collect();
        model.supports.push(held(left[left.len() / 2], 1));
        // At time t the curvature is t; the lower side is in tension.
        let lever = |node: usize| 0.5 * THICKNESS - mesh.nodes[node][1];
        for &node in &right {
            model.supports.push(growing(node, 0, LENGTH * lever(node)));
        }
        let mut statics = Statics::new(world, model, Touching::All, 1e-14)?;
        let moment_of = |statics: &Statics| -> Result<f64> {
            let forces = statics.internal_forces()?;
            Ok(right.iter().map(|&n| forces[n][0] * lever(n)).sum())
        };
        let label = format!("{quadrature:?} integration");
        let mut loaded = 0.0;
        for step in 1..=80 {
            let curvature = last * f64::from(step) / 80.0;
            statics.advance(curvature)?;
            if let Some(i) = marks
                .iter()
                .position(|&mark| (curvature_of(mark) / curvature - 1.0).abs() < 1e-9)
            {
                loaded = moment_of(&statics)?;
                let quantity = format!(
                    "moment at a surface strain of {:.1} %, N; {label}",
                    100.0 * STIFFER * marks[i]
                );
                rows.push(Row::relative(quantity, loaded, references[i], 1e-3, SOURCE));
            }
        }
        let plastic = statics.measures()?.max_plastic_strain;
        statics.advance(released)?;
        let rest = moment_of(&statics)?;
        let free = released - rest * (last - released) / (loaded - rest);
        rows.push(Row::relative(
            format!("curvature without moment over the loaded one; {label}"),
            free / last,
            released / last,
            1e-3,
            "κ - M/(E' I), elastic release",
        ));
        rows.push(Row::absolute(
            format!("plastic strain of the release (times 1000); {label}"),
            STIFFER * (statics.measures()?.max_plastic_strain - plastic),
            0.0,
            1e-12,
            "elastic release",
        ));
    }
    Ok(rows.into())
}
