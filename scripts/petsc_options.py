#!/usr/bin/env python3
"""Gives every option of PETSc that -help lists another value and looks at what that changes.

    scripts/petsc_options.py            all; writes docs/petsc-options.md  (needs: cargo build --release)
    scripts/petsc_options.py WORD       those with this word in their name, again; the page follows if all others were tried

What was found is kept in target/petsc-options.json, and a run that was cut short goes on from there while the program is the same.
The program is $SSNP155 or target/release/ssnp155. The options are those that the objects of a run list for each set-up below. What the
program says of each (src/run/setup/known/) is compared with what a short run shows: an option that works has to change the results or
the text at least in one set-up, one without effect may change nothing but the line that names it, and one that is refused ends with a
sentence. Nothing may end by a signal, with a traceback, or be still for a minute. Ends with code 1 if an option does otherwise.
"""
import collections
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from watched import watched

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
PAGE = ROOT / "docs/petsc-options.md"
KEPT = ROOT / "target/petsc-options.json"
# Ten steps and three refused solves: some options matter only where a solve is refused.
CASE = ("-sheet_nx 40 -sheet_ny 1 -stroke 0.2 -time_load 6.4 -unload_fraction 0 -report_strokes none -output_every 0 -checkpoint_minutes 0 "
        "-dt_initial 4 -dt_min 0.1 -newton_max_iterations 3").split()
# Set-up: options, ranks, and which options that had no effect before are tried again: those that its solvers may read. In this order,
# because an option that was seen to work is not tried again.
SETUPS = {
    "default": ([], 1, r"."),
    "petsc-lu": (["-pc_type", "lu"], 1, r"^(mat|pc|ksp|snes_ksp)_"),
    "gmres": (["-pc_type", "bjacobi", "-sub_pc_type", "lu", "-ksp_type", "gmres"], 1, r"^(sub_)?(mat|pc|ksp)_|snes_ksp_ew$"),
    "band": (["-options_file", str(ROOT / "inputs/band.opts")], 1, r"^condensed_(mat|pc)_"),
    "line search": (["-snes_linesearch_type", "l2"], 1, r"^snes_linesearch_"),
    "backtracking": (["-snes_linesearch_type", "bt"], 1, r"^snes_linesearch_"),
    "statics": (["-dynamics", "none"], 1, r"^ts_"),
    "friction": (["-friction_coefficient", "0.1342"], 1, r"^$"),
    "2 ranks": ([], 2, r"^$"),
}
# Values of options whose line in the help does not say enough.
VALUES = {
    "ts_adapt_clip": "0.5,1.5",
    "ts_adapt_wnormtype": "infinity",
    "ts_adapt_safety": "0.5",
    "ts_adapt_reject_safety": "0.3",
    "mat_mumps_icntl_20": "10",
    "sub_pc_factor_mat_solver_type": "mumps",
    "ksp_gmres_modifiedgramschmidt": "true",
    "ts_time_span": "0,1",
    "ts_monitor_frequency": "3",
    "ts_adapt_scale_solve_failed": "0.2",
    "snes_vi_zero_tolerance": "1e-3",
    "snes_divergence_tolerance": "1.5",
    "snes_convergence_test": "skip",
    "snes_linesearch_damping": "0.5",
    "ksp_fischer_guess": "1,10",
    "ksp_guess_type": "fischer",
    "pc_type": "none",
    "ksp_type": "gmres",
    "snes_type": "vinewtonssls",
    "snes_linesearch_type": "l2",
    "pc_factor_mat_solver_type": "petsc",
    "pc_factor_mat_ordering_type": "rcm",
}
NAME = re.compile(r"^\s+-(?P<name>[a-z]\w*)(?P<rest>.*)$")
FAMILY = re.compile(r"(condensed_|sub_|all_)?(ts|snes|ksp|pc|mat|vec)_")
PREFIX = re.compile(r"^(condensed_|sub_|redundant_|all_)+")
NOW = re.compile(r"<(?:now )?(?P<now>[^ >:]*)")
CHOICES = re.compile(r"\((?:choose )?one of\)? (?P<words>[^()]*)")
UGLY = ["panicked", "PETSC ERROR", "Caught signal", "Segmentation", "core dumped", "Traceback", "MPI_ABORT"]


def run(words, ranks, folder):
    """Code and text; the code is a word where the program does not end by itself."""
    start = [PROGRAM] if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks), PROGRAM]
    return watched([*start, *CASE, *words, "-output_dir", str(folder)], folder.parent)


def listed(text):
    """Names of PETSc's options in a help text, each with the line it stands in; the program's own come before the first rule."""
    _, _, petscs = text.partition("----------------------------------------")
    found = collections.OrderedDict()
    for line in petscs.splitlines():
        match = NAME.match(line)
        if match and FAMILY.match(match["name"]):
            found.setdefault(match["name"], match["rest"])
    return found


def other_value(name, rest):
    """A value that an option does not have, by what its line in the help says."""
    bare = PREFIX.sub("", name)
    for known in (name, bare):
        if known in VALUES:
            return [VALUES[known]]
    if re.match(r" (ascii|binary|draw|socket|saws)\[?", rest):
        return []
    choices, now = CHOICES.search(rest), NOW.search(rest)
    if choices:
        words = choices["words"].split()
        return [word for word in words if now is None or word.lower() != now["now"].lower()][:1]
    if now is None:
        return []
    value = now["now"]
    if value in ("TRUE", "FALSE"):
        return ["false" if value == "TRUE" else "true"]
    if re.fullmatch(r"-?\d+", value):
        return ["3" if value == "2" else "2"]
    try:
        number = float(value)
    except ValueError:
        return ["nothing"]
    return [repr(number * 1e3 if abs(number) < 1.0 else number / 1e3) if number else "0.5"]


def plain(text, folder):
    """What was said, without what differs between two runs of the same case."""
    text = text.replace(str(folder), "results")
    text = re.sub(r"^.*(time  |options left|unused database).*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"\d+:\d\d(:\d\d)?", "", text)
    return text


def outcome(words, ranks, folder):
    shutil.rmtree(folder, ignore_errors=True)
    code, text = run(words, ranks, folder)
    rows = folder / "history.csv"
    rows = rows.read_text() if rows.is_file() else ""
    return code, rows, plain(text, folder)


class Base:
    """What a set-up shows without the option: the run, and its solvers as PETSc views them."""

    VIEWS = "-ts_view -snes_view -ksp_view ::ascii_info_detail -condensed_ksp_view ::ascii_info_detail".split()

    def __init__(self, name, folder):
        words, self.ranks, _ = SETUPS[name]
        self.words = [*words, *self.VIEWS]
        self.folder = folder
        self.code, self.rows, self.said = outcome(self.words, self.ranks, folder)
        if outcome(self.words, self.ranks, folder)[1:] != (self.rows, self.said):
            sys.exit(f"set-up {name}: two runs without any option differ, so nothing can be seen")

    def listed(self):
        return listed(run([*self.words, "-help"], self.ranks, self.folder)[1])

    def tried(self, words):
        """What the program says becomes of the option, what was seen, and what is wrong with that."""
        option = words[0]
        trace = self.folder.parent / "SA-data"
        shutil.rmtree(trace, ignore_errors=True)
        code, rows, said = outcome([*self.words, *words], self.ranks, self.folder)
        if option in self.VIEWS:
            return "works", "text", []
        if trace.exists():
            return "works", "files", []
        flat = " ".join(said.split())
        problems = [word for word in UGLY if word in said]
        refusal = re.search(rf"ssnp155: option {option}\b[^:]*: (.*?)(; leave it out, and (.*)|$)", flat)
        if code == 2 and refusal:
            if not refusal[3]:
                problems.append("it is refused, and nothing is said to do instead")
            return "refused", refusal[1], problems
        by_petsc = re.search(r"ssnp155: PETSc error \d+: (.*?)(; if a value|$)", flat)
        if code == 2 and by_petsc:
            return "refused", "by PETSc: " + by_petsc[1], problems
        if code not in (0, 1):
            return "works", f"code {code}", [*problems, f"code {code}: {flat[-200:]}"]
        if f"option {option} is not known" in flat:
            problems.append("it has no row in src/run/setup/known/")
        silent = re.search(rf"option {option} has no effect,? ?(.*?)(?= (warning|note): | done left)", flat)
        if silent:
            if rows != self.rows:
                problems.append("it is said to have no effect, and the results change")
            return "no effect", silent[1], problems
        rare = re.search(rf"option {option} matters only where (.*?)(?= (warning|note): | done left)", flat)
        if rows != self.rows:
            return "works", "results", problems
        if rare:
            return "works", "only where " + rare[1], problems
        return "works", "text" if said != self.said else "", problems


class Record:
    """What was found of each option in each set-up, by which program; kept in a file."""

    def __init__(self):
        self.program = hashlib.sha256(pathlib.Path(PROGRAM).read_bytes()).hexdigest()
        self.found = json.loads(KEPT.read_text()) if KEPT.is_file() else {}

    def fates(self, name):
        """Fate and what was seen, by set-up."""
        return {setup: (fate, what) for setup, (fate, what, problems, program) in self.found.get(name, {}).items()}

    def settled(self, name):
        """Whether the option was refused or seen to work, by this program."""
        return any(program == self.program and not problems and (fate == "refused" or fate == "works" and what)
                   for fate, what, problems, program in self.found.get(name, {}).values())

    def silent(self, name):
        """Whether the program said wherever it was tried that the option has no effect."""
        found = [fate for fate, _, _, program in self.found.get(name, {}).values() if program == self.program]
        return bool(found) and set(found) == {"no effect"}

    def tried(self, name, setup):
        return self.found.get(name, {}).get(setup, [None] * 4)[3] == self.program

    def keep(self, name, setup, fate, what, problems):
        self.found.setdefault(name, {})[setup] = [fate, what, problems, self.program]
        KEPT.write_text(json.dumps(self.found, indent=1))

    def problems(self):
        """What is wrong, a line each."""
        for name, seen in self.found.items():
            for setup, (_, _, problems, _) in seen.items():
                if problems:
                    yield f"{setup}: -{name}: {'; '.join(problems)}"
            shown = any(fate == "refused" or fate == "works" and what for fate, what, _, _ in seen.values())
            if not shown and any(fate == "works" for fate, _, _, _ in seen.values()):
                yield f"-{name} is said to work, and nothing was seen to change"


def main():
    chosen = sys.argv[1] if len(sys.argv) > 1 else ""
    work = pathlib.Path(tempfile.mkdtemp(prefix="ssnp155-petsc-options-"))
    record, again = Record(), set()
    names = collections.OrderedDict()
    for setup in SETUPS:
        base = Base(setup, work / "results")
        for name, rest in base.listed().items():
            names[name] = None
            if chosen not in name:
                continue
            if chosen and name not in again:
                again.add(name)
                record.found.pop(name, None)
            if record.settled(name) or record.tried(name, setup):
                continue
            if record.silent(name) and not re.search(SETUPS[setup][2], name):
                continue
            words = [f"-{name}", *other_value(name, rest)]
            fate, what, problems = base.tried(words)
            record.keep(name, setup, fate, what, problems)
            print(f"{'WRONG' if problems else 'good '} {setup:12} {' '.join(words):50} {fate}: {what} {'; '.join(problems)}", flush=True)
    shutil.rmtree(work, ignore_errors=True)
    wrong = list(record.problems())
    for line in wrong:
        print(f"WRONG {line}")
    untried = [name for name in names if name not in record.found]
    print(f"{len(names)} options, {len(wrong)} not as they have to be, {len(untried)} not tried")
    if not wrong and not untried:
        write_page({name: record.fates(name) for name in names})
    return 1 if wrong else 0


SEEN = {"results": "other results", "files": "files beside the results", "text": "other text, of its own or in PETSc's view of the solvers"}


def write_page(found):
    groups = collections.OrderedDict()
    for name, seen in found.items():
        refused = next((what for fate, what in seen.values() if fate == "refused"), None)
        works = next(((setup, what) for setup, (fate, what) in seen.items() if fate == "works" and what), None)
        silent = collections.OrderedDict((what, None) for fate, what in seen.values() if fate == "no effect")
        if refused:
            cells = "refused", refused
        elif works:
            setup, what = works
            with_ = "" if setup == "default" else f" with {setup}"
            cells = "works" + (", else no effect" if silent else ""), "; ".join([SEEN.get(what, what) + with_, *silent])
        else:
            cells = "no effect", "; ".join(silent)
        groups.setdefault(cells, []).append(name)
    version = re.search(r"Release Version ([\d.]+)", subprocess.run([PROGRAM, "-version", "-help"], capture_output=True, text=True).stdout)
    text = ("# PETSc's options\n\n<!-- Written by scripts/petsc_options.py; changes by hand are lost. -->\n\n"
            f"Every option that PETSc{' ' + version[1] if version else ''} lists with `-help` for the time stepper, the nonlinear and the linear solvers, the\n"
            "preconditioners and matrices of a run, and what becomes of it. `scripts/petsc_options.py` gave each another value in a short run and\n"
            "looked at what changed; the program says the same at the start of a run. With `cargo test` a test fails where `-help` lists an option\n"
            "that has no row in `src/run/setup/known/`. An option of another version of PETSc that is not here is named by a note at the start.\n"
            "Single values that are refused, such as `-ksp_type cg`, are in [hard-use.md](hard-use.md).\n\n"
            "Set-ups: " + ", ".join(f"{name} (`{' '.join(words).replace(str(ROOT) + '/', '')}`)" if words else name for name, (words, _, _) in SETUPS.items()) + ".\n")
    for fate in ["works", "works, else no effect", "no effect", "refused"]:
        rows = [(what, names) for (which, what), names in groups.items() if which == fate]
        if rows:
            text += f"\n## {fate[0].upper()}{fate[1:]}\n\n| options | {'seen' if fate.startswith('works') else 'why'} |\n|---|---|\n"
            text += "".join(f"| {' '.join(f'`-{name}`' for name in names)} | {what} |\n" for what, names in rows)
    PAGE.write_text(text)


if __name__ == "__main__":
    sys.exit(main())
