#include "shim.h"

PetscErrorCode petsc_rs_container_get(PetscContainer container, void **content)
{
  return PetscContainerGetPointer(container, content);
}

/* Before 3.23 `destroy` gets the content, since then the place where it is stored. */
PetscErrorCode petsc_rs_container_set_destroy(PetscContainer container, petsc_rs_destroy destroy)
{
#if PETSC_VERSION_GE(3, 23, 0)
  return PetscContainerSetCtxDestroy(container, (PetscCtxDestroyFn *)destroy);
#else
  return PetscContainerSetUserDestroy(container, destroy);
#endif
}

/* A macro in every version; since 3.20 it goes through log handlers instead of global function pointers. */
PetscErrorCode petsc_rs_event_begin(PetscLogEvent event)
{
  return PetscLogEventBegin(event, 0, 0, 0, 0);
}

PetscErrorCode petsc_rs_event_end(PetscLogEvent event)
{
  return PetscLogEventEnd(event, 0, 0, 0, 0);
}

PetscErrorCode petsc_rs_line_search_set_apply(SNESLineSearch search, petsc_rs_search apply, void *context)
{
#if PETSC_VERSION_GE(3, 21, 0)
  return SNESLineSearchShellSetApply(search, apply, context);
#else
  return SNESLineSearchShellSetUserFunc(search, apply, context);
#endif
}

PetscErrorCode petsc_rs_line_search_get_vi(SNESLineSearch search, petsc_rs_project *project, petsc_rs_norm *norm)
{
#if PETSC_VERSION_GE(3, 23, 0)
  SNESLineSearchVIDirDerivFn *slope;
  return SNESLineSearchGetVIFunctions(search, project, norm, &slope);
#else
  return SNESLineSearchGetVIFunctions(search, project, norm);
#endif
}
