//! A string over a flat obstacle: `-u'' + 1 = 0` where it is free, u(0) = u(1) = 0, u >= -0.08.
//!
//! Where it is free, u = x²/2 - 0.4 x (and mirrored); it lies on the obstacle for 0.4 <= x <= 0.6.
//! Central differences are exact for it.

use mpi::topology::{Communicator, SimpleCommunicator};
use petsc::{Matrix, Scatter, Snes, Vector, options};

pub const OBSTACLE: f64 = -0.08;
/// Interior nodes, such that 0.4 and 0.6 are nodes.
pub const NODES: i32 = 49;
pub const SPACING: f64 = 1.0 / (NODES as f64 + 1.0);

pub fn exact(i: i32) -> f64 {
    let x = f64::from(i + 1) * SPACING;
    let x = x.min(1.0 - x).min(0.4);
    x * x / 2.0 - 0.4 * x
}

/// Whether the string lies on the obstacle at a node.
pub fn touches(i: i32) -> bool {
    (19..=29).contains(&i)
}

/// The solver and the start.
pub struct Obstacle {
    pub snes: Snes,
    pub u: Vector,
}

impl Obstacle {
    /// Reads its options with `prefix`; solves the linear systems with MUMPS if it is there.
    pub fn new(comm: &SimpleCommunicator, prefix: &str) -> Self {
        let (rank, size) = (comm.rank(), comm.size());
        let local = usize::try_from(NODES * (rank + 1) / size - NODES * rank / size).unwrap();
        let u = Vector::new(comm, local).unwrap();
        let own = u.ownership_range().unwrap();

        // Neighbours outside are ignored by the matrix, and by the scatter here.
        let inside = |i: &i32| (0..NODES).contains(i);
        let ghosts: Vec<i32> = (own.start - 1..=own.end).filter(inside).collect();
        let scatter = Scatter::new(&u, &ghosts).unwrap();
        let stencil = |i: i32| [(i, i), (i, i - 1), (i, i + 1)];
        let entries: Vec<(i32, i32)> = own.clone().flat_map(stencil).collect();
        let rows: Vec<i32> = entries.iter().map(|e| e.0).collect();
        let cols: Vec<i32> = entries
            .iter()
            .map(|e| if inside(&e.1) { e.1 } else { -1 })
            .collect();
        let matrix = Matrix::from_coo(comm, local, &rows, &cols).unwrap();

        let mut snes = Snes::new(comm).unwrap();
        snes.set_options_prefix(prefix).unwrap();
        let h2 = SPACING * SPACING;
        let first = ghosts.first().copied().unwrap_or(0);
        snes.set_function(&u, move |u, f| {
            let mut values = vec![0.0; ghosts.len()];
            scatter.forward(u, &mut values)?;
            let at = |i: i32| {
                usize::try_from(i - first)
                    .ok()
                    .and_then(|k| values.get(k))
                    .copied()
                    .unwrap_or(0.0)
            };
            for (i, f) in own.clone().zip(f.write()?.iter_mut()) {
                *f = (2.0 * at(i) - at(i - 1) - at(i + 1)) / h2 + 1.0;
            }
            Ok(())
        })
        .unwrap();
        let values: Vec<f64> = [2.0 / h2, -1.0 / h2, -1.0 / h2].repeat(local);
        snes.set_jacobian(matrix, move |_, matrix| Ok(matrix.set_values_coo(&values)?))
            .unwrap();

        if petsc::has_external_package("mumps").unwrap() {
            options::set_default(&format!("{prefix}pc_type"), "lu").unwrap();
            options::set_default(&format!("{prefix}pc_factor_mat_solver_type"), "mumps").unwrap();
        } else {
            // PETSc's own factorisation works on one rank: each does the same.
            options::set_default(&format!("{prefix}pc_type"), "redundant").unwrap();
        }
        Obstacle { snes, u }
    }

    /// Chooses the reduced-space solver, and sets the bounds.
    pub fn bounded(comm: &SimpleCommunicator, prefix: &str) -> Self {
        let mut this = Self::new(comm, prefix);
        this.snes.set_type("vinewtonrsls").unwrap();
        let (mut lower, mut upper) = (this.u.duplicate().unwrap(), this.u.duplicate().unwrap());
        lower.set_all(OBSTACLE).unwrap();
        upper.set_all(petsc::INFINITY).unwrap();
        this.snes.set_variable_bounds(&lower, &upper).unwrap();
        this
    }

    pub fn check_solution(&self) {
        let first = self.u.ownership_range().unwrap().start;
        for (i, &u) in (first..).zip(self.u.read().unwrap().iter()) {
            assert!(
                (u - exact(i)).abs() < 1e-10,
                "node {i}: {u} instead of {}",
                exact(i)
            );
        }
    }
}
