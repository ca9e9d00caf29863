//! Datasets of a VTKHDF file: made, extended and written.

use hdf5::plist::dataset_create::FillTime;
use hdf5::types::FixedAscii;
use hdf5::{Dataset, Group, H5Type};
use ndarray::ArrayView2;

use super::types::{ArraySpec, Column};

/// Sets the number of rows.
pub(super) fn extend(dataset: &Dataset, rows: usize) -> hdf5::Result<()> {
    let mut shape = dataset.shape();
    if let Some(first) = shape.first_mut() {
        *first = rows;
    }
    dataset.resize(shape)
}

/// Adds the values of a step behind the `before` rows that are there.
pub(super) fn append(dataset: &Dataset, before: usize, column: &Column) -> hdf5::Result<()> {
    match column {
        Column::F64(values) => append_rows(dataset, before, values),
        Column::I32(values) => append_rows(dataset, before, values),
    }
}

/// The same for values (row-major) of any kind.
///
/// What is written has as many dimensions in memory as in the file: HDF5 goes through it value by value otherwise.
pub(super) fn append_rows<T: H5Type>(
    dataset: &Dataset,
    before: usize,
    values: &[T],
) -> hdf5::Result<()> {
    let components = dataset.shape().get(1).copied();
    let rows = values.len() / components.unwrap_or(1);
    let selected = before..before + rows;
    extend(dataset, before + rows)?;
    match components {
        None => dataset.write_slice(values, selected),
        Some(components) => {
            let rows = ArrayView2::from_shape((rows, components), values);
            let rows = rows.map_err(|error| error.to_string())?;
            dataset.write_slice(rows, (selected, ..))
        }
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
pub(super) fn fixed(group: &Group, spec: &ArraySpec, column: &Column) -> hdf5::Result<Dataset> {
    match column {
        Column::F64(values) => whole(group, spec.name, spec.components, values),
        Column::I32(values) => whole(group, spec.name, spec.components, values),
    }
}

/// A dataset that holds these values (row-major).
pub(super) fn whole<T: H5Type>(
    group: &Group,
    name: &str,
    components: usize,
    values: &[T],
) -> hdf5::Result<Dataset> {
    let builder = group.new_dataset::<T>();
    let dataset = match components {
        1 => builder.shape(values.len()).create(name),
        _ => builder
            .shape((values.len() / components, components))
            .create(name),
    }?;
    dataset.write_raw(values)?;
    Ok(dataset)
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
