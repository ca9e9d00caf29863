//! In: a case and an open PETSc session. Out: one simulation, driven step by step.
//! Never: mechanics, drawing, or writing files itself.

mod newton;
mod step_size;
