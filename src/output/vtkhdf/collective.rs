//! Writes of rows by all ranks of a file together, which the HDF5 crate does not offer: its own `write` is always independent.
//!
//! This is the only file of the package with `unsafe` code. Every function here is called by all ranks of the file.

#![allow(unsafe_code)]

use std::ffi::{c_int, c_void};
use std::os::fd::BorrowedFd;
use std::path::Path;

use hdf5::{Dataset, File, H5Type};
use hdf5_sys::h5::{herr_t, hsize_t};
use hdf5_sys::h5d::H5Dwrite;
use hdf5_sys::h5f::H5Fget_vfd_handle;
use hdf5_sys::h5i::{H5I_INVALID_HID, hid_t};
use hdf5_sys::h5p::{
    H5FD_mpio_xfer_t::H5FD_MPIO_COLLECTIVE, H5P_CLS_DATASET_XFER, H5P_DEFAULT, H5Pclose, H5Pcreate,
    H5Pset_dxpl_mpio,
};
use hdf5_sys::h5s::{
    H5S_SELECT_SET, H5Sclose, H5Screate_simple, H5Sselect_hyperslab, H5Sselect_none,
};
use mpi::traits::Communicator;
use rustix::fs::{FlockOperation, flock};

/// Writes rows of a file's datasets.
pub(super) struct RowWriter {
    /// How data are transferred; none on one rank, which needs no MPI-IO.
    transfer: Option<Closing>,
}

impl RowWriter {
    /// Opens a file that is there for all ranks together, to read and write it. Collective.
    ///
    /// One rank writes without MPI-IO, which would wait for the disk at every flush.
    pub fn open(path: &Path, comm: &impl Communicator) -> Result<(File, Self), String> {
        let mut options = File::with_options();
        let alone = comm.size() == 1;
        if !alone {
            options.with_fapl(|access| access.mpio(comm.as_raw(), None));
        }
        let file = options.open_rw(path).map_err(|error| error.to_string())?;
        let transfer = if alone {
            let_others_read(&file)?;
            None
        } else {
            Some(hdf5::sync::sync(collective_transfer)?)
        };
        Ok((file, Self { transfer }))
    }

    /// Writes `data` (row-major) to the rows `first_row..` of a dataset with one or two dimensions. Every rank calls it,
    /// also with nothing to write; the rows of different ranks must not overlap.
    ///
    /// Even on a rank whose data do not fit, the collective write takes place (with nothing of that rank), so that the
    /// others are not left waiting.
    pub fn write<T: H5Type>(
        &self,
        dataset: &Dataset,
        first_row: usize,
        data: &[T],
    ) -> Result<(), String> {
        let shape = dataset.shape();
        let columns: usize = shape.iter().skip(1).product::<usize>().max(1);
        let rows = data.len() / columns;
        let fits =
            data.len() == rows * columns && first_row + rows <= shape.first().copied().unwrap_or(0);
        let mut start = vec![0 as hsize_t; shape.len()];
        let mut count: Vec<hsize_t> = shape.iter().map(|&extent| extent as hsize_t).collect();
        if let (Some(start), Some(count)) = (start.first_mut(), count.first_mut()) {
            *start = first_row as hsize_t;
            *count = rows as hsize_t;
        }
        let selection = (fits && rows > 0).then_some((&start[..], &count[..]));
        let memory_type = hdf5::Datatype::from_type::<T>().map_err(|error| error.to_string())?;
        let transfer = self.transfer.as_ref().map_or(H5P_DEFAULT, |list| list.id);
        // SAFETY: `data` holds `rows * columns` values of the type `memory_type` describes, which is what `selection`
        // counts (or nothing is selected); the dataset, the type and the list live until the call returns.
        let written = hdf5::sync::sync(|| unsafe {
            write_selected(dataset.id(), memory_type.id(), transfer, selection, data)
        });
        if !fits {
            return Err(format!(
                "{} values for rows {first_row}.. of a dataset of shape {shape:?}",
                data.len()
            ));
        }
        written
    }
}

/// Gives back the lock with which HDF5 opens a file that is no file of MPI-IO, so that a picture can be made of a run that
/// is not at its end.
fn let_others_read(file: &File) -> Result<(), String> {
    let mut handle: *mut c_void = std::ptr::null_mut();
    // SAFETY: an open file; HDF5 writes one pointer.
    check(hdf5::sync::sync(|| unsafe {
        H5Fget_vfd_handle(file.id(), H5P_DEFAULT, &raw mut handle)
    }))?;
    // SAFETY: the default driver's handle points to its file descriptor, which is open as long as the file.
    let descriptor = unsafe { BorrowedFd::borrow_raw(*handle.cast::<c_int>()) };
    // Where there are no locks, there is none to give back.
    let _ = flock(descriptor, FlockOperation::Unlock);
    Ok(())
}

/// The list that makes a transfer collective. The HDF5 lock is held.
fn collective_transfer() -> Result<Closing, String> {
    // SAFETY: the class identifier is a constant of the library, initialised when the file was opened.
    let transfer = Closing::new(unsafe { H5Pcreate(*H5P_CLS_DATASET_XFER) }, H5Pclose)?;
    // SAFETY: `transfer` is an open data-transfer list.
    check(unsafe { H5Pset_dxpl_mpio(transfer.id, H5FD_MPIO_COLLECTIVE) })?;
    Ok(transfer)
}

/// # Safety
/// `dataset` and `memory_type` are open identifiers, `transfer` too or the default; `data` holds at least as many values of
/// `memory_type` as `selection` = (start, count), in as many dimensions as the dataset has, selects. The HDF5 lock is held.
unsafe fn write_selected<T>(
    dataset: hid_t,
    memory_type: hid_t,
    transfer: hid_t,
    selection: Option<(&[hsize_t], &[hsize_t])>,
    data: &[T],
) -> Result<(), String> {
    // SAFETY: `dataset` is an open dataset; the identifier returned is checked and closed by `Closing`.
    let file_space = Closing::new(unsafe { hdf5_sys::h5d::H5Dget_space(dataset) }, H5Sclose)?;
    // As many dimensions as in the file: HDF5 goes through the values one by one where the shapes differ.
    let extent = selection.map_or(&[1][..], |(_, count)| count);
    // SAFETY: as many extents are read as are said to be there, no maximum is given; closed by `Closing`.
    let memory_space =
        unsafe { H5Screate_simple(extent.len() as c_int, extent.as_ptr(), std::ptr::null()) };
    let memory_space = Closing::new(memory_space, H5Sclose)?;
    if let Some((start, count)) = selection {
        let none = std::ptr::null();
        // SAFETY: `start` and `count` have one entry for each dimension of the dataset; stride and block may be null.
        let selected = unsafe {
            H5Sselect_hyperslab(
                file_space.id,
                H5S_SELECT_SET,
                start.as_ptr(),
                none,
                count.as_ptr(),
                none,
            )
        };
        check(selected)?;
    } else {
        // SAFETY: both are open dataspaces.
        check(unsafe { H5Sselect_none(file_space.id) })?;
        // SAFETY: as above.
        check(unsafe { H5Sselect_none(memory_space.id) })?;
    }
    // SAFETY: all identifiers are open, and `data` covers the selection (the caller's promise).
    let written = unsafe {
        H5Dwrite(
            dataset,
            memory_type,
            memory_space.id,
            file_space.id,
            transfer,
            data.as_ptr().cast(),
        )
    };
    check(written)
}

fn check(code: herr_t) -> Result<(), String> {
    if code < 0 { Err(last_error()) } else { Ok(()) }
}

fn last_error() -> String {
    hdf5::Error::query().map_or_else(|error| error.to_string(), |error| error.to_string())
}

/// An HDF5 identifier that is closed when it goes out of scope.
struct Closing {
    id: hid_t,
    close: unsafe extern "C" fn(hid_t) -> herr_t,
}

impl Closing {
    fn new(id: hid_t, close: unsafe extern "C" fn(hid_t) -> herr_t) -> Result<Self, String> {
        if id <= H5I_INVALID_HID {
            Err(last_error())
        } else {
            Ok(Self { id, close })
        }
    }
}

impl Drop for Closing {
    fn drop(&mut self) {
        // SAFETY: `id` was checked to be valid on creation, is closed nowhere else, and `close` belongs to its kind.
        hdf5::sync::sync(|| unsafe { (self.close)(self.id) });
    }
}
