//! What a checkpoint holds of a run: everything the next step depends on, and what the report of the whole run needs.

use std::collections::BTreeMap;

use super::derivatives;
use crate::output::{Arrays, OutputError};
use crate::ranks::rows;
use crate::run::ledger::{Counts, LEDGER_NUMBERS};
use crate::run::springback::Springback;
use crate::sensitivity::Kept;
use crate::system::Snapshot;

/// A run after an accepted step. Vectors are in mesh order, see [`Snapshot`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::run) struct RunState {
    /// Options as the case shows them.
    pub options: BTreeMap<String, String>,
    /// Checksum of the hardening curve.
    pub hardening: u32,
    /// Checksums of the outlines of die and punch.
    pub tools: [u32; 2],
    /// The program that wrote it.
    pub revision: String,
    /// Time of the step, ms.
    pub time: f64,
    /// Displacements, multipliers and gaps.
    pub unknowns: Vec<f64>,
    /// Those before the last step, and its length (ms); none where the motion changes abruptly.
    pub before: Option<(Vec<f64>, f64)>,
    /// Of the nodes, mm/ms; empty in statics.
    pub velocity: Vec<f64>,
    /// Of the nodes, as the time stepper has it, mm/ms²; empty in statics.
    pub acceleration: Vec<f64>,
    /// Likewise, the one in the equations of the last step, mm/ms².
    pub stage_acceleration: Vec<f64>,
    pub snapshot: Snapshot,
    /// Step the control wants, ms, and steps without growth to come.
    pub step_control: (f64, usize),
    /// What the ledger remembers.
    pub ledger: [f64; LEDGER_NUMBERS],
    pub counts: Counts,
    pub springbacks: Vec<Springback>,
    /// Time of processors and on the clock so far, s.
    pub spent: [f64; 2],
    /// Node of each row of the sheet's field file, and contact point of each row of the contact points'.
    pub file_rows: [Vec<u64>; 2],
    /// Of a run with `-sensitivity`.
    pub derivatives: Option<Kept>,
}

impl RunState {
    /// Writes it to a file of arrays.
    pub fn put(&self, to: &Arrays) -> Result<(), OutputError> {
        let options: Vec<String> = self
            .options
            .iter()
            .map(|(name, value)| format!("{name} {value}\n"))
            .collect();
        to.put_text("options", &options.concat())?;
        to.put("hardening", &[self.hardening])?;
        to.put("tools", &self.tools)?;
        to.put_text("revision", &self.revision)?;
        to.put("unknowns", &self.unknowns)?;
        let (before, last_dt) = match &self.before {
            Some((before, dt)) => (&before[..], &[*dt][..]),
            None => (&[][..], &[][..]),
        };
        to.put("before", before)?;
        to.put("last_dt", last_dt)?;
        to.put("velocity", &self.velocity)?;
        to.put("acceleration", &self.acceleration)?;
        to.put("stage_acceleration", &self.stage_acceleration)?;
        to.put("gauss_points", &self.snapshot.gauss_points)?;
        to.put("contact_points", &self.snapshot.contact_points)?;
        to.put("friction_work", &self.snapshot.friction_work)?;
        to.put("time", &[self.time])?;
        to.put("wanted_dt", &[self.step_control.0])?;
        to.put("calm_steps", &[self.step_control.1 as u64])?;
        to.put("ledger", &self.ledger)?;
        let Counts {
            steps,
            refused,
            newton,
        } = self.counts;
        to.put("counts", &[steps, refused, newton])?;
        let springbacks: Vec<f64> = self.springbacks.iter().flat_map(numbers).collect();
        to.put("springbacks", &springbacks)?;
        to.put("spent", &self.spent)?;
        to.put("node_of_row", &self.file_rows[0])?;
        to.put("contact_point_of_row", &self.file_rows[1])?;
        self.derivatives
            .as_ref()
            .map_or(Ok(()), |kept| derivatives::put(kept, to))
    }

    /// Reads it back.
    pub fn get(from: &Arrays) -> Result<Self, OutputError> {
        let options = from.get_text("options")?;
        let last_dt: Vec<f64> = from.get("last_dt")?;
        let before = match last_dt.first() {
            Some(&dt) => Some((from.get("before")?, dt)),
            None => None,
        };
        let [steps, refused, newton] = from.get_exactly("counts")?;
        let [wanted] = from.get_exactly("wanted_dt")?;
        let [calm] = from.get_exactly::<u64, 1>("calm_steps")?;
        let [hardening] = from.get_exactly("hardening")?;
        // Before there were tools from files there was no other checksum.
        let tools = match from.has("tools") {
            true => from.get_exactly("tools")?,
            false => [0; 2],
        };
        let [time] = from.get_exactly("time")?;
        let springbacks: Vec<f64> = from.get("springbacks")?;
        Ok(Self {
            options: options
                .lines()
                .filter_map(|line| line.split_once(' '))
                .map(|(name, value)| (name.to_owned(), value.to_owned()))
                .collect(),
            hardening,
            tools,
            revision: from.get_text("revision")?,
            time,
            unknowns: from.get("unknowns")?,
            before,
            velocity: from.get("velocity")?,
            acceleration: from.get("acceleration")?,
            stage_acceleration: from.get("stage_acceleration")?,
            snapshot: Snapshot {
                gauss_points: from.get("gauss_points")?,
                contact_points: from.get("contact_points")?,
                friction_work: from.get("friction_work")?,
            },
            step_control: (wanted, calm as usize),
            ledger: from.get_exactly("ledger")?,
            counts: Counts {
                steps,
                refused,
                newton,
            },
            springbacks: rows(&springbacks).iter().map(springback).collect(),
            spent: from.get_exactly("spent")?,
            file_rows: [from.get("node_of_row")?, from.get("contact_point_of_row")?],
            derivatives: derivatives::get(from)?,
        })
    }
}

fn numbers(springback: &Springback) -> [f64; 5] {
    let Springback {
        t_ms,
        loaded_angle_deg,
        released_angle_deg,
        fit_residual_mm,
        plastic_growth,
    } = *springback;
    [
        t_ms,
        loaded_angle_deg,
        released_angle_deg,
        fit_residual_mm,
        plastic_growth,
    ]
}

fn springback(numbers: &[f64; 5]) -> Springback {
    let [
        t_ms,
        loaded_angle_deg,
        released_angle_deg,
        fit_residual_mm,
        plastic_growth,
    ] = *numbers;
    Springback {
        t_ms,
        loaded_angle_deg,
        released_angle_deg,
        fit_residual_mm,
        plastic_growth,
    }
}
