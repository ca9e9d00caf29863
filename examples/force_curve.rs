//! Runs a small case from Rust and reads its history: `cargo run --release --example force_curve`.

use std::collections::BTreeMap;
use std::error::Error;

use ssnp155::case::Case;
use ssnp155::run::simulate;
use ssnp155::{mpi, petsc};

fn main() -> Result<(), Box<dyn Error>> {
    let universe = mpi::initialize().ok_or("MPI cannot be started")?;
    let _session = petsc::Session::new(&[])?;
    let options = [
        ("sheet_nx", "20"),
        ("sheet_ny", "2"),
        ("stroke", "0.2"),
        ("time_load", "6.4"),
        ("quiet", "true"),
        ("output_dir", "results-example"),
    ];
    let options: BTreeMap<_, _> = options
        .map(|(name, value)| (name.into(), value.into()))
        .into();
    let case = Case::read(&options)?;
    let outcome = simulate(&case, &universe.world())?.ok_or("only help was asked for")?;
    for row in outcome.recorder.records() {
        println!("{:.4} mm  {:.3} N", row.stroke_mm, row.force_N);
    }
    Ok(())
}
