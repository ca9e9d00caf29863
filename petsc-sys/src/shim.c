#include "shim.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* What cannot be written goes to nothing from here on: what is left in the buffer, too. */
static void silence(FILE *screen)
{
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    dup2(nowhere, fileno(screen));
    close(nowhere);
  }
  clearerr(screen);
  fflush(screen);
}

static PetscErrorCode (*print_to_file)(FILE *, const char[], va_list);

/* Since 3.20 PETSc fails where the screen takes no text, as with a pipe whose reader has left. That costs no run here; a file
   that takes no text is an error still. */
static PetscErrorCode print(FILE *file, const char format[], va_list arguments)
{
  char usual[8192], *text = usual;
  size_t length = 0;
  va_list again;
  PetscErrorCode error;

  if (file != stdout && file != stderr) return print_to_file(file, format, arguments);
  va_copy(again, arguments);
  error = PetscVSNPrintf(usual, sizeof usual, format, &length, again);
  va_end(again);
  if (!error && length > sizeof usual && (text = malloc(length + 1)))
    error = PetscVSNPrintf(text, length + 1, format, NULL, arguments);
  if (!error && (fputs(text ? text : usual, file) < 0 || fflush(file))) silence(file);
  if (text != usual) free(text);
  return error;
}

void petsc_rs_forgive_screen(void)
{
  if (PetscVFPrintf == print) return;
  print_to_file = PetscVFPrintf;
  PetscVFPrintf = print;
}

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

/* Not every version has it where PETSc was built without MUMPS. */
PetscErrorCode petsc_rs_mumps_set_icntl(Mat factor, PetscInt index, PetscInt value)
{
#if defined(PETSC_HAVE_MUMPS)
  return MatMumpsSetIcntl(factor, index, value);
#else
  (void)factor, (void)index, (void)value;
  return PETSC_ERR_SUP;
#endif
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
