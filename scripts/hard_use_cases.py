"""The cases of scripts/hard_use.py."""
import dataclasses

SMALL = ("-sheet_nx 20 -sheet_ny 2 -stroke 0.2 -time_load 6.4 -unload_fraction 0 -report_strokes none -output_every 0 "
         "-checkpoint_minutes 0")
LONG = "-sheet_nx 85 -sheet_ny 3 -report_strokes none -dt_max 1 -output_every 0"
FINISHED = "^FINISHED: every verdict holds"
INTERRUPTED = "^INTERRUPTED"
REFUSED = "^ssnp155: option "
WRITTEN = "history.csv summary.json report.html run.log !.lock"
NOTHING = "!*"


@dataclasses.dataclass
class Case:
    """RUN in a command is the program on the ranks, DIR the folder of results."""
    group: str
    what: str
    command: str
    code: int = 0
    last: str = FINISHED
    files: str = WRITTEN
    says: str = ""
    ranks: int = 1
    fast: bool = False
    before: tuple = ()
    environment: dict = dataclasses.field(default_factory=dict)
    counts: bool = False
    shorter: tuple = (("SMALL", SMALL), ("LONG", LONG))


RUN = f"RUN {SMALL} -output_dir DIR"
CASES = []


def add(group, what, command, *rest, both=False, **more):
    CASES.append(Case(group, what, command, *rest, **more))
    if both:
        more["fast"] = False
        CASES.append(Case(group, what, command, *rest, ranks=2, **more))


SCREEN = "Screen and pipes"
add(SCREEN, "the reader of the pipe leaves", f"{RUN} | head -1; exit ${{PIPESTATUS[0]}}", fast=True)
add(SCREEN, "nobody reads the pipe", f"{RUN} | true; exit ${{PIPESTATUS[0]}}")
add(SCREEN, "PETSc's monitor into a pipe that closes", f"{RUN} -snes_monitor | head -1; exit ${{PIPESTATUS[0]}}", fast=True)
add(SCREEN, "PETSc's log into a pipe that closes", f"{RUN} -log_view | head -1; exit ${{PIPESTATUS[0]}}")
add(SCREEN, "help into a pipe that closes", "RUN -help | head -1; exit ${PIPESTATUS[0]}", 0, "^ssnp155: sheet metal", NOTHING, fast=True)
add(SCREEN, "a dry run into a pipe that closes", f"{RUN} -dry_run | head -1; exit ${{PIPESTATUS[0]}}", 0, "^$", "model.svg !.lock")
add(SCREEN, "a refusal that nobody reads", "RUN -strok 1 2>&1 | true; exit ${PIPESTATUS[0]}", 2, "^$", NOTHING, fast=True)
add(SCREEN, "a full device as the screen", f"{RUN} >/dev/full", fast=True)
add(SCREEN, "standard output closed", f"{RUN} >&-")
add(SCREEN, "standard error closed", f"{RUN} 2>&-")
add(SCREEN, "standard input closed", f"{RUN} <&-", both=True)
add(SCREEN, "a pipe behind mpirun, kept open by tee", f"{RUN} | tee -p /dev/null | head -1; exit ${{PIPESTATUS[0]}}", ranks=2)

add(SCREEN, "quiet", f"{RUN} -quiet")
add(SCREEN, "quiet, without the table of steps", f"[ $({RUN} -quiet 2>&1 | grep -c ' ms') = 0 ] && [ $(grep -c ' ms' DIR/run.log) -gt 0 ]", says="all 8 hold", fast=True)
add(SCREEN, "no line beyond 80 columns, and no colour", f"{RUN} -monitor_iterations -pc_factor_levels 2 | tee out; "
    "! grep -P '.{81}|\\x1b' out", fast=True)

SIGNALS = "Signals and limits"


def started(more=""):
    """A run in the background that has made some steps."""
    return f"RUN {LONG}{more} -output_dir DIR & run=$!; steps DIR 8"


START = started()
KILLED = started(" -checkpoint_every 1") + "; kill -KILL $run; wait $run"
STOPPED = WRITTEN + " checkpoint-*/manifest.txt"
for name in ["HUP", "TERM", "INT", "USR1"]:
    add(SIGNALS, f"SIG{name}", f"{START}; kill -{name} $run; wait $run", 3, INTERRUPTED, STOPPED, f"by SIG{name}",
        fast=name == "HUP")
add(SIGNALS, "SIGUSR1 to mpirun", f"{START}; kill -USR1 $run; wait $run", 3, INTERRUPTED, STOPPED, "by SIGUSR1", ranks=2)
add(SIGNALS, "SIGTERM twice", f"{START}; kill $run; kill $run; wait $run", 3, INTERRUPTED, STOPPED)
add(SIGNALS, "the terminal goes away under nohup", f"nohup {START}; kill -HUP $run; steps DIR 12; kill $run; wait $run", 3,
    INTERRUPTED, STOPPED, "by SIGTERM")
add(SIGNALS, "stopped and continued", f"{START}; kill -STOP $run; sleep 1; kill -CONT $run; steps DIR 12; kill $run; wait $run", 3,
    INTERRUPTED, STOPPED)
# What timeout does when its time is up, it does as well when it is asked to end itself: however slow the machine, there are steps then.
add(SIGNALS, "timeout", f"timeout --preserve-status 1h {START}; kill $run; wait $run", 3, INTERRUPTED, STOPPED, "by SIGTERM")
add(SIGNALS, "a limit of time", f"RUN {LONG} -wall_limit 4 -output_dir DIR", 3, INTERRUPTED, STOPPED, "-wall_limit", both=True)
add(SIGNALS, "killed, and a new run", f"{RUN}", 2, "interrupted run \\(checkpoint-.*-restart.*-overwrite", "history.csv !summary.json",
    before=(KILLED,))
add(SIGNALS, "killed before any checkpoint, and a new run", RUN, says="replaces a run that was cut short",
    before=(f"{START}; kill -KILL $run; wait $run",))
add(SIGNALS, "killed and resumed", f"RUN {LONG} -wall_limit 4 -restart -output_dir DIR", 3, INTERRUPTED, STOPPED, "resumed from",
    before=(KILLED,))

FOLDER = "The folder of results"
IN_USE = "the output folder .* is in use by process [0-9]+ on .* since .* UTC"
for what, words in [("a second run", SMALL), ("a dry run", "-dry_run"), ("a restart", f"{LONG} -restart")]:
    for ranks in [1, 2]:
        CASES.append(Case(FOLDER, f"{what} into a folder in use",
                          f"RUN {LONG} -output_dir DIR >DIR.txt & run=$!; steps DIR 6; RUN {words} -output_dir DIR; code=$?; "
                          "kill -USR1 $run; wait $run; exit $code", 2, IN_USE, STOPPED, ranks=ranks,
                          fast=ranks == 1 and what == "a second run"))
STOP = f"{START}; kill -USR1 $run; wait $run"
PROTECTED = "interrupted run \\(checkpoint-.*-restart.*-overwrite"
add(FOLDER, "a new run over an interrupted one", RUN, 2, PROTECTED, STOPPED, before=(STOP,), both=True, fast=True)
add(FOLDER, "a new run over an interrupted one, wanted", f"{RUN} -overwrite", files=WRITTEN + " !checkpoint-*", before=(STOP,),
    says="replaces an interrupted run and its checkpoint-")
add(FOLDER, "a checkpoint from elsewhere over an interrupted run", f"RUN {LONG} -output_dir DIR -restart $(ls -d DIR2/checkpoint-*|tail -1)",
    2, PROTECTED, STOPPED, before=(STOP, STOP.replace("DIR", "DIR2")))
add(FOLDER, "an interrupted run goes on", f"RUN {LONG} -output_dir DIR -restart -wall_limit 3", 3, INTERRUPTED, STOPPED, "resumed from",
    before=(STOP,), both=True)
add(FOLDER, "a new run over a finished one", RUN, says="replaces a finished run", before=(RUN,), both=True, fast=True)
add(FOLDER, "a new run over a failed one", RUN, says="replaces a run that failed", before=(f"{RUN} -ts_max_steps 1",))
add(FOLDER, "a dry run beside an interrupted one", f"{RUN} -dry_run", 0, "", STOPPED + " model.svg", before=(STOP,))
add(FOLDER, "a lock file left behind", RUN, before=("mkdir DIR; echo process 1 >DIR/.lock",), fast=True)
add(FOLDER, "a folder in the place of the lock", RUN, 2, "/.lock cannot be written over: Is a directory", "!history.csv",
    before=("mkdir -p DIR/.lock",), both=True)
add(FOLDER, "a folder in the place of the log", RUN, 2, "/run.log cannot be written over: it is not a file", "!history.csv",
    before=("mkdir -p DIR/run.log",), both=True)
add(FOLDER, "a link to a folder", RUN, before=("mkdir DIR2; ln -s DIR2 DIR",))
add(FOLDER, "a link to nowhere", RUN, 2, "cannot create the output folder", NOTHING, before=("ln -s nowhere/at/all DIR",))
add(FOLDER, "deleted while the run goes on", f"{START}; rm -rf DIR; wait $run", 2, "^ssnp155: .*results", NOTHING)

AROUND = "Environment"
add(AROUND, "no HOME", f"env -u HOME {RUN}", both=True)
add(AROUND, "a HOME that is not there", RUN, environment={"HOME": "/nonexistent"}, both=True)
add(AROUND, "no TMPDIR", f"env -u TMPDIR {RUN}")
add(AROUND, "Turkish letters", RUN, environment={"LANG": "tr_TR.UTF-8", "LC_ALL": "tr_TR.UTF-8"})
add(AROUND, "decimal commas", RUN, environment={"LC_ALL": "de_DE.UTF-8"})
add(AROUND, "a locale that is not there", RUN, environment={"LC_ALL": "xx_XX"})
add(AROUND, "no environment but PATH", f"env -i PATH=$PATH {RUN}")
add(AROUND, "more ranks than cores", RUN, ranks=7)
add(AROUND, "as many ranks as elements", f"{RUN} -sheet_nx 2 -sheet_ny 2 -contact_points_per_edge 8", 1, "verdict",
    ranks=4)
add(AROUND, "more ranks than elements", f"{RUN} -sheet_nx 2 -sheet_ny 1", 2, "too many MPI ranks: 3", NOTHING, ranks=3)
add(AROUND, "too little address space for the BLAS", f"ulimit -v 300000; {RUN}", 2, "a limit on memory .* leaves less than 192 MB",
    "!history.csv", fast=True)
add(AROUND, "enough address space", f"ulimit -v 2000000; {RUN}")
add(AROUND, "a name with a blank and umlauts", f"RUN {SMALL} -output_dir 'DIR/Blech für März'", files="Blech*/summary.json")
add(AROUND, "the longest path there can be", f"RUN {SMALL} -output_dir DIR/$(printf 'x%.0s' {{1..300}})", 2,
    "cannot create the output folder .*File name too long", NOTHING)

SOLVERS = "PETSc: linear solvers"
NOT_SYMMETRIC = "the matrix with the contact unknowns is not symmetric"


def solver(pc, ksp, code, last, says="", ranks=(1, 2), **more):
    least = " -dt_min 0.05" if code == 1 else ""
    for count in ranks:
        add(SOLVERS, f"{ksp} with {pc}", f"{RUN} -pc_type {pc} -ksp_type {ksp}{least}", code, last, NOTHING if code == 2 else WRITTEN,
            says, counts=True, ranks=count, **more)


for ksp in ["gmres", "fgmres", "bcgs", "preonly"]:
    solver("lu", ksp, 0, FINISHED)
for pc in ["bjacobi", "asm"]:
    solver(f"{pc} -sub_pc_type lu", "gmres", 0, FINISHED)
for pc in ["ilu", "bjacobi", "asm"]:
    ranks = (1,) if pc == "ilu" else (1, 2)
    solver(pc, "bcgs", 0, FINISHED, ranks=ranks)
    for ksp in ["gmres", "fgmres", "preonly"]:
        solver(pc, ksp, 1, "FAILED", f"leave out -pc_type {pc}", ranks=ranks)
solver("ilu", "gmres", 2, f"{REFUSED}-pc_type ilu: it factorises on one rank only", ranks=(2,))
for ksp in ["cg", "minres"]:
    for pc in ["lu", "ilu"]:
        solver(pc, ksp, 2, f"{REFUSED}-ksp_type {ksp}: {NOT_SYMMETRIC}")
for pc in ["cholesky", "icc"]:
    solver(pc, "gmres", 2, f"{REFUSED}-pc_type {pc}: {NOT_SYMMETRIC}")
for pc in ["gamg", "fieldsplit"]:
    solver(pc, "gmres", 2, f"{REFUSED}-pc_type {pc}: the rows that are solved for change")
add(SOLVERS, "a preconditioner alone", f"{RUN} -pc_type asm", counts=True, both=True)

CHOICES = "PETSc: other options"


def option(what, words, code=0, last=FINISHED, says="", files=None, **more):
    files = files or (NOTHING if code == 2 else WRITTEN)
    add(CHOICES, what, f"{RUN} {words}", code, last, files, says, counts=True, **more)


option("a solver without bounds", "-snes_type newtonls", 2, f"{REFUSED}-snes_type newtonls: the bound of the gap needs", both=True, fast=True)
option("another one", "-snes_type ngmres", 2, f"{REFUSED}-snes_type ngmres: the bound of the gap needs")
option("the semismooth solver", "-snes_type vinewtonssls -dt_min 0.05", 1, "FAILED", "leave out -snes_type vinewtonssls", both=True)
option("a line search that backtracks", "-snes_linesearch_type bt -dt_min 0.05", 1, "FAILED", "leave out -snes_linesearch_type bt",
       both=True, fast=True)
for search in ["basic", "l2", "cp"]:
    option(f"line search {search}", f"-snes_linesearch_type {search}")
option("floating-point traps", "-fp_trap", 2, f"{REFUSED}-fp_trap: compilers", both=True, fast=True)
option("floating-point traps, in the environment", "", 2, f"{REFUSED}-fp_trap", environment={"PETSC_OPTIONS": "-fp_trap on"})
option("MUMPS's option without the prefix", "-mat_mumps_icntl_14 80",
       says="-mat_mumps_icntl_14 has no effect on the program's own linear solve", both=True, fast=True)
option("MUMPS's option with the prefix", "-condensed_mat_mumps_icntl_14 80", both=True)
option("MUMPS's option with PETSc's solve", "-pc_type lu -mat_mumps_icntl_14 80", both=True)
option("a preconditioner's option without the prefix", "-pc_factor_levels 2", says="-pc_factor_levels has no effect on the program's own")
option("Cholesky of the condensed system", "-condensed_pc_type cholesky", both=True)
option("PETSc's factors of the condensed system", "-condensed_pc_factor_mat_solver_type petsc")
option("GMRES around our solve", "-ksp_type gmres", both=True)
option("PETSc's signal handlers", "-no_signal_handler 0")
option("the Jacobian against differences", "-snes_test_jacobian")
option("an old Jacobian", "-snes_lag_jacobian 2")
option("a loose tolerance", "-snes_atol 1e-3", 1, "but 2 verdicts do not hold", fast=True)
option("a relative tolerance", "-snes_rtol 1e-2", 1, "verdicts? do(es)? not hold")
option("a tolerance on the step", "-snes_stol 1e-2", says="-snes_stol has no effect")
option("our own loose tolerance", "-newton_tolerance 1e-5", 1, "verdicts? do(es)? not hold")
option("no convergence test", "-snes_convergence_test skip -newton_max_iterations 2", 1, "verdicts? do(es)? not hold|FAILED", fast=True)
option("one iteration", "-snes_max_it 1 -dt_min 0.05", 1, "FAILED")
option("a limit on evaluations", "-snes_max_funcs 2 -dt_min 0.05", 1, "FAILED", "leave out -snes_max_funcs 2")
option("one step", "-ts_max_steps 1", 1, "FAILED")
option("no refused step", "-ts_max_snes_failures 0")
option("our step control replaced", "-ts_adapt_type basic", 2, f"{REFUSED}-ts_adapt_type basic: the program chooses the steps")
option("the spectral radius", "-ts_alpha_radius 0.5", 2, f"{REFUSED}-ts_alpha_radius")
option("every monitor at once", "-snes_monitor -ksp_monitor -ts_monitor -snes_view -ts_view -ksp_converged_reason", both=True)
option("PETSc's log", "-log_view", both=True)
option("PETSc's information", "-info", both=True)
option("PETSc's memory, checked", "-malloc_debug -malloc_dump")
option("the options, shown", "-options_view -options_left", both=True)
option("PETSc's version", "-version")
option("citations", "-citations")
option("a matrix of another type", "-condensed_mat_type dense", says="-condensed_mat_type dense has no effect")
option("an unknown package", "-condensed_pc_factor_mat_solver_type nonsense", 2, "^ssnp155: PETSc error 92", files="!summary.json", both=True)
option("a package that is not there", "-pc_type lu -pc_factor_mat_solver_type strumpack", 2, "^ssnp155: PETSc error 92", files="!summary.json",
       both=True)
option("a typing mistake in PETSc's option", "-snes_maxit 4", says="-snes_maxit 4 has no effect: PETSc did not read it", fast=True)
option("vectors on a device that is not there", "-vec_type cuda", says="-vec_type cuda has no effect")
option("the right-hand side's Jacobian, tested", "-ts_rhs_jacobian_test_mult", 2, f"{REFUSED}-ts_rhs_jacobian_test_mult: there is no right-hand", fast=True)
option("monitors of fields", "-snes_monitor_fields", 2, f"{REFUSED}-snes_monitor_fields: it needs a grid")
option("a graph without a display", "-ts_monitor_lg_timestep", 2, f"{REFUSED}-ts_monitor_lg_timestep: it draws", environment={"DISPLAY": ""})
option("an error in place of a refused solve", "-snes_error_if_not_converged", 2, f"{REFUSED}-snes_error_if_not_converged: a solve that")
AT_ZERO = "pc_factor_nonzeros_along_diagonal"
option("rows in another order", f"-condensed_{AT_ZERO}", 2, f"{REFUSED}-condensed_{AT_ZERO}: PETSc ends by a signal with it", fast=True)
option("rows in another order, of the whole system", f"-pc_type lu -{AT_ZERO}", 2, f"{REFUSED}-{AT_ZERO}: PETSc ends by a signal with it")
option("rows in another order, by PETSc itself", f"-pc_type lu -pc_factor_mat_solver_type petsc -{AT_ZERO}",
       says=f"-{AT_ZERO} matters only where an entry of the diagonal is zero")
option("a Jacobian by differences", "-snes_fd", 2, f"{REFUSED}-snes_fd: differences cannot follow")
option("a tolerance of a direct solve", "-ksp_rtol 1e-2", says="-ksp_rtol has no effect as the solve is direct")
option("a parameter of another line search", "-snes_linesearch_damping 0.5", says="-snes_linesearch_damping has no effect on the program's own")

COMPARED = "Two runs side by side"
for ranks in [1, 2]:
    CASES.append(Case(COMPARED, "two runs", "RUN -compare DIR2,DIR3 -output_dir DIR", 0, "^$", "comparison.html !history.csv", "options that differ",
                      ranks=ranks, fast=ranks == 1, before=(RUN.replace("DIR", "DIR2"), RUN.replace("DIR", "DIR3") + " -sheet_ny 1")))
add(COMPARED, "a folder without a run", "RUN -compare DIR2,DIR3 -output_dir DIR", 2, "-compare: .* holds no run that has ended", NOTHING, fast=True)
add(COMPARED, "a run that was killed", "RUN -compare DIR2,DIR2 -output_dir DIR", 2, "summary.json, a run's last file, is not there", NOTHING,
    before=("mkdir DIR2; touch DIR2/history.csv",))
add(COMPARED, "one folder", "RUN -compare DIR2", 2, f"{REFUSED}-compare .*: these are not two paths", NOTHING)
