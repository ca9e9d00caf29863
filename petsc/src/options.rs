//! PETSc's option database. Names are written without the leading dash.
//!
//! In: the program's arguments, option files and defaults set here. Out: values as text, and the
//! options nobody has read. Never: a meaning; that is the business of whoever asks.

use std::{ffi::CString, ptr};

use petsc_sys as sys;

use crate::{
    error::{Result, check, text_of},
    session::{c_string, keep},
};

fn dashed(name: &str) -> Result<CString> {
    c_string(&format!("-{name}"))
}

/// The value of an option: `None` if it is not given, an empty text if it is given without a value.
///
/// The option counts as used afterwards.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn get(name: &str) -> Result<Option<String>> {
    let _keep = keep()?;
    let name = dashed(name)?;
    let mut value = ptr::null();
    let mut given = sys::PETSC_FALSE;
    // SAFETY: null means the global database and no prefix; PETSc writes a pointer to its own string
    // and a flag.
    check(unsafe {
        sys::PetscOptionsFindPair(
            ptr::null_mut(),
            ptr::null(),
            name.as_ptr(),
            &mut value,
            &mut given,
        )
    })?;
    // SAFETY: null or PETSc's string, copied before the database can change.
    Ok((given != sys::PETSC_FALSE).then(|| unsafe { text_of(value) }))
}

/// Whether an option is given. The option counts as used afterwards.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn has(name: &str) -> Result<bool> {
    Ok(get(name)?.is_some())
}

/// Whether an option is given, without marking it as used.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn is_given(name: &str) -> Result<bool> {
    let _keep = keep()?;
    let mut used = sys::PETSC_FALSE;
    let c_name = c_string(name)?; // this one function wants no dash
    // SAFETY: the global database, a C string, one flag to write.
    check(unsafe { sys::PetscOptionsUsed(ptr::null_mut(), c_name.as_ptr(), &mut used) })?;
    // PETSc compares names without regard to case.
    Ok(used != sys::PETSC_FALSE
        || unused()?
            .iter()
            .any(|(other, _)| other.eq_ignore_ascii_case(name)))
}

/// Gives an option a value, over any earlier one. An empty value makes it a flag.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn set(name: &str, value: &str) -> Result<()> {
    let _keep = keep()?;
    let name = dashed(name)?;
    let value = if value.is_empty() {
        None
    } else {
        Some(c_string(value)?)
    };
    let pointer = value.as_ref().map_or(ptr::null(), |value| value.as_ptr());
    // SAFETY: the global database and two C strings (or null), which PETSc copies.
    check(unsafe { sys::PetscOptionsSetValue(ptr::null_mut(), name.as_ptr(), pointer) })
}

/// Gives an option a value unless the user has given one.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn set_default(name: &str, value: &str) -> Result<()> {
    if is_given(name)? {
        Ok(())
    } else {
        set(name, value)
    }
}

/// Takes an option out of the database.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn clear(name: &str) -> Result<()> {
    let _keep = keep()?;
    // SAFETY: the global database and a C string.
    check(unsafe { sys::PetscOptionsClearValue(ptr::null_mut(), dashed(name)?.as_ptr()) })
}

/// Marks an option as used, so that [`unused`] does not list it.
///
/// # Errors
/// If PETSc is not running or rejects the name.
pub fn mark_used(name: &str) -> Result<()> {
    has(name).map(|_| ())
}

/// The options nobody has asked for so far, with their values: after the set-up, these are the
/// misspelt ones. (PETSc itself says nothing in a build without debugging.)
///
/// # Errors
/// If PETSc is not running.
pub fn unused() -> Result<Vec<(String, Option<String>)>> {
    let _keep = keep()?;
    let (mut count, mut names, mut values) = (0, ptr::null_mut(), ptr::null_mut());
    // SAFETY: PETSc writes a count and two arrays of that length, of pointers to its own strings (a
    // value may be null); both arrays go back to PETSc after the strings are copied.
    unsafe {
        check(sys::PetscOptionsLeftGet(
            ptr::null_mut(),
            &mut count,
            &mut names,
            &mut values,
        ))?;
        let list = (0..usize::try_from(count).unwrap_or(0))
            .map(|i| {
                let value = *values.add(i);
                (
                    text_of(*names.add(i)),
                    (!value.is_null()).then(|| text_of(value)),
                )
            })
            .collect();
        check(sys::PetscOptionsLeftRestore(
            ptr::null_mut(),
            &mut count,
            &mut names,
            &mut values,
        ))?;
        Ok(list)
    }
}

/// All options and their values in one line, as on a command line.
///
/// # Errors
/// If PETSc is not running.
pub fn all() -> Result<String> {
    let _keep = keep()?;
    let mut text = ptr::null_mut();
    // SAFETY: PETSc writes a pointer to a new string, which is copied and given back.
    unsafe {
        check(sys::PetscOptionsGetAll(ptr::null_mut(), &mut text))?;
        let line = text_of(text).trim().to_string();
        if let Some(free) = sys::PetscTrFree {
            check(free(
                text.cast(),
                0,
                c"options::all".as_ptr(),
                c"options.rs".as_ptr(),
            ))?;
        }
        Ok(line)
    }
}
