//! What only one rank knows at first: an element of its own that cannot be evaluated, and the forces at its own nodes.
//! Every rank has to come to the same answer, and none may wait for another that has left. Starts itself by mpirun.

mod common;
mod worker;

use std::process::ExitCode;

use common::{Noise, small_problem};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::Vector;
use ssnp155::ranks::{broadcast_bytes, gather_lists};
use ssnp155::system::{EvaluationError, History, Released, Snapshot, System, SystemError};

fn main() -> ExitCode {
    worker::on_ranks("what_one_rank_knows_is_known_to_all", &[1, 2, 3], |world| {
        one_rank_fails(world);
        released_problem_is_the_same(world);
        history_is_restored(world);
    })
}

/// Every rank has these bytes.
fn assert_same(world: &SimpleCommunicator, what: &str, mine: &str) {
    let of_root = broadcast_bytes(world, 0, mine.as_bytes().to_vec());
    assert_eq!(mine.as_bytes(), &of_root[..], "{what}");
}

/// Unknowns at rest but for one corner of an element of the last rank, which no other rank has: it is thrown so far that
/// the element is inverted. And the element's number in the mesh, on that rank.
fn inverted(system: &System) -> (Vector, Option<usize>) {
    let comm = system.comm();
    let mut unknowns = system.initial_unknowns().unwrap();
    if comm.rank() != comm.size() - 1 {
        drop(unknowns.write().unwrap());
        return (unknowns, None);
    }
    let (local, owned) = (system.local(), unknowns.ownership_range().unwrap());
    let nodes = local.element_nodes().iter();
    // A node this rank owns belongs to no lower one.
    let found = nodes.enumerate().find_map(|(element, nodes)| {
        let own = |node: &&usize| owned.contains(&local.rows()[2 * **node]);
        let node = nodes[..4].iter().find(own)?;
        Some((element, *node))
    });
    let (_, node) = found.unwrap();
    let row = (local.rows()[2 * node] - owned.start) as usize;
    unknowns.write().unwrap()[row] = 1e3;
    (unknowns, found.map(|(element, _)| element))
}

fn one_rank_fails(world: &SimpleCommunicator) {
    let system = System::new(small_problem(12, 2), world.duplicate()).unwrap();
    let history = History::virgin(system.local());
    let (unknowns, element) = inverted(&system);
    let mut out = system.vector().unwrap();
    let evaluated = system.residual(&history, 1.0, &unknowns, None, &mut out);
    match evaluated {
        Ok(()) => assert!(element.is_none()),
        Err(EvaluationError::Element(_)) => assert!(element.is_some()),
        Err(EvaluationError::Petsc(error)) => panic!("{error}"),
    }
    let local = system.local_values(&unknowns).unwrap();
    let refused = [
        (
            "the history after a step",
            system.advance(&history, 1.0, &unknowns).err(),
        ),
        (
            "measures",
            system.measures(&history, 1.0, &unknowns, None).err(),
        ),
        (
            "values at the nodes",
            system.node_samples(&history, 1.0, &local).err(),
        ),
        (
            "the released sheet",
            Released::new(&system, &history, &unknowns, 0.0, 1.0).err(),
        ),
    ];
    for (what, error) in refused {
        let Some(SystemError::Element(failed)) = error else {
            panic!("{what} on rank {}: {error:?}", world.rank());
        };
        assert_same(world, what, &failed.to_string());
        assert!(failed.to_string().starts_with("element "), "{failed}");
    }
}

fn released_problem_is_the_same(world: &SimpleCommunicator) {
    let system = System::new(small_problem(12, 2), world.duplicate()).unwrap();
    let history = History::virgin(system.local());
    // Stretched, so that every node has a force.
    let mut unknowns = system.vector().unwrap();
    let (local, owned) = (system.local(), unknowns.ownership_range().unwrap());
    let mut write = unknowns.write().unwrap();
    for (&row, [x, y]) in local.rows().iter().step_by(2).zip(local.node_coordinates()) {
        if owned.contains(&row) {
            let row = (row - owned.start) as usize;
            (write[row], write[row + 1]) = (1e-4 * x * x, 1e-4 * x * y);
        }
    }
    drop(write);
    let released = Released::new(&system, &history, &unknowns, 0.0, 1.0).unwrap();
    let problem = released.system.problem();
    assert_eq!(problem.loads.len(), 2 * problem.mesh.nodes.len());
    assert_same(world, "loads", &format!("{:?}", problem.loads));
    assert_same(world, "supports", &format!("{:?}", problem.supports));

    // What held the sheet, still holds it.
    let mut residual = released.system.vector().unwrap();
    let (system, unknowns) = (&released.system, &released.unknowns);
    let evaluated = system.residual(&released.history, 0.0, unknowns, None, &mut residual);
    assert!(evaluated.is_ok());
    let norms = gather_lists(world, &[residual.norm_max().unwrap()]);
    assert!(norms.iter().all(|&norm| norm < 1e-14), "{norms:?}");
}

/// A snapshot brings every rank its history back, to the last bit, and one of another mesh is refused.
fn history_is_restored(world: &SimpleCommunicator) {
    let mut problem = small_problem(12, 2);
    problem.friction_coefficient = 0.2;
    let system = System::new(problem, world.duplicate()).unwrap();
    let mut unknowns = system.initial_unknowns().unwrap();
    let owned = system.owned_displacements();
    let mut noise = Noise::new(7 + world.rank() as u64);
    // Large enough to yield, with friction at every point.
    for (i, value) in unknowns.write().unwrap().iter_mut().enumerate() {
        *value = if i < owned { 3e-3 } else { 1e-4 } * noise.next();
    }
    let start = History::virgin(system.local());
    let history = system.advance(&start, 30.0, &unknowns).unwrap();
    assert_ne!(history, start);
    let mut snapshot = Snapshot::of(&system, &history);
    // Only the first rank has it so far.
    for part in [
        &mut snapshot.gauss_points,
        &mut snapshot.contact_points,
        &mut snapshot.friction_work,
    ] {
        *part = gather_lists(world, part);
    }
    assert_eq!(snapshot.restore(&system).unwrap(), history);
    snapshot.contact_points.pop();
    let refused = snapshot.restore(&system).unwrap_err();
    assert_eq!(refused.what, "the contact points");
    assert_eq!(refused.found + 1, refused.expected);
}
