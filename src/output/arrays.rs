//! A file of named arrays (HDF5): what a checkpoint keeps of the numbers of a run. Serial.

use std::path::{Path, PathBuf};

use hdf5::{File, H5Type};

use super::OutputError;
use super::space::{self, BESIDE_VALUES};

/// The file, being written or read.
pub struct Arrays {
    path: PathBuf,
    file: File,
}

impl Arrays {
    /// Starts a new file.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if it cannot be made.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let file =
            File::create(path).map_err(|error| OutputError::hdf5(path, "creating it", error))?;
        Ok(Self {
            path: path.into(),
            file,
        })
    }

    /// Opens a file to read it.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if it is not one.
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        let file =
            File::open(path).map_err(|error| OutputError::hdf5(path, "opening it", error))?;
        Ok(Self {
            path: path.into(),
            file,
        })
    }

    /// Writes an array.
    ///
    /// # Errors
    /// [`OutputError::NoSpace`] when the disk is full, otherwise [`OutputError::Hdf5`].
    pub fn put<T: H5Type>(&self, name: &str, values: &[T]) -> Result<(), OutputError> {
        // From the start: HDF5 keeps its own part back until the file is closed.
        let bytes = self.file.size() + size_of_val(values) as u64 + BESIDE_VALUES;
        space::reserve(&self.path, 0, bytes)?;
        let builder = self.file.new_dataset::<T>().shape(values.len());
        let written = builder
            .create(name)
            .and_then(|dataset| dataset.write_raw(values));
        written.map_err(|error| OutputError::hdf5(&self.path, format!("writing {name}"), error))
    }

    /// Whether there is an array with this name.
    pub fn has(&self, name: &str) -> bool {
        self.file.link_exists(name)
    }

    /// Reads an array.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if it is not there, or of another type.
    pub fn get<T: H5Type>(&self, name: &str) -> Result<Vec<T>, OutputError> {
        let read = self
            .file
            .dataset(name)
            .and_then(|dataset| dataset.read_raw());
        read.map_err(|error| OutputError::hdf5(&self.path, format!("reading {name}"), error))
    }

    /// Reads an array of a known length.
    ///
    /// # Errors
    /// As [`Arrays::get`], or [`OutputError::Read`] if it has another length.
    pub fn get_exactly<T: H5Type, const N: usize>(
        &self,
        name: &str,
    ) -> Result<[T; N], OutputError> {
        self.get(name)?.try_into().map_err(|found: Vec<T>| {
            let reason = format!("{name} has {} numbers, not {N}", found.len());
            OutputError::read(&self.path, reason)
        })
    }

    /// Writes a text.
    ///
    /// # Errors
    /// As [`Arrays::put`].
    pub fn put_text(&self, name: &str, text: &str) -> Result<(), OutputError> {
        self.put(name, text.as_bytes())
    }

    /// Reads a text.
    ///
    /// # Errors
    /// As [`Arrays::get`], or [`OutputError::Read`] if it is no text.
    pub fn get_text(&self, name: &str) -> Result<String, OutputError> {
        String::from_utf8(self.get(name)?)
            .map_err(|_| OutputError::read(&self.path, format!("{name} is no text")))
    }

    /// Closes the file; says whether all of it was written.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if not.
    pub fn close(self) -> Result<(), OutputError> {
        let Self { path, file } = self;
        file.flush()
            .and_then(|()| file.close())
            .map_err(|error| OutputError::hdf5(&path, "closing it", error))
    }
}
