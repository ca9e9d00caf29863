//! Where everything lies in a VTKHDF file: groups, datasets and the table of steps.

use hdf5::types::FixedAscii;
use hdf5::{Attribute, Dataset, File};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};

use super::collective::RowWriter;
use super::datasets::{extendable, fixed, write_unit, write_values};
use super::steps::{self, StepTable};
use super::types::{ArraySpec, Kind, Part, Values};
use crate::output::space::BESIDE_VALUES;

/// What the series needs of a new file: the point arrays, the step table and the counter of steps.
pub(super) type Growing = (Vec<Dataset>, StepTable, Attribute);

/// Datasets of the mesh itself: three counts, points, connectivity, offsets and types.
const OF_THE_MESH: usize = 7;

/// This rank's place among all ranks.
pub(super) struct Layout {
    rank: usize,
    ranks: usize,
    pub(super) first_point: usize,
    pub(super) total_points: usize,
    first_cell: usize,
    total_cells: usize,
    first_connectivity: usize,
    total_connectivity: usize,
}

impl Layout {
    /// Collective.
    pub(super) fn new(comm: &SimpleCommunicator, part: &Part) -> Self {
        let (rank, ranks) = (comm.rank() as usize, comm.size() as usize);
        let mine = [
            part.points.len() as u64,
            part.cells() as u64,
            part.connectivity.len() as u64,
        ];
        let mut all = vec![0_u64; 3 * ranks];
        comm.all_gather_into(&mine[..], &mut all[..]);
        let sum = |of: usize, upto: usize| {
            all.chunks(3)
                .take(upto)
                .map(|counts| counts[of])
                .sum::<u64>() as usize
        };
        Self {
            rank,
            ranks,
            first_point: sum(0, rank),
            total_points: sum(0, ranks),
            first_cell: sum(1, rank),
            total_cells: sum(1, ranks),
            first_connectivity: sum(2, rank),
            total_connectivity: sum(2, ranks),
        }
    }

    /// What the file can grow by until the mesh is in it, bytes.
    pub(super) fn mesh_bytes(
        &self,
        point_arrays: &[ArraySpec],
        cell_arrays: &[(ArraySpec, Values)],
    ) -> u64 {
        let cell_specs = cell_arrays.iter().map(|(spec, _)| spec);
        let of_a_cell = cell_specs.map(ArraySpec::bytes).sum::<usize>() + size_of::<u8>();
        let values = 3 * size_of::<f64>() * self.total_points
            + of_a_cell * self.total_cells
            + size_of::<i64>() * (self.total_connectivity + self.total_cells + 4 * self.ranks);
        // Each array has its own, and a name in the table of steps.
        let arrays = point_arrays.len() + cell_arrays.len();
        let datasets = OF_THE_MESH + steps::DATASETS + 2 * arrays;
        values as u64 + BESIDE_VALUES * datasets as u64
    }

    /// Makes all groups and datasets. Collective; nothing in it differs from rank to rank.
    pub(super) fn define(
        &self,
        file: &File,
        point_arrays: &[ArraySpec],
        cell_arrays: &[(ArraySpec, Values)],
    ) -> hdf5::Result<Growing> {
        let root = file.create_group("VTKHDF")?;
        let kind =
            FixedAscii::<16>::from_ascii(b"UnstructuredGrid").map_err(|error| error.to_string())?;
        root.new_attr::<FixedAscii<16>>()
            .create("Type")?
            .write_scalar(&kind)?;
        root.new_attr::<i64>()
            .shape(2)
            .create("Version")?
            .write_raw(&[2_i64, 0])?;
        for name in ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"] {
            root.new_dataset::<i64>().shape(self.ranks).create(name)?;
        }
        root.new_dataset::<f64>()
            .shape((self.total_points, 3))
            .create("Points")?;
        root.new_dataset::<i64>()
            .shape(self.total_connectivity)
            .create("Connectivity")?;
        root.new_dataset::<i64>()
            .shape(self.total_cells + self.ranks)
            .create("Offsets")?;
        root.new_dataset::<u8>()
            .shape(self.total_cells)
            .create("Types")?;
        let cell_data = root.create_group("CellData")?;
        for (spec, _) in cell_arrays {
            let dataset = match spec.kind {
                Kind::F64 => fixed::<f64>(&cell_data, spec, self.total_cells)?,
                Kind::I32 => fixed::<i32>(&cell_data, spec, self.total_cells)?,
            };
            write_unit(&dataset, spec)?;
        }
        let point_data = root.create_group("PointData")?;
        let mut growing = Vec::new();
        for spec in point_arrays {
            // One chunk is one step: nothing is wasted, and a step is written in one piece.
            let rows = self.total_points.max(1);
            let dataset = match spec.kind {
                Kind::F64 => extendable::<f64>(&point_data, spec.name, spec.components, rows)?,
                Kind::I32 => extendable::<i32>(&point_data, spec.name, spec.components, rows)?,
            };
            write_unit(&dataset, spec)?;
            growing.push(dataset);
        }
        let cell_names: Vec<&str> = cell_arrays.iter().map(|(spec, _)| spec.name).collect();
        let (table, count) = StepTable::define(&root, point_arrays, &cell_names, self.ranks)?;
        Ok((growing, table, count))
    }

    /// Writes mesh and cell arrays. Collective: every rank makes all calls, the first failure is returned.
    pub(super) fn write_mesh(
        &self,
        file: &File,
        writer: &RowWriter,
        part: &Part,
        cell_arrays: &[(ArraySpec, Values)],
    ) -> Result<(), String> {
        let open = |name: &str| {
            file.dataset(&format!("VTKHDF/{name}"))
                .map_err(|error| error.to_string())
        };
        let points: Vec<f64> = part.points.iter().flatten().copied().collect();
        let types = vec![part.cell_type as u8; part.cells()];
        let mut results = vec![
            writer.write(
                &open("NumberOfPoints")?,
                self.rank,
                &[part.points.len() as i64],
            ),
            writer.write(&open("NumberOfCells")?, self.rank, &[part.cells() as i64]),
            writer.write(
                &open("NumberOfConnectivityIds")?,
                self.rank,
                &[part.connectivity.len() as i64],
            ),
            writer.write(&open("Points")?, self.first_point, &points),
            writer.write(
                &open("Connectivity")?,
                self.first_connectivity,
                &part.connectivity,
            ),
            // Each part has one offset more than cells.
            writer.write(
                &open("Offsets")?,
                self.first_cell + self.rank,
                &part.offsets,
            ),
            writer.write(&open("Types")?, self.first_cell, &types),
        ];
        for (spec, values) in cell_arrays {
            let dataset = open(&format!("CellData/{}", spec.name))?;
            results.push(write_values(writer, &dataset, self.first_cell, values));
        }
        results.into_iter().collect()
    }
}
