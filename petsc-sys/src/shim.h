/* What the bindings are made of: PETSc's headers, and functions for what is a macro, is written out in a header, or has
   changed its name or arguments between PETSc 3.18 and 3.26. */
#include <petscconf.h>
#include <petscksp.h>
#include <petscsnes.h>
#include <petsctao.h>
#include <petscts.h>

/* A macro before 3.19, a member of an enumeration since. */
static const int petsc_rs_err_user = PETSC_ERR_USER;

typedef PetscErrorCode (*petsc_rs_search)(SNESLineSearch, void *);
typedef PetscErrorCode (*petsc_rs_project)(SNES, Vec);
typedef PetscErrorCode (*petsc_rs_norm)(SNES, Vec, Vec, PetscReal *);

typedef PetscErrorCode (*petsc_rs_destroy)(void *);

/* Lets PETSc go on where nobody reads its screen; before PetscInitialize. */
void petsc_rs_forgive_screen(void);
PetscErrorCode petsc_rs_container_get(PetscContainer container, void **content);
PetscErrorCode petsc_rs_container_set_destroy(PetscContainer container, petsc_rs_destroy destroy);
PetscErrorCode petsc_rs_event_begin(PetscLogEvent event);
PetscErrorCode petsc_rs_event_end(PetscLogEvent event);
/* An error where PETSc was built without MUMPS. */
PetscErrorCode petsc_rs_mumps_set_icntl(Mat factor, PetscInt index, PetscInt value);
PetscErrorCode petsc_rs_line_search_set_apply(SNESLineSearch search, petsc_rs_search apply, void *context);
PetscErrorCode petsc_rs_line_search_get_vi(SNESLineSearch search, petsc_rs_project *project, petsc_rs_norm *norm);
