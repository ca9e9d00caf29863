//! What a checkpoint keeps of the derivatives, by numbers of the mesh, so that any number of ranks can go on with it.

use petsc::Vector;

use super::step::Sensitivity;
use super::{Cost, ReleasedSlopes};
use crate::ranks;
use crate::system::{History, MeshOrderError, Snapshot};

/// Derivatives after an accepted step; the arrays are complete on rank 0 only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// By parameter.
    pub parameters: Vec<KeptParameter>,
    /// 1 for each Gauss point that yielded in the last step, 0 for the others.
    pub flowing: Vec<f64>,
    /// Those of the released sheet.
    pub released: Vec<ReleasedSlopes>,
    /// Counts and processor times of all ranks, in the order of [`Cost`].
    pub cost: [f64; 4],
    /// Whether derivatives could not be had any more.
    pub lost: bool,
}

/// The derivatives by one parameter in mesh order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeptParameter {
    /// Its name.
    pub name: String,
    /// Of the unknowns.
    pub unknowns: Vec<f64>,
    /// Of the velocities.
    pub velocity: Vec<f64>,
    /// Of the accelerations.
    pub acceleration: Vec<f64>,
    /// Of the history.
    pub history: Snapshot,
}

impl Cost {
    /// Over all ranks: counts as they are, processor times added up. Collective.
    pub fn over_ranks(&self, comm: &impl mpi::traits::Communicator) -> [f64; 4] {
        let [shared, parameters] = ranks::sums(comm, [self.shared_seconds, self.parameter_seconds]);
        [
            self.factorisations as f64,
            self.solves as f64,
            shared,
            parameters,
        ]
    }
}

impl Sensitivity {
    /// For a checkpoint. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn keep(&self) -> petsc::Result<Kept> {
        let system = &self.system;
        let keep = |tracked: &super::tracked::Tracked| {
            Ok(KeptParameter {
                name: tracked.parameter.name.to_owned(),
                unknowns: system.in_mesh_order(&tracked.unknowns)?,
                velocity: system.in_mesh_order(&tracked.velocity)?,
                acceleration: system.in_mesh_order(&tracked.acceleration)?,
                history: Snapshot::of(system, &tracked.history),
            })
        };
        let flowing: Vec<f64> = self.flowing.iter().map(|&flows| f64::from(flows)).collect();
        Ok(Kept {
            parameters: self
                .tracked
                .iter()
                .map(keep)
                .collect::<petsc::Result<_>>()?,
            flowing: system.gauss_points_in_mesh_order(&flowing),
            released: self.released.clone(),
            cost: self.cost.over_ranks(system.comm()),
            lost: self.lost,
        })
    }

    /// Goes on with what a checkpoint kept of the same parameters, which every rank has in full.
    ///
    /// # Errors
    /// If a list has another size than this problem's, the same on every rank, or PETSc fails.
    pub fn put_back(&mut self, kept: &Kept) -> Result<(), MeshOrderError> {
        let system = &self.system;
        let vector =
            |values: &[f64]| -> Result<Vector, MeshOrderError> { system.from_mesh_order(values) };
        for (tracked, kept) in self.tracked.iter_mut().zip(&kept.parameters) {
            tracked.unknowns = vector(&kept.unknowns)?;
            tracked.velocity = vector(&kept.velocity)?;
            tracked.acceleration = vector(&kept.acceleration)?;
            let history: History = kept.history.restore(system)?;
            tracked.history = history;
        }
        let flowing = system.own_gauss_points(&kept.flowing)?;
        self.flowing = flowing.iter().map(|&flows| flows > 0.0).collect();
        self.released.clone_from(&kept.released);
        self.lost = kept.lost;
        let [factorisations, solves, shared, parameters] = kept.cost;
        let first = mpi::traits::Communicator::rank(system.comm()) == 0;
        self.cost = Cost {
            factorisations: factorisations as u64,
            solves: solves as u64,
            shared_seconds: if first { shared } else { 0.0 },
            parameter_seconds: if first { parameters } else { 0.0 },
        };
        Ok(())
    }
}
