//! Datasets of a VTKHDF file: made, extended and written by all ranks together.

use hdf5::plist::dataset_create::FillTime;
use hdf5::types::FixedAscii;
use hdf5::{Dataset, Group, H5Type};

use super::collective::RowWriter;
use super::types::{ArraySpec, Values};

/// Sets the number of rows. Collective.
pub(super) fn extend(dataset: &Dataset, rows: usize) -> Result<(), String> {
    let mut shape = dataset.shape();
    if let Some(first) = shape.first_mut() {
        *first = rows;
    }
    dataset.resize(shape).map_err(|error| error.to_string())
}

/// Writes this rank's values from row `first_row` on. Collective.
pub(super) fn write_values(
    writer: &RowWriter,
    dataset: &Dataset,
    first_row: usize,
    values: &Values,
) -> Result<(), String> {
    match values {
        Values::F64(values) => writer.write(dataset, first_row, values),
        Values::I32(values) => writer.write(dataset, first_row, values),
    }
}

/// A dataset without rows that can grow, in chunks of `rows`.
pub(super) fn extendable<T: H5Type>(
    group: &Group,
    name: &str,
    components: usize,
    rows: usize,
) -> hdf5::Result<Dataset> {
    let builder = group.new_dataset::<T>();
    // Every value is written right after the rows exist: filling them first would double the traffic.
    if components == 1 {
        builder
            .chunk(rows)
            .fill_time(FillTime::Never)
            .shape(0..)
            .create(name)
    } else {
        builder
            .chunk((rows, components))
            .fill_time(FillTime::Never)
            .shape((0.., components))
            .create(name)
    }
}

/// A dataset with all its rows.
pub(super) fn fixed<T: H5Type>(
    group: &Group,
    spec: &ArraySpec,
    rows: usize,
) -> hdf5::Result<Dataset> {
    if spec.components == 1 {
        group.new_dataset::<T>().shape(rows).create(spec.name)
    } else {
        group
            .new_dataset::<T>()
            .shape((rows, spec.components))
            .create(spec.name)
    }
}

/// Stores the unit of an array beside it.
pub(super) fn write_unit(dataset: &Dataset, spec: &ArraySpec) -> hdf5::Result<()> {
    let unit =
        FixedAscii::<16>::from_ascii(spec.unit.as_bytes()).map_err(|error| error.to_string())?;
    dataset
        .new_attr::<FixedAscii<16>>()
        .create("unit")?
        .write_scalar(&unit)
}
