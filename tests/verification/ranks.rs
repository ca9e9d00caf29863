//! The cases on two ranks: started by mpirun, and compared with one rank.

use std::collections::HashMap;
use std::process::Command;

#[path = "../mpi_environment/mod.rs"]
mod mpi_environment;

use crate::row::{Answer, Case, Result};
use mpi_environment::FEW_CORES;

/// The word that makes this program one of two ranks.
pub const WORKER: &str = "--worker";
/// Seconds after which the ranks are ended.
const LIMIT: &str = "300";

/// Values by case and quantity.
pub type Found = HashMap<(String, String), f64>;

/// Runs those of the cases that run on two ranks on two ranks, which judge their rows themselves.
pub fn by_two(cases: &[&Case]) -> Result<Found> {
    let names: Vec<&str> = cases
        .iter()
        .filter(|case| case.two_ranks)
        .map(|case| case.name)
        .collect();
    if names.is_empty() {
        return Ok(Found::default());
    }
    let output = Command::new("timeout")
        .args([LIMIT, "mpirun", "-n", "2"])
        .arg(std::env::current_exe()?)
        .arg(WORKER)
        .args(names)
        .envs(FEW_CORES)
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    print!("{text}");
    if !output.status.success() {
        eprint!("{}", String::from_utf8_lossy(&output.stderr));
        return Err("a case fails on two ranks".into());
    }
    let mut found = Found::new();
    for line in text.lines() {
        // A quantity may hold semicolons itself; behind it there are six fields.
        let fields: Vec<&str> = line.rsplitn(7, ';').collect();
        let [_, _, _, _, _, computed, name] = fields[..] else {
            continue;
        };
        if let Some((case, quantity)) = name.split_once(';') {
            found.insert((case.to_owned(), quantity.to_owned()), computed.parse()?);
        }
    }
    Ok(found)
}

/// Whether two ranks found what one rank did, with a line for every case.
pub fn agree(by_two: Result<Found>, answers: &[(&Case, Option<Answer>)]) -> bool {
    let found = match by_two {
        Ok(found) => found,
        Err(error) => {
            println!("two ranks: {error}");
            return false;
        }
    };
    let mut all = true;
    for (case, answer) in answers.iter().filter(|(case, _)| case.two_ranks) {
        let rows = answer.iter().flat_map(|answer| &answer.rows);
        let mut largest = 0.0_f64;
        let mut same = true;
        for row in rows {
            let other = found.get(&(case.name.to_owned(), row.quantity.clone()));
            let agrees = other.is_some_and(|&other| row.is_also(other));
            if !agrees {
                let (name, one) = (&row.quantity, row.computed);
                println!(
                    "{}: {name}: {one:e} by one rank, {other:?} by two",
                    case.name
                );
            }
            same &= agrees;
            largest = largest.max(other.map_or(f64::INFINITY, |o| (o - row.computed).abs()));
        }
        let verdict = if same { "ok" } else { "FAILED" };
        println!(
            "test {} agrees on two ranks ... {verdict} (largest difference {largest:.1e})",
            case.name
        );
        all &= same;
    }
    all
}
