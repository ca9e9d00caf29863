//! One number made of all ranks' numbers.

use std::{ffi::c_int, ptr};

use mpi_sys::{MPI_Comm, MPI_Op};

use crate::error::{Error, Result};

/// The largest number of all ranks. Collective.
pub(crate) fn largest(comm: MPI_Comm, mine: i32) -> Result<i32> {
    // SAFETY: a constant of MPI.
    reduce(comm, mine, unsafe { mpi_sys::RSMPI_MAX })
}

/// The sum over all ranks. Collective.
pub(crate) fn sum(comm: MPI_Comm, mine: i32) -> Result<i32> {
    // SAFETY: a constant of MPI.
    reduce(comm, mine, unsafe { mpi_sys::RSMPI_SUM })
}

fn reduce(comm: MPI_Comm, mine: i32, operation: MPI_Op) -> Result<i32> {
    let mut size: c_int = 1;
    let mut all = mine;
    // SAFETY: a valid communicator; one integer is sent and one received.
    let code = unsafe {
        mpi_sys::MPI_Comm_size(comm, &mut size);
        if size == 1 {
            return Ok(mine);
        }
        mpi_sys::MPI_Allreduce(
            ptr::from_ref(&mine).cast(),
            ptr::from_mut(&mut all).cast(),
            1,
            mpi_sys::RSMPI_INT32_T,
            operation,
            comm,
        )
    };
    if code == 0 {
        Ok(all)
    } else {
        Err(Error::usage(format!("MPI_Allreduce failed: {code}")))
    }
}
