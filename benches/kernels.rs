//! Time of the kernels, on the benchmark's mesh in a bent state: `cargo bench`.
//!
//! docs/performance.md compares the elements per second with what the processor could do.

// The functions that criterion's macros make have no words.
#![allow(missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;

use std::hint::black_box;

use common::{Noise, aluminium};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ssnp155::case::Case;
use ssnp155::element::{ElementForce, Quad8, Quadrature};
use ssnp155::material::PointState;
use ssnp155::system::{History, JacobianEntries, Numbering, Problem, Subdomain};
use ssnp155::tool::die;

fn material(c: &mut Criterion) {
    let mut group = c.benchmark_group("return map");
    let material = aluminium();
    for (name, shear) in [("elastic", 1e-3), ("plastic", 0.05)] {
        let f = [[1.0, shear], [0.0, 1.0]];
        let state = PointState::VIRGIN;
        group.bench_function(format!("{name}, stress"), |b| {
            b.iter(|| material.respond(black_box(&f), &state).unwrap().kirchhoff);
        });
        group.bench_function(format!("{name}, stress and tangent"), |b| {
            b.iter(|| {
                let response = material.respond(black_box(&f), &state).unwrap();
                (response.kirchhoff, response.tangent())
            });
        });
    }
}

fn element(c: &mut Criterion) {
    let mut group = c.benchmark_group("element");
    group.throughput(Throughput::Elements(1));
    let nodes = [
        [0.0, 0.0],
        [0.35, 0.0],
        [0.35, 0.2],
        [0.0, 0.2],
        [0.175, 0.0],
        [0.35, 0.1],
        [0.175, 0.2],
        [0.0, 0.1],
    ];
    let kernel = Quad8::new(&nodes, Quadrature::Reduced);
    let (material, mut noise) = (aluminium(), Noise::new(1));
    let u = nodes.map(|[x, y]| [0.02 * x * y + 1e-4 * noise.next(), -0.05 * x * x]);
    let states = vec![PointState::VIRGIN; kernel.point_count()];
    let mut out = ElementForce::ZERO;
    for (name, with_stiffness) in [("force", false), ("force and stiffness", true)] {
        group.bench_function(name, |b| {
            b.iter(|| {
                kernel
                    .internal_force(black_box(&u), &material, &states, with_stiffness, &mut out)
                    .unwrap();
            });
        });
    }
}

fn gap(c: &mut Criterion) {
    let die = die(25.0, 4.0, 60.0);
    c.bench_function("gap to the die", |b| {
        b.iter(|| die.distance(black_box([26.3, -0.8])));
    });
}

fn assembly(c: &mut Criterion) {
    let mut group = c.benchmark_group("assembly");
    let problem = Problem::new(&Case::reference().unwrap());
    let elements = problem.mesh.elements.len();
    let parts = vec![0; elements];
    let numbering = Numbering::new(&problem, &parts, 1);
    let local = Subdomain::new(problem, &parts, &numbering, 0);
    let history = History::virgin(&local);
    let mut noise = Noise::new(2);
    let u: Vec<f64> = (0..local.unknown_count())
        .map(|_| 1e-4 * noise.next())
        .collect();
    let mut residual = vec![0.0; u.len()];
    let mut entries = JacobianEntries::new(&local);
    group.throughput(Throughput::Elements(elements as u64));
    group.bench_function("residual", |b| {
        b.iter(|| {
            local
                .residual(&history, 30.0, (black_box(&u), &u), None, &mut residual)
                .unwrap()
        });
    });
    group.bench_function("residual and tangent", |b| {
        b.iter(|| {
            let kept = Some(&mut entries);
            local
                .residual(&history, 30.0, (black_box(&u), &u), kept, &mut residual)
                .unwrap();
            local
                .jacobian(&history, 30.0, black_box(&u), 2.5, &mut entries)
                .unwrap()
        });
    });
    group.bench_function("tangent", |b| {
        b.iter(|| {
            local
                .jacobian(&history, 30.0, black_box(&u), 2.5, &mut entries)
                .unwrap()
        });
    });
}

criterion_group!(benches, material, element, gap, assembly);
criterion_main!(benches);
