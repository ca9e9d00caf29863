//! The field files hold what was handed over: on one rank, on three ranks one of which has no elements, and when the
//! run is killed between two steps.
//!
//! Each test starts this same program again under `mpirun`, where [`worker`] writes the files; the test then reads
//! them back without MPI.

use std::path::{Path, PathBuf};
use std::process::Command;

#[path = "mpi_environment/mod.rs"]
mod mpi_environment;

use hdf5::{File, H5Type};
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use mpi_environment::FEW_CORES;
use ssnp155::contact::ContactState;
use ssnp155::output::plot::{DeformedElement, gather_elements};
use ssnp155::output::{
    ContactFile, History, OutputDir, OutputError, SheetFile, SheetPart, StepRecord, ToolsFile,
};
use ssnp155::system::{ContactPointSample, NodeSample};

const STEPS: usize = 3;
const FOLDER: &str = "OUTPUT_FIELDS_FOLDER";
const KILL: &str = "OUTPUT_FIELDS_KILL";

/// A strip of `count` square elements of 1 mm that starts at x = `first` mm.
fn strip(first: usize, count: usize, rank: i32) -> SheetPart {
    let mut part = SheetPart {
        rank,
        ..SheetPart::default()
    };
    for element in first..first + count {
        let (x, base) = (element as f64, part.coordinates.len());
        part.coordinates
            .extend([[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]]);
        part.coordinates
            .extend([[x + 0.5, 0.0], [x + 1.0, 0.5], [x + 0.5, 1.0], [x, 0.5]]);
        part.quads.push(std::array::from_fn(|node| base + node));
    }
    part
}

/// Rank 1 of three has nothing; the others share the four elements.
fn part_of(comm: &SimpleCommunicator) -> SheetPart {
    match (comm.rank(), comm.size()) {
        (0, 1) => strip(0, 4, 0),
        (0, _) => strip(0, 1, 0),
        (2, _) => strip(1, 3, 2),
        (rank, _) => strip(0, 0, rank),
    }
}

/// Another state of contact in every step; none at half height.
fn state(y: f64, step: usize) -> Option<ContactState> {
    let states = [
        ContactState::Stick,
        ContactState::SlipForward,
        ContactState::SlipBackward,
    ];
    (y != 0.5).then_some(states[step])
}

/// What anyone can recompute from position and step.
fn sample([x, y]: [f64; 2], step: usize) -> NodeSample {
    let s = step as f64;
    NodeSample {
        displacement: [0.1 * s, -0.01 * x * s],
        stress: [x, y, 0.342 * (x + y), s],
        von_mises_stress: x * x + s,
        equivalent_plastic_strain: 1e-3 * s,
        contact_pressure: y * s,
        gap: 1.0 - y,
        contact_state: state(y, step),
    }
}

/// Run by `mpirun` only.
#[test]
#[ignore = "started under mpirun by the other tests"]
fn worker() {
    let Ok(folder) = std::env::var(FOLDER) else {
        return;
    };
    let universe = mpi::initialize().unwrap();
    let comm = universe.world();
    let file_in_the_way = Path::new(&folder).join("taken");
    if comm.rank() == 0 {
        std::fs::write(&file_in_the_way, "").unwrap();
    }
    let refused = OutputDir::create(&file_in_the_way, &comm).unwrap_err();
    assert_eq!(
        refused,
        OutputError::NotAFolder {
            path: file_in_the_way.clone()
        },
        "rank {}",
        comm.rank()
    );

    let out = OutputDir::create(Path::new(&folder).join("new/run"), &comm).unwrap();
    let part = part_of(&comm);
    let mut sheet = SheetFile::create(out.fields(), &comm, &part).unwrap();
    let (die, punch) = (
        [[0.0, -29.0], [25.0, -4.0], [60.0, 0.0]],
        [[0.0, 1.0], [23.5, 24.5]],
    );
    let mut tools = ToolsFile::create(out.tools(), &comm, &die, &punch).unwrap();
    let mut contact = ContactFile::create(out.contact(), &comm, &part.coordinates).unwrap();
    let mut history = (comm.rank() == 0).then(|| History::create(out.history()).unwrap());
    for step in 0..STEPS {
        let t_ms = 2.5 * step as f64;
        let samples: Vec<NodeSample> = part
            .coordinates
            .iter()
            .map(|&at| sample(at, step))
            .collect();
        let points: Vec<ContactPointSample> = samples
            .iter()
            .map(|s| ContactPointSample {
                reference: [0.0; 2],
                displacement: s.displacement,
                pressure: s.contact_pressure,
                friction: 0.1342 * s.contact_pressure,
                gap: s.gap,
                state: s.contact_state.unwrap_or_default(),
            })
            .collect();
        sheet.write(t_ms, &samples).unwrap();
        tools.write(t_ms, t_ms).unwrap();
        contact.write(t_ms, &points).unwrap();
        if let Some(history) = &mut history {
            history
                .append(&StepRecord {
                    t_ms,
                    ..StepRecord::default()
                })
                .unwrap();
        }
    }
    // Whoever looks at a run before its end finds no lock.
    for path in [out.fields(), out.tools(), out.contact()] {
        let reader = std::fs::File::open(path).unwrap();
        rustix::fs::flock(reader, rustix::fs::FlockOperation::NonBlockingLockShared).unwrap();
    }
    // One rank hands over too little: all ranks say so, none waits, and nothing is written.
    let too_few = vec![sample([0.0; 2], 0); part.coordinates.len().saturating_sub(1)];
    let error = sheet.write(99.0, &too_few).unwrap_err();
    assert!(
        matches!(error, OutputError::Mismatch { .. }),
        "rank {}: {error}",
        comm.rank()
    );
    let error = SheetFile::create("/nowhere/at/all/fields.vtkhdf", &comm, &part)
        .err()
        .unwrap();
    assert!(
        matches!(error, OutputError::Hdf5 { .. }),
        "rank {}: {error}",
        comm.rank()
    );
    println!("as expected: {error}");
    let samples: Vec<NodeSample> = part.coordinates.iter().map(|&at| sample(at, 2)).collect();
    let all = gather_elements(&comm, &DeformedElement::of(&part, &samples));
    if comm.rank() == 0 {
        let corners: Vec<f64> = all.iter().map(|element| element.nodes[0][0]).collect();
        assert_eq!(corners, [0.2, 1.2, 2.2, 3.2]);
        assert!(
            all.iter()
                .all(|element| (element.plastic_strain - 2e-3).abs() < 1e-15)
        );
    } else {
        assert!(all.is_empty());
    }
    if std::env::var_os(KILL).is_some() {
        std::process::abort();
    }
}

fn run_worker(name: &str, ranks: usize, killed: bool) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fields-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let mut command = Command::new("timeout");
    command.args(["60", "mpirun", "-n", &ranks.to_string()]);
    command.arg(std::env::current_exe().unwrap()).args([
        "--ignored",
        "--exact",
        "worker",
        "--nocapture",
    ]);
    command.env(FOLDER, &folder).envs(FEW_CORES);
    if killed {
        command.env(KILL, "1");
    }
    let output = command.output().expect("mpirun is needed for this test");
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.success(), !killed, "{text}");
    assert_eq!(text.contains("Aborted"), killed, "{text}");
    folder.join("new/run")
}

fn read<T: H5Type>(file: &File, name: &str) -> Vec<T> {
    file.dataset(&format!("VTKHDF/{name}"))
        .unwrap()
        .read_raw()
        .unwrap()
}

fn steps_of(file: &File) -> i64 {
    file.group("VTKHDF/Steps")
        .unwrap()
        .attr("NSteps")
        .unwrap()
        .read_scalar()
        .unwrap()
}

/// Everything in the three files against what [`worker`] handed over.
fn check(out: &Path, ranks: usize) {
    let file = File::open(out.join("fields.vtkhdf")).unwrap();
    assert_eq!(steps_of(&file), STEPS as i64);
    let expected = if ranks == 1 {
        vec![32_i64]
    } else {
        vec![8, 0, 24]
    };
    assert_eq!(read::<i64>(&file, "NumberOfPoints"), expected);
    let cells: Vec<i64> = expected.iter().map(|points| points / 8).collect();
    assert_eq!(read::<i64>(&file, "NumberOfCells"), cells);
    assert_eq!(read::<i64>(&file, "Offsets").len(), 4 + ranks);
    assert_eq!(read::<u8>(&file, "Types"), [23; 4]);
    let owners = if ranks == 1 { [0; 4] } else { [0, 2, 2, 2] };
    assert_eq!(read::<i32>(&file, "CellData/rank"), owners);
    assert_eq!(read::<f64>(&file, "Steps/Values"), [0.0, 2.5, 5.0]);
    assert_eq!(
        read::<i64>(&file, "Steps/NumberOfParts"),
        [ranks as i64; STEPS]
    );
    for name in [
        "PartOffsets",
        "PointOffsets",
        "CellOffsets",
        "ConnectivityIdOffsets",
        "CellDataOffsets/rank",
    ] {
        assert_eq!(
            read::<i64>(&file, &format!("Steps/{name}")),
            [0; STEPS],
            "{name}"
        );
    }
    assert_eq!(
        read::<i64>(&file, "Steps/PointDataOffsets/stress"),
        [0, 32, 64]
    );

    let points = read::<f64>(&file, "Points");
    let displacement = read::<f64>(&file, "PointData/displacement");
    let stress = read::<f64>(&file, "PointData/stress");
    let von_mises = read::<f64>(&file, "PointData/von_mises_stress");
    let status = read::<i32>(&file, "PointData/contact_status");
    assert_eq!(
        (points.len(), von_mises.len(), stress.len()),
        (3 * 32, STEPS * 32, 6 * STEPS * 32)
    );
    for step in 0..STEPS {
        for point in 0..32 {
            let expected = sample([points[3 * point], points[3 * point + 1]], step);
            let row = 32 * step + point;
            assert_eq!(displacement[3 * row..3 * row + 2], expected.displacement);
            assert_eq!(stress[6 * row..6 * row + 4], expected.stress);
            assert_eq!(von_mises[row], expected.von_mises_stress);
            let code = expected.contact_state.map_or(-1, ContactState::code);
            assert_eq!(status[row], code);
        }
    }

    let tools = File::open(out.join("tools.vtkhdf")).unwrap();
    assert_eq!(read::<i32>(&tools, "CellData/tool"), [0, 1]);
    let moved = read::<f64>(&tools, "PointData/displacement");
    let down: Vec<f64> = moved.chunks(3).map(|u| u[1]).collect();
    assert_eq!(
        down,
        [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.5, -2.5, 0.0, 0.0, 0.0, -5.0, -5.0
        ]
    );

    let contact = File::open(out.join("contact.vtkhdf")).unwrap();
    assert_eq!(read::<u8>(&contact, "Types"), [1; 32]);
    let (pressure, friction) = (
        read::<f64>(&contact, "PointData/contact_pressure"),
        read::<f64>(&contact, "PointData/friction_traction"),
    );
    assert!(
        pressure
            .iter()
            .zip(&friction)
            .all(|(p, t)| *t == 0.1342 * p)
    );
    assert_eq!(
        ssnp155::output::history::read(out.join("history.csv"))
            .unwrap()
            .len(),
        STEPS
    );
}

#[test]
fn one_rank_writes_what_it_was_given() {
    check(&run_worker("one", 1, false), 1);
}

#[test]
fn three_ranks_write_together_even_if_one_has_no_elements() {
    check(&run_worker("three", 3, false), 3);
}

#[test]
fn a_run_killed_between_two_steps_leaves_complete_files() {
    check(&run_worker("killed", 3, true), 3);
}
