//! Simple shear at large strains.

use mpi::topology::SimpleCommunicator;
use ssnp155::material::PointState;
use ssnp155::plane::PlaneTensor;

use crate::flow::{Constants, bisect, runge_kutta};
use crate::row::{Answer, Case, Result, Row};

pub const ELASTIC: Case = Case {
    name: "shear_elastic",
    title: "Material: elastic simple shear",
    text: "Deformation gradient [1 γ; 0 1] of the Hencky material without yielding. With sinh a = γ/2 the principal \
logarithmic strains are ±a, and τ_xy = 2 G a / cosh a, τ_xx = -τ_yy = 2 G a tanh a. The shear stress has its maximum at \
a tanh a = 1, γ = 3.018. Tolerance: rounding.",
    quick: true,
    two_ranks: false,
    run: elastic,
};

fn elastic(_: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "closed form (Hencky elasticity, Anand 1979)";
    let constants = Constants::elastic();
    let mut rows = Vec::new();
    for gamma in [1e-4, 0.1, 1.0, 3.018, 6.0] {
        let f = [[1.0, gamma], [0.0, 1.0]];
        let stress = constants
            .material()
            .respond(&f, &PointState::VIRGIN)?
            .kirchhoff;
        let a = (0.5_f64 * gamma).asinh();
        let twice = 2.0 * constants.shear_modulus() * a;
        let quantity = format!("τ_xy at γ = {gamma}, MPa");
        rows.push(Row::relative(
            quantity,
            stress.xy,
            twice / a.cosh(),
            1e-10,
            SOURCE,
        ));
        let quantity = format!("τ_xx at γ = {gamma}, MPa");
        rows.push(Row::absolute(
            quantity,
            stress.xx,
            twice * a.tanh(),
            1e-9 * twice,
            SOURCE,
        ));
    }
    Ok(rows.into())
}

pub const PLASTIC: Case = Case {
    name: "shear_plastic",
    title: "Material: elastic-plastic simple shear",
    text: "The same path with aluminium's hardening, to γ = 1 in 1000 and in 2000 steps, extrapolated to the limit of small steps. The reference integrates the rate form of the same \
theory, ḃ = l b + b lᵀ - 3 ṗ (s/q) b for the elastic left Cauchy-Green tensor b, s the deviator of 2 G · ½ ln b, with ṗ \
from consistency, by a Runge-Kutta method with 200000 steps; principal axes turn all the way. Tolerance: what is left of second order, and the kinks of the table.",
    quick: true,
    two_ranks: false,
    run: plastic,
};

/// Deviator of the Kirchhoff stress (xx, xy, yy, zz) of an elastic left Cauchy-Green tensor.
fn deviator(shear_modulus: f64, b: [f64; 4]) -> [f64; 4] {
    let [xx, xy, yy, zz] = b;
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (sin, cos) = angle.sin_cos();
    let first = xx * cos * cos + 2.0 * xy * sin * cos + yy * sin * sin;
    let second = xx * sin * sin - 2.0 * xy * sin * cos + yy * cos * cos;
    let strain = [first, second, zz].map(|value| 0.5 * value.ln());
    let mean = strain.iter().sum::<f64>() / 3.0;
    let [s1, s2, s3] = strain.map(|e| 2.0 * shear_modulus * (e - mean));
    [
        s1 * cos * cos + s2 * sin * sin,
        (s1 - s2) * sin * cos,
        s1 * sin * sin + s2 * cos * cos,
        s3,
    ]
}

fn equivalent(s: [f64; 4]) -> f64 {
    (1.5 * (s[0] * s[0] + 2.0 * s[1] * s[1] + s[2] * s[2] + s[3] * s[3])).sqrt()
}

/// Rates of b (xx, xy, yy, zz) and p for a unit rate of γ (the associative flow rule of Simo 1992, with isotropic tensors).
fn rate(constants: &Constants, &[xx, xy, yy, zz, p]: &[f64; 5]) -> [f64; 5] {
    let three_g = 3.0 * constants.shear_modulus();
    let s = deviator(constants.shear_modulus(), [xx, xy, yy, zz]);
    let q = equivalent(s);
    let slope = constants.hardening.yield_stress(p).1;
    // The rate of deformation is 1/2 in xy: s : d = s_xy.
    let dp = three_g * s[1] / q / (three_g + slope);
    let flow = 3.0 * dp / q;
    [
        2.0 * xy - flow * (s[0] * xx + s[1] * xy),
        yy - flow * (s[0] * xy + s[1] * yy),
        -flow * (s[1] * xy + s[2] * yy),
        -flow * s[3] * zz,
        dp,
    ]
}

fn reference(constants: &Constants, end: f64, steps: usize) -> ([f64; 4], f64) {
    let elastic = |gamma: f64| [1.0 + gamma * gamma, gamma, 1.0, 1.0];
    let excess = |gamma: f64| {
        equivalent(deviator(constants.shear_modulus(), elastic(gamma)))
            - constants.hardening.initial()
    };
    let first = bisect(0.0, 0.1, excess);
    let [xx, xy, yy, zz] = elastic(first);
    let mut state = [xx, xy, yy, zz, 0.0];
    let h = (end - first) / steps as f64;
    for _ in 0..steps {
        state = runge_kutta(&state, h, |s| rate(constants, s));
    }
    let [xx, xy, yy, zz, p] = state;
    (deviator(constants.shear_modulus(), [xx, xy, yy, zz]), p)
}

fn plastic(_: &SimpleCommunicator) -> Result<Answer> {
    const SOURCE: &str = "rates of Simo 1992, integrated independently";
    let constants = Constants::aluminium();
    let material = constants.material();
    let path = |end: f64, steps: usize| -> Result<([f64; 4], f64)> {
        let mut state = PointState::VIRGIN;
        let mut stress = [0.0; 4];
        for step in 1..=steps {
            let gamma = end * step as f64 / steps as f64;
            let response = material.respond(&[[1.0, gamma], [0.0, 1.0]], &state)?;
            let PlaneTensor { xx, yy, zz, xy } = response.kirchhoff;
            (state, stress) = (response.state(), [xx, xy, yy, zz]);
        }
        Ok((stress, state.equivalent_plastic_strain))
    };
    let mut rows = Vec::new();
    for gamma in [0.1, 1.0] {
        let (exact, exact_p) = reference(&constants, gamma, 200_000);
        let (half, (stress, p)) = (path(gamma, 1000)?, path(gamma, 2000)?);
        let shear = exact[1];
        let limit: [f64; 4] = std::array::from_fn(|i| 2.0 * stress[i] - half.0[i]);
        for (name, computed, reference) in [
            ("τ_xy", limit[1], exact[1]),
            ("τ_xx - τ_yy", limit[0] - limit[2], exact[0] - exact[2]),
        ] {
            let quantity = format!("{name} at γ = {gamma}, MPa");
            rows.push(Row::absolute(
                quantity,
                computed,
                reference,
                2e-5 * shear,
                SOURCE,
            ));
        }
        let quantity = format!("plastic strain at γ = {gamma}");
        rows.push(Row::relative(
            quantity,
            2.0 * p - half.1,
            exact_p,
            1e-5,
            SOURCE,
        ));
        let error = |stress: [f64; 4]| (stress[0] - stress[2] - exact[0] + exact[2]).abs();
        let order = (error(half.0) / error(stress)).log2();
        let quantity = format!("order of τ_xx - τ_yy at γ = {gamma}");
        rows.push(Row::absolute(quantity, order, 1.0, 0.1, "backward Euler"));
    }
    Ok(rows.into())
}
