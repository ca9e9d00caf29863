//! Options, vectors, scatters, matrices, linear solvers.

mod common;

use common::{fill, vector};
use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{
    Block, Error, FactorKind, FactorStatus, Factorization, Ksp, Matrix, Scatter, log, options,
};

fn main() {
    common::run(&[
        ("a_second_session_is_refused", second_session),
        ("options_are_found_with_and_without_values", option_values),
        ("defaults_give_way_to_what_is_given", option_defaults),
        ("unused_options_are_listed_until_read", unused_options),
        ("vectors_compute", vectors),
        ("vectors_of_other_layouts_are_refused", other_layouts),
        ("scatter_brings_entries_and_sums_contributions", scatter),
        ("scatter_refuses_wrong_sizes_and_indices", scatter_refuses),
        ("repeated_entries_of_a_matrix_are_summed", matrix_from_coo),
        ("a_matrix_refuses_wrong_numbers_of_values", matrix_refuses),
        ("rows_and_columns_become_identity", zero_rows_columns),
        ("numeric_factorisation_is_repeated_alone", factorization),
        ("a_singular_matrix_is_a_status", singular),
        ("kept_unknowns_are_solved_by_the_caller", kept_unknowns),
        ("linear_solver_follows_its_matrix", linear_solver),
        ("a_block_is_solved_as_its_columns_are", block),
        ("a_shell_matrix_is_its_product", shell_matrix),
        ("events_and_stages_nest", logging),
    ]);
}

fn second_session(_: &SimpleCommunicator) {
    assert!(matches!(
        petsc::Session::new(&["again".into()]),
        Err(Error::Usage(_))
    ));
}

fn option_values(_: &SimpleCommunicator) {
    options::set("length", "12.5").unwrap();
    options::set("quiet", "").unwrap();
    let long = "x".repeat(10_000);
    options::set("long", &long).unwrap();
    assert_eq!(options::get("length").unwrap().as_deref(), Some("12.5"));
    assert_eq!(options::get("LENGTH").unwrap().as_deref(), Some("12.5"));
    assert_eq!(options::get("quiet").unwrap().as_deref(), Some(""));
    assert_eq!(options::get("long").unwrap(), Some(long));
    assert_eq!(options::get("width").unwrap(), None);
    assert!(options::has("quiet").unwrap() && !options::has("width").unwrap());
    let all = options::all().unwrap();
    assert!(
        all.contains("-length 12.5") && all.contains("-quiet"),
        "{all}"
    );
    options::clear("long").unwrap();
    assert!(!options::has("long").unwrap());
    assert!(options::get("nul\0").is_err());
}

fn option_defaults(_: &SimpleCommunicator) {
    options::set("speed", "3").unwrap();
    options::set_default("speed", "4").unwrap();
    options::set_default("mass", "5").unwrap();
    options::set_default("mass", "6").unwrap();
    assert_eq!(options::get("speed").unwrap().as_deref(), Some("3"));
    assert_eq!(options::get("mass").unwrap().as_deref(), Some("5"));
    options::set_default("speed", "7").unwrap(); // now that it is read
    assert_eq!(options::get("speed").unwrap().as_deref(), Some("3"));
}

fn unused_options(_: &SimpleCommunicator) {
    let unused = || {
        let mut list = options::unused().unwrap();
        list.retain(|(name, _)| name.starts_with("misspelt"));
        list
    };
    options::set("misspelt_one", "1").unwrap();
    options::set("misspelt_two", "").unwrap();
    options::set_default("misspelt_one", "2").unwrap(); // does not count as reading
    assert!(options::is_given("misspelt_one").unwrap());
    let one = ("misspelt_one".to_string(), Some("1".to_string()));
    let two = ("misspelt_two".to_string(), None);
    assert_eq!(unused(), [one, two.clone()]);
    options::get("misspelt_one").unwrap();
    assert_eq!(unused(), [two]);
    options::mark_used("misspelt_two").unwrap();
    assert_eq!(unused(), []);
    assert!(options::is_given("misspelt_one").unwrap());
}

fn vectors(comm: &SimpleCommunicator) {
    let n = 3 * comm.size();
    let x = vector(comm, 3, f64::from);
    assert_eq!(
        (x.local_size().unwrap(), x.size().unwrap()),
        (3, usize::try_from(n).unwrap())
    );
    let first = 3 * comm.rank();
    assert_eq!(x.ownership_range().unwrap(), first..first + 3);
    let last = f64::from(n - 1);
    assert_eq!(x.sum().unwrap(), last * f64::from(n) / 2.0);
    assert_eq!(x.norm_max().unwrap(), last);
    assert!((x.norm2().unwrap() - x.dot(&x).unwrap().sqrt()).abs() < 1e-12);
    let mut y = x.duplicate().unwrap();
    assert_eq!(y.norm_max().unwrap(), 0.0);
    y.set_all(1.0).unwrap();
    y.axpy(2.0, &x).unwrap(); // 1 + 2 x
    let mut z = y.to_owned().unwrap();
    z.waxpy(-2.0, &x, &y).unwrap(); // 1
    z.scale(3.0).unwrap();
    assert!(z.read().unwrap().iter().all(|&value| value == 3.0));
    z.copy_from(&y).unwrap();
    assert_eq!(z.norm_max().unwrap(), 1.0 + 2.0 * last);
    fill(&mut z, |_| -9e9);
    assert_eq!(z.norm_max().unwrap(), 9e9); // no stale norm after writing
    let empty = vector(comm, 0, f64::from);
    assert!(empty.read().unwrap().is_empty());
}

fn other_layouts(comm: &SimpleCommunicator) {
    let (x, mut y) = (vector(comm, 3, f64::from), vector(comm, 4, f64::from));
    let Err(Error::Petsc {
        code,
        message,
        traceback,
    }) = y.axpy(1.0, &x)
    else {
        panic!("not refused by PETSc")
    };
    assert_eq!(code, 75);
    assert!(message.contains("Incompatible vector"), "{message}");
    assert!(traceback[0].starts_with("VecAXPY"), "{traceback:?}");
    y.scale(2.0).unwrap(); // and life goes on
}

fn scatter(comm: &SimpleCommunicator) {
    let n = 2 * comm.size();
    let x = vector(comm, 2, |i| 10.0 * f64::from(i));
    // Everything, backwards, and the first entry once more: also of other ranks.
    let indices: Vec<i32> = (0..n).rev().chain([0]).collect();
    let scatter = Scatter::new(&x, &indices).unwrap();
    let mut local = vec![f64::NAN; indices.len()];
    for _ in 0..2 {
        scatter.forward(&x, &mut local).unwrap();
        assert!(
            local
                .iter()
                .zip(&indices)
                .all(|(&value, &i)| value == 10.0 * f64::from(i))
        );
    }
    let mut y = x.to_owned().unwrap();
    scatter
        .reverse_add(&vec![1.0; indices.len()], &mut y)
        .unwrap();
    let ranks = f64::from(comm.size());
    let first = y.ownership_range().unwrap().start;
    for (i, &value) in (first..).zip(y.read().unwrap().iter()) {
        let times = if i == 0 { 2.0 } else { 1.0 };
        assert_eq!(value, 10.0 * f64::from(i) + times * ranks);
    }
}

fn scatter_refuses(comm: &SimpleCommunicator) {
    let (x, other) = (vector(comm, 2, f64::from), vector(comm, 5, f64::from));
    let scatter = Scatter::new(&x, &[0]).unwrap();
    assert!(scatter.forward(&x, &mut [0.0, 0.0]).is_err());
    assert!(scatter.forward(&other, &mut [0.0]).is_err());
    assert!(Scatter::new(&x, &[2 * comm.size()]).is_err());
}

/// Linear elements on a line; every rank adds to the row of its right neighbour.
fn line(comm: &SimpleCommunicator, stiffness: f64) -> (Matrix, Vec<f64>) {
    let (first, size) = (3 * comm.rank(), 3 * comm.size());
    let (mut rows, mut cols) = (Vec::new(), Vec::new());
    for e in first..first + 3 {
        let nodes = [e, if e + 1 < size { e + 1 } else { -1 }];
        for row in nodes {
            rows.extend([row; 2]);
            cols.extend(nodes);
        }
    }
    let values = [1.0, -1.0, -1.0, 1.0]
        .repeat(3)
        .iter()
        .map(|k| stiffness * k)
        .collect();
    (Matrix::from_coo(comm, 3, &rows, &cols).unwrap(), values)
}

fn matrix_from_coo(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 2.0);
    for _ in 0..2 {
        matrix.set_values_coo(&values).unwrap(); // not added to the values before
    }
    let size = 3 * comm.size();
    assert_eq!(
        matrix.nonzeros().unwrap(),
        usize::try_from(3 * size - 2).unwrap()
    );
    for i in 3 * comm.rank()..3 * comm.rank() + 3 {
        let (cols, values) = matrix.row(i).unwrap();
        let diagonal = if i == 0 { 2.0 } else { 4.0 };
        for (col, value) in cols.into_iter().zip(values) {
            assert_eq!(value, if col == i { diagonal } else { -2.0 });
        }
    }
    // The free end is at 0, the fixed one beyond the last node.
    let x = vector(comm, 3, |i| f64::from(size - i));
    let mut y = x.duplicate().unwrap();
    matrix.mult(&x, &mut y).unwrap();
    assert!((y.sum().unwrap() - 2.0).abs() < 1e-12 && (y.norm2().unwrap() - 2.0).abs() < 1e-12);
}

fn matrix_refuses(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 1.0);
    assert!(matrix.set_values_coo(&values[1..]).is_err());
    matrix.set_values_coo(&values).unwrap();
    let mut copy = matrix.duplicate().unwrap();
    assert!(copy.set_values_coo(&values).is_err());
    assert!(matrix.row(3 * comm.size()).is_err());
    let cols = if comm.rank() == 0 { &[][..] } else { &[0] };
    assert!(Matrix::from_coo(comm, 1, &[0], cols).is_err()); // on all ranks
    let beyond = comm.size();
    assert!(Matrix::from_coo(comm, 1, &[comm.rank()], &[beyond]).is_err());
    assert!(Matrix::from_coo(comm, 1, &[beyond], &[0]).is_err());
}

fn zero_rows_columns(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 1.0);
    matrix.set_values_coo(&values).unwrap();
    let mut copy = matrix.duplicate().unwrap();
    copy.set_option(petsc::MatrixOption::KeepNonzeroPattern, true)
        .unwrap();
    let row = 3 * comm.rank() + 1;
    copy.zero_rows_columns(&[row], 7.0).unwrap();
    let (cols, values) = copy.row(row).unwrap();
    assert_eq!(cols, matrix.row(row).unwrap().0);
    assert!(
        cols.iter()
            .zip(values)
            .all(|(&c, v)| v == if c == row { 7.0 } else { 0.0 })
    );
    assert_eq!(copy.row(row - 1).unwrap().1.last(), Some(&0.0));
    copy.copy_from(&matrix).unwrap();
    assert_eq!(copy.row(row).unwrap(), matrix.row(row).unwrap());
}

/// Without MUMPS there is only PETSc's own factorisation, on one rank.
fn refused_without_mumps(comm: &SimpleCommunicator, matrix: &Matrix) -> bool {
    let refused = !common::has_mumps() && comm.size() > 1;
    if refused {
        assert!(Factorization::new(matrix, FactorKind::General).is_err());
    }
    refused
}

fn factorization(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 1.0);
    matrix.set_values_coo(&values).unwrap();
    if refused_without_mumps(comm, &matrix) {
        return;
    }
    let factors = Factorization::new(&matrix, FactorKind::General).unwrap();
    let x = vector(comm, 3, |i| f64::from(i).sin());
    let (mut b, mut found) = (x.duplicate().unwrap(), x.duplicate().unwrap());
    assert!(factors.solve(&b, &mut found).is_err()); // no numbers yet
    for stiffness in [1.0, 3.0] {
        let values: Vec<f64> = values.iter().map(|k| stiffness * k).collect();
        matrix.set_values_coo(&values).unwrap();
        assert_eq!(factors.factor(&matrix).unwrap(), FactorStatus::Ready);
        matrix.mult(&x, &mut b).unwrap();
        factors.solve(&b, &mut found).unwrap();
        found.axpy(-1.0, &x).unwrap();
        assert!(found.norm_max().unwrap() < 1e-12);
    }
}

/// Five springs in a row between six points, the first of them held; each rank by itself.
fn kept_unknowns(comm: &SimpleCommunicator) {
    let alone = SimpleCommunicator::self_comm();
    let (rows, columns) = (
        [0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4],
        [0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4],
    );
    let mut matrix = Matrix::from_coo(&alone, 5, &rows, &columns).unwrap();
    let entries = |stiffness: f64| -> Vec<f64> {
        let entry = |(&row, &column): (&i32, &i32)| match (row == column, row == 4) {
            (true, true) => stiffness,
            (true, false) => 2.0 * stiffness,
            _ => -stiffness,
        };
        rows.iter().zip(&columns).map(entry).collect()
    };
    matrix.set_values_coo(&entries(1.0)).unwrap();
    let kept = [3, 1];
    let made = Factorization::keeping(&matrix, FactorKind::Symmetric, &kept, "kept_");
    if !common::has_mumps() {
        assert!(made.is_err());
        return;
    }
    let factors = made.unwrap();
    let x = vector(&alone, 5, |i| f64::from(i).cos() + f64::from(comm.rank()));
    let (mut b, mut found) = (x.duplicate().unwrap(), x.duplicate().unwrap());
    for stiffness in [1.0, 4.0] {
        matrix.set_values_coo(&entries(stiffness)).unwrap();
        assert_eq!(factors.factor(&matrix).unwrap(), FactorStatus::Ready);
        matrix.mult(&x, &mut b).unwrap();
        let mut schur = [0.0; 4];
        factors.schur_complement(&mut schur).unwrap();
        // Two springs in series between the wall and point 1, and two between 1 and 3; behind 3 nothing is held.
        let expected = [0.5, -0.5, -0.5, 1.0].map(|s| s * stiffness);
        assert!(
            schur
                .iter()
                .zip(&expected)
                .all(|(a, b)| (a - b).abs() < 1e-14 * stiffness)
        );
        let mut calls = 0;
        let solve_kept = |r: &mut [f64]| {
            calls += 1;
            let [a, b, c, d] = schur;
            let (first, second) = (d * r[0] - b * r[1], a * r[1] - c * r[0]);
            r.copy_from_slice(&[first / (a * d - b * c), second / (a * d - b * c)]);
            Ok(())
        };
        factors.solve_with(&b, &mut found, solve_kept).unwrap();
        found.axpy(-1.0, &x).unwrap();
        assert!(found.norm_max().unwrap() < 1e-13);
        assert_eq!(calls, 1);
    }
    factors.solve(&b, &mut found).unwrap();
    let held = found.read().unwrap();
    assert_eq!((held[1], held[3]), (0.0, 0.0));
    assert!((held[2] - b.read().unwrap()[2] / 8.0).abs() < 1e-14);
    drop(held);
    let failed = factors.solve_with(&b, &mut found, |_| Err("no room".into()));
    assert!(failed.unwrap_err().to_string().contains("no room"));
    factors.solve(&b, &mut found).unwrap();
}

fn singular(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 1.0);
    matrix.set_values_coo(&values).unwrap();
    if refused_without_mumps(comm, &matrix) {
        return;
    }
    let factors = Factorization::new(&matrix, FactorKind::General).unwrap();
    matrix.set_values_coo(&vec![0.0; values.len()]).unwrap();
    assert_eq!(
        factors.factor(&matrix).unwrap(),
        FactorStatus::NumericallySingular
    );
    let b = vector(comm, 3, f64::from);
    assert!(factors.solve(&b, &mut b.duplicate().unwrap()).is_err());
    matrix.set_values_coo(&values).unwrap();
    assert_eq!(factors.factor(&matrix).unwrap(), FactorStatus::Ready);
}

fn linear_solver(comm: &SimpleCommunicator) {
    let (preconditioner, package) = if common::has_mumps() {
        options::set("line_pc_factor_mat_solver_type", "mumps").unwrap();
        ("lu", Some("mumps"))
    } else {
        ("redundant", None)
    };
    options::set("line_pc_type", preconditioner).unwrap();
    let (mut matrix, values) = line(comm, 1.0);
    let mut ksp = Ksp::new(comm).unwrap();
    ksp.set_options_prefix("line_").unwrap();
    ksp.set_operator(&matrix).unwrap();
    ksp.set_from_options().unwrap();
    let x = vector(comm, 3, |i| f64::from(i).cos());
    let (mut b, mut found) = (x.duplicate().unwrap(), x.duplicate().unwrap());
    for stiffness in [1.0, 2.0] {
        let values: Vec<f64> = values.iter().map(|k| stiffness * k).collect();
        matrix.set_values_coo(&values).unwrap();
        matrix.mult(&x, &mut b).unwrap();
        assert!(ksp.solve(&b, &mut found).unwrap().is_converged());
        found.axpy(-1.0, &x).unwrap();
        assert!(found.norm_max().unwrap() < 1e-10);
    }
    assert_eq!(ksp.iteration_number().unwrap(), 1);
    assert_eq!(
        ksp.preconditioner().unwrap().as_deref(),
        Some(preconditioner)
    );
    assert_eq!(ksp.factor_solver().unwrap().as_deref(), package);
}

fn block(comm: &SimpleCommunicator) {
    let (mut matrix, values) = line(comm, 1.0);
    matrix.set_values_coo(&values).unwrap();
    let mut ksp = Ksp::new(comm).unwrap();
    ksp.set_operator(&matrix).unwrap();
    ksp.set_type("preonly").unwrap();
    let several = comm.size() > 1 && !common::has_mumps();
    ksp.set_preconditioner(if several { "redundant" } else { "lu" })
        .unwrap();
    let exact = [1.0, 2.0, 3.0].map(|k| vector(comm, 3, |i| (k * f64::from(i)).cos()));
    let mut column = exact[0].duplicate().unwrap();
    let mut right_sides = Block::new(comm, 3, 3).unwrap();
    let mut found = Block::new(comm, 3, 3).unwrap();
    assert_eq!(found.columns().unwrap(), 3);
    for (k, x) in exact.iter().enumerate() {
        matrix.mult(x, &mut column).unwrap();
        right_sides.set_column(k, &column).unwrap();
    }
    let reason = ksp.solve_block(&right_sides, &mut found).unwrap();
    assert!(reason.is_converged());
    for (k, x) in exact.iter().enumerate() {
        found.copy_column(k, &mut column).unwrap();
        column.axpy(-1.0, x).unwrap();
        assert!(column.norm_max().unwrap() < 1e-10, "column {k}");
    }
    assert!(found.copy_column(3, &mut column).is_err());
    let longer = vector(comm, 4, |_| 1.0);
    assert!(right_sides.set_column(0, &longer).is_err());
}

fn shell_matrix(comm: &SimpleCommunicator) {
    let twice = Matrix::shell(comm, 2, |x, y| {
        y.copy_from(x)?;
        Ok(y.scale(2.0)?)
    })
    .unwrap();
    let x = vector(comm, 2, f64::from);
    let mut y = x.duplicate().unwrap();
    twice.mult(&x, &mut y).unwrap();
    assert_eq!(y.norm_max().unwrap(), 2.0 * x.norm_max().unwrap());
    assert!(!twice.takes_values().unwrap());
    let broken = Matrix::shell(comm, 2, |_, _| Err("out of order".into())).unwrap();
    assert_eq!(
        broken.mult(&x, &mut y).unwrap_err().to_string(),
        "out of order"
    );
}

fn logging(_: &SimpleCommunicator) {
    let (event, stage) = (
        log::Event::new("work").unwrap(),
        log::Stage::new("part").unwrap(),
    );
    let _part = stage.push().unwrap();
    let _outer = event.begin();
    let _inner = event.begin();
}
