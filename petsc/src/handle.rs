//! Owned and borrowed PETSc objects.

use std::{cell::UnsafeCell, marker::PhantomData, marker::PhantomPinned};

/// A PETSc object behind a reference: of size zero, so that swapping two of them moves nothing, and
/// neither `Send` nor `Sync` nor `Unpin`.
#[repr(C)]
pub(crate) struct Opaque {
    _data: UnsafeCell<[u8; 0]>,
    _not_send: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Defines an owned PETSc object and the type that borrows it.
macro_rules! petsc_object {
    (
        $(#[$owned_doc:meta])* $owned:ident,
        $(#[$borrowed_doc:meta])* $borrowed:ident,
        $raw:ident, $destroy:ident
    ) => {
        $(#[$borrowed_doc])*
        #[repr(transparent)]
        pub struct $borrowed($crate::handle::Opaque);

        impl $borrowed {
            /// # Safety
            /// `raw` is null or an object that lives for `'a`.
            #[allow(dead_code, reason = "not every object is lent both ways")]
            pub(crate) unsafe fn from_raw<'a>(raw: petsc_sys::$raw) -> $crate::Result<&'a Self> {
                // SAFETY: the object lives for 'a; `Self` has size zero, so nothing is claimed
                // about its bytes.
                unsafe { raw.cast::<Self>().as_ref() }
                    .ok_or_else(|| $crate::Error::usage(concat!("no ", stringify!($raw), " yet")))
            }

            /// # Safety
            /// `raw` is null or an object that lives for `'a` and that nobody else uses meanwhile.
            #[allow(dead_code, reason = "not every object is lent both ways")]
            pub(crate) unsafe fn from_raw_mut<'a>(
                raw: petsc_sys::$raw,
            ) -> $crate::Result<&'a mut Self> {
                // SAFETY: as in `from_raw`.
                unsafe { raw.cast::<Self>().as_mut() }
                    .ok_or_else(|| $crate::Error::usage(concat!("no ", stringify!($raw), " yet")))
            }

            pub(crate) fn raw(&self) -> petsc_sys::$raw {
                std::ptr::from_ref(self).cast_mut().cast()
            }

            #[allow(dead_code, reason = "not every object carries closures")]
            pub(crate) fn object(&self) -> petsc_sys::PetscObject {
                self.raw().cast()
            }
        }

        $(#[$owned_doc])*
        pub struct $owned {
            raw: std::ptr::NonNull<$borrowed>,
            _keep: $crate::session::Keep,
        }

        impl $owned {
            /// # Safety
            /// `raw` is null or an object whose reference passes to the new value.
            pub(crate) unsafe fn own(
                raw: petsc_sys::$raw,
                keep: $crate::session::Keep,
            ) -> $crate::Result<Self> {
                let raw = std::ptr::NonNull::new(raw.cast())
                    .ok_or_else(|| $crate::Error::usage("PETSc returned no object"))?;
                Ok(Self { raw, _keep: keep })
            }
        }

        impl std::ops::Deref for $owned {
            type Target = $borrowed;
            fn deref(&self) -> &$borrowed {
                // SAFETY: the object lives as long as `self`.
                unsafe { self.raw.as_ref() }
            }
        }

        impl std::ops::DerefMut for $owned {
            fn deref_mut(&mut self) -> &mut $borrowed {
                // SAFETY: the object lives as long as `self`, which is borrowed mutably.
                unsafe { self.raw.as_mut() }
            }
        }

        impl Drop for $owned {
            fn drop(&mut self) {
                if $crate::session::mpi_has_ended() {
                    return; // nothing can be freed any more; the process is about to end
                }
                let mut raw: petsc_sys::$raw = self.raw.as_ptr().cast();
                // SAFETY: `self` owns one reference to the object and gives it back once.
                unsafe { petsc_sys::$destroy(&mut raw) };
            }
        }

        impl std::fmt::Debug for $owned {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_struct(stringify!($owned)).finish_non_exhaustive()
            }
        }
    };
}

/// Defines functions that get one plain value from PETSc.
macro_rules! plain_getters {
    ($($(#[$doc:meta])* $get:ident, $getter:ident => $type:ty;)*) => {
        $($(#[$doc])*
        ///
        /// # Errors
        /// If PETSc fails.
        pub fn $get(&self) -> $crate::Result<$type> {
            let mut value = <$type>::default();
            // SAFETY: a live object, one value to write.
            $crate::error::check(unsafe { petsc_sys::$getter(self.raw(), &mut value) })?;
            Ok(value)
        })*
    };
}

/// Defines functions that give one plain value to PETSc.
macro_rules! plain_setters {
    ($($(#[$doc:meta])* $set:ident, $setter:ident <= $type:ty;)*) => {
        $($(#[$doc])*
        ///
        /// # Errors
        /// If the value is impossible.
        pub fn $set(&mut self, value: $type) -> $crate::Result<()> {
            // SAFETY: a live object.
            $crate::error::check(unsafe { petsc_sys::$setter(self.raw(), value) })
        })*
    };
}

pub(crate) use {petsc_object, plain_getters, plain_setters};
