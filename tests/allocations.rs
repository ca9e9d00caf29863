//! Evaluations allocate nothing after the first: residual, tangent and the solve of a Newton step, counted by an allocator
//! that stands in for the system's. What PETSc allocates in C is not counted.

mod common;

use allocation_counter::measure;
use common::{Noise, small_problem};
use mpi::traits::Communicator;
use petsc::Session;
use ssnp155::system::{CondensedMethod, CondensedSolve, History, SolverChoice, System};

fn main() {
    let (universe, _) = mpi::initialize_with_threading(mpi::Threading::Funneled).unwrap();
    let world = universe.world();
    let _session = Session::new(&["allocations".to_owned()]).unwrap();
    for friction in [0.0, 0.2] {
        let mut problem = small_problem(12, 2);
        problem.friction_coefficient = friction;
        let system = System::new(problem, world.duplicate()).unwrap();
        allocates_nothing(&system, friction);
    }
}

fn allocates_nothing(system: &System, friction: f64) {
    let mut noise = Noise::new(5);
    let displacements = system.owned_displacements();
    let mut unknowns = system.vector().unwrap();
    for (i, value) in unknowns.write().unwrap().iter_mut().enumerate() {
        // Large enough to yield, and points of every kind.
        *value = if i < displacements { 3e-3 } else { 1e-4 } * noise.next();
    }
    let (mut out, mut step) = (system.vector().unwrap(), system.vector().unwrap());
    let history = History::virgin(system.local());
    let mut entries = system.jacobian_entries();
    let choice = SolverChoice {
        method: CondensedMethod::Substructures,
        options_prefix: "condensed_",
    };
    let condensed = CondensedSolve::new(system, choice).unwrap();
    let count = |what: &str, evaluate: &mut dyn FnMut()| {
        evaluate();
        let info = measure(|| {
            evaluate();
            evaluate();
        });
        println!(
            "test {what}, friction {friction}: {} allocations, {} bytes",
            info.count_total, info.bytes_total
        );
        assert_eq!(info.count_total, 0, "{what} allocates");
    };
    let acceleration = unknowns.to_owned().unwrap();
    count("residual", &mut || {
        let evaluated = system.residual(&history, 30.0, &unknowns, Some(&acceleration), &mut out);
        assert!(evaluated.is_ok());
    });
    count("tangent", &mut || {
        let evaluated = system.jacobian(&history, 30.0, &unknowns, 2.5, &mut entries);
        assert!(evaluated.is_ok());
    });
    count("residual and tangent", &mut || {
        let at = (&*unknowns, Some(&*acceleration));
        let evaluated = system.residual_and_stiffness(&history, 30.0, at, &mut entries, &mut out);
        assert!(evaluated.is_ok());
        let evaluated = system.jacobian(&history, 30.0, &unknowns, 2.5, &mut entries);
        assert!(evaluated.is_ok());
    });
    count("factorisation and solve", &mut || {
        assert!(condensed.factor(&entries, &[]).unwrap());
        condensed.solve(&out, &mut step).unwrap();
    });
    // The counter does count.
    assert!(measure(|| drop(unknowns.read().unwrap().to_vec())).count_total > 0);
}
