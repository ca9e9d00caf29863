//! Verification: what the program computes against closed solutions and independent integrations.
//!
//! Without arguments the quick cases run, as a test. `-- --document` runs all and writes
//! docs/verification.md and its pictures; a word runs the cases whose names hold it. One process, one
//! rank: MPI and PETSc start once. Before, the file starts itself by mpirun with the cases that also run on two
//! ranks; what these find is compared with what one rank finds.

mod beam;
mod bending;
mod convergence;
mod cook;
mod document;
mod drum;
mod flat;
mod flow;
mod hertz;
mod impact;
mod material;
mod mindlin;
mod motion;
mod patch;
mod ranks;
mod ring;
mod row;
mod shear;
mod sliding;
mod statics;
mod strip;
mod svg;
mod vibration;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use row::{Answer, Case};

/// All cases, in the order of the document.
const CASES: &[Case] = &[
    material::UNIAXIAL,
    material::PLANE_STRAIN,
    material::CYCLIC,
    shear::ELASTIC,
    shear::PLASTIC,
    patch::DISPLACEMENT,
    patch::TRACTION,
    convergence::MANUFACTURED,
    beam::CANTILEVER,
    beam::ELASTICA,
    cook::LINEAR,
    cook::PLASTIC,
    bending::STRIP,
    strip::RELEASED,
    flat::PRESSURE,
    ring::PRESSED,
    hertz::CYLINDER,
    mindlin::SHEARED,
    sliding::RIGID,
    sliding::DEFORMABLE,
    drum::EYTELWEIN,
    vibration::BAR,
    vibration::DAMPING,
    vibration::BEAM,
    impact::WALL,
];

/// Options of PETSc. Static solves choose `snes_atol` themselves and use the program's own linear solve;
/// motions in time use PETSc's, so that both are verified.
const OPTIONS: &[(&str, &str)] = &[
    ("snes_rtol", "0"),
    ("snes_stol", "0"),
    ("snes_divergence_tolerance", "-1"),
    ("snes_max_it", "60"),
    ("motion_snes_rtol", "0"),
    ("motion_snes_stol", "0"),
    // The rounding of a beam that swings by 0.05 mm is 1e-14: with that as the limit, compiler and BLAS decide whether a step ends.
    ("motion_snes_atol", "1e-13"),
    ("motion_snes_max_it", "60"),
    ("motion_ksp_type", "preonly"),
    ("motion_pc_type", "lu"),
    ("motion_pc_factor_mat_solver_type", "mumps"),
    ("motion_ts_adapt_type", "none"),
    ("motion_ts_max_steps", "1000000"),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let document = arguments.iter().any(|word| word == "--document");
    let worker = arguments.iter().any(|word| word == ranks::WORKER);
    let words: Vec<&String> = arguments.iter().filter(|w| !w.starts_with('-')).collect();
    let chosen: Vec<&Case> = CASES
        .iter()
        .filter(|case| {
            let named = words.iter().any(|word| case.name.contains(word.as_str()));
            named || (words.is_empty() && (document || case.quick))
        })
        .collect();
    if chosen.is_empty() {
        eprintln!("verification: no case is called so");
        return ExitCode::FAILURE;
    }
    // Before MPI starts here: mpirun below a process of MPI would take itself for one of its ranks.
    let by_two = if worker {
        Ok(ranks::Found::default())
    } else {
        ranks::by_two(&chosen)
    };
    let Some((universe, _)) = mpi::initialize_with_threading(mpi::Threading::Funneled) else {
        eprintln!("verification: MPI cannot be started");
        return ExitCode::FAILURE;
    };
    let world = universe.world();
    if world.size() > 1 && !worker {
        eprintln!("verification: it starts its ranks itself, without mpirun");
        world.abort(1);
    }
    let passed = {
        let _session = petsc::Session::new(&["verification".to_owned()]).expect("PETSc starts");
        for (name, value) in OPTIONS {
            petsc::options::set_default(name, value).expect("an option can be set");
        }
        let answers: Vec<_> = chosen
            .iter()
            .map(|case| (*case, run(case, &world)))
            .collect();
        let mut passed = answers.iter().all(|(_, answer)| holds(answer.as_ref()));
        if !worker {
            passed &= ranks::agree(by_two, &answers);
        }
        if document && words.is_empty() && passed {
            let answers: Vec<_> = answers
                .iter()
                .filter_map(|(case, answer)| Some((*case, answer.as_ref()?)))
                .collect();
            document::write(&answers).expect("the document can be written");
        }
        passed
    };
    drop(universe);
    if passed {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn holds(answer: Option<&Answer>) -> bool {
    answer.is_some_and(|answer| !answer.rows.is_empty() && answer.rows.iter().all(row::Row::holds))
}

/// Runs a case and prints its rows, separated by semicolons; of several ranks the first one prints.
fn run(case: &Case, world: &SimpleCommunicator) -> Option<Answer> {
    let clock = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| (case.run)(world)));
    let answer = match outcome {
        Ok(Ok(answer)) => Some(answer),
        Ok(Err(error)) => {
            println!("{}: {error}", case.name);
            None
        }
        Err(_) => None,
    };
    if world.size() > 1 && answer.is_none() {
        // The other rank may wait for this one.
        world.abort(1);
    }
    if world.rank() > 0 {
        return answer;
    }
    for row in answer.iter().flat_map(|answer| &answer.rows) {
        println!("{}", row.line(case.name));
    }
    let verdict = if holds(answer.as_ref()) {
        "ok"
    } else {
        "FAILED"
    };
    let (seconds, ranks) = (clock.elapsed().as_secs_f64(), world.size());
    println!(
        "test {} on {ranks} rank(s) ... {verdict} ({seconds:.1} s)",
        case.name
    );
    answer
}
