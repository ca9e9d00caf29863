#include <petscconf.h>
#include <petscksp.h>
#include <petscsnes.h>
#include <petscts.h>

#if !defined(PETSC_USE_REAL_DOUBLE) || defined(PETSC_USE_COMPLEX) || defined(PETSC_USE_64BIT_INDICES)
#error "petsc-sys needs a PETSc with real double-precision scalars and 32-bit indices"
#endif
