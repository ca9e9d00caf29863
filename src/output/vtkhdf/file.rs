//! A VTKHDF file while it grows, on the rank that has it.

use std::path::{Path, PathBuf};

use hdf5::types::FixedAscii;
use hdf5::{Attribute, Dataset, File, FileBuilder};

use super::datasets::{append, extendable, fixed, whole, write_unit};
use super::mesh::Mesh;
use super::steps::{self, StepTable};
use super::types::{ArraySpec, Column, Kind};
use crate::output::OutputError;
use crate::output::space::{self, BESIDE_VALUES};

/// Datasets of the mesh itself: three counts, points, connectivity, offsets and types.
const OF_THE_MESH: usize = 7;

/// The file being written. Dropping it closes it.
pub(super) struct GrowingFile {
    path: PathBuf,
    /// Points of the whole mesh.
    points: usize,
    /// Bytes of a point in all arrays.
    point_bytes: usize,
    steps: usize,
    point_arrays: Vec<Dataset>,
    table: StepTable,
    count: Attribute,
    // Last, so that everything in the file is released before the file itself.
    file: File,
}

impl GrowingFile {
    /// Starts a new file with the mesh and the cell arrays, and no step yet.
    ///
    /// # Errors
    /// [`OutputError::NoSpace`] if the disk is full, [`OutputError::Hdf5`] if the file cannot be written.
    pub(super) fn create(
        path: &Path,
        mesh: &Mesh,
        point_arrays: &[ArraySpec],
        cell_arrays: &[(ArraySpec, Column)],
    ) -> Result<Self, OutputError> {
        // Without HDF5's lock, so that a picture can be made of a run that is not at its end.
        let mut options = FileBuilder::new();
        options.with_fapl(|access| access.file_locking(false));
        let created = options.create(path);
        let file = created.map_err(|error| OutputError::hdf5(path, "creating it", error))?;
        space::reserve_behind(path, mesh_bytes(mesh, point_arrays, cell_arrays))?;
        let written = write_mesh(&file, mesh, point_arrays, cell_arrays);
        let (datasets, table, count) =
            written.map_err(|error| OutputError::hdf5(path, "writing the mesh", error))?;
        Ok(Self {
            path: path.into(),
            points: mesh.point_count(),
            point_bytes: point_arrays.iter().map(ArraySpec::bytes).sum(),
            steps: 0,
            point_arrays: datasets,
            table,
            count,
            file,
        })
    }

    /// Sees to it that the disk has room for the next step.
    ///
    /// # Errors
    /// [`OutputError::NoSpace`] if it has not.
    pub(super) fn reserve_step(&self) -> Result<(), OutputError> {
        let values = (self.points * self.point_bytes) as u64;
        let beside = BESIDE_VALUES * self.point_arrays.len() as u64;
        let bytes = values + beside + self.table.growth(self.steps);
        space::reserve_behind(&self.path, bytes)
    }

    /// Writes the next step's values of point array number `array`.
    pub(super) fn write(&self, array: usize, column: &Column) -> hdf5::Result<()> {
        append(&self.point_arrays[array], self.first_row(), column)
    }

    /// Ends the step at `t_ms` whose values have been written: data first, then the number of steps.
    pub(super) fn end_step(&mut self, t_ms: f64) -> hdf5::Result<()> {
        self.table.append(self.steps, t_ms, self.first_row())?;
        self.file.flush()?;
        self.count.write_scalar(&(self.steps as i64 + 1))?;
        self.file.flush()?;
        self.steps += 1;
        Ok(())
    }

    fn first_row(&self) -> usize {
        self.steps * self.points
    }
}

/// What a file can grow by until the mesh is in it, bytes.
fn mesh_bytes(mesh: &Mesh, point_arrays: &[ArraySpec], cells: &[(ArraySpec, Column)]) -> u64 {
    let of_a_cell = cells.iter().map(|(spec, _)| spec.bytes()).sum::<usize>() + size_of::<u8>();
    let values = size_of::<f64>() * mesh.points.len()
        + of_a_cell * mesh.cell_count()
        + size_of::<i64>() * (mesh.connectivity.len() + mesh.offsets.len() + 3 * mesh.parts());
    // Each array has its own, and a name in the table of steps.
    let arrays = point_arrays.len() + cells.len();
    let datasets = OF_THE_MESH + steps::DATASETS + 2 * arrays;
    values as u64 + BESIDE_VALUES * datasets as u64
}

/// Makes all groups and datasets, and writes mesh and cell arrays.
fn write_mesh(
    file: &File,
    mesh: &Mesh,
    point_arrays: &[ArraySpec],
    cell_arrays: &[(ArraySpec, Column)],
) -> hdf5::Result<(Vec<Dataset>, StepTable, Attribute)> {
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
    let names = ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"];
    for (name, counts) in names.iter().zip(&mesh.counts) {
        whole(&root, name, 1, counts)?;
    }
    whole(&root, "Points", 3, &mesh.points)?;
    whole(&root, "Connectivity", 1, &mesh.connectivity)?;
    whole(&root, "Offsets", 1, &mesh.offsets)?;
    let types = vec![mesh.cell_type as u8; mesh.cell_count()];
    whole(&root, "Types", 1, &types)?;
    let cell_data = root.create_group("CellData")?;
    for (spec, column) in cell_arrays {
        write_unit(&fixed(&cell_data, spec, column)?, spec)?;
    }
    let point_data = root.create_group("PointData")?;
    let mut growing = Vec::new();
    for spec in point_arrays {
        // One chunk is one step: nothing is wasted, and a step is written in one piece.
        let rows = mesh.point_count().max(1);
        let dataset = match spec.kind {
            Kind::F64 => extendable::<f64>(&point_data, spec.name, spec.components, rows)?,
            Kind::I32 => extendable::<i32>(&point_data, spec.name, spec.components, rows)?,
        };
        write_unit(&dataset, spec)?;
        growing.push(dataset);
    }
    let cell_names: Vec<&str> = cell_arrays.iter().map(|(spec, _)| spec.name).collect();
    let (table, count) = StepTable::define(&root, point_arrays, &cell_names, mesh.parts())?;
    file.flush()?;
    Ok((growing, table, count))
}
