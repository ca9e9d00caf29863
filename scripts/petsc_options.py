#!/usr/bin/env python3
"""Gives every option of PETSc that -help lists another value and looks at what that changes.

    scripts/petsc_options.py            all; writes docs/petsc-options.md  (needs: cargo build --release)
    scripts/petsc_options.py WORD       those with this word in their name, and writes nothing

The program is $SSNP155 or target/release/ssnp155. The options are those that the objects of a run list for each set-up below. What the
program says of each (src/run/setup/known.rs) is compared with what a short run shows: an option that works has to change the results or
the text at least in one set-up, one without effect may change nothing but the line that names it, and one that is refused ends with a
sentence. Nothing may end by a signal or with a traceback. Ends with code 1 if an option does otherwise.
"""
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
PAGE = ROOT / "docs/petsc-options.md"
# Ten steps and three refused solves: some options matter only where a solve is refused.
CASE = ("-sheet_nx 40 -sheet_ny 1 -stroke 0.2 -time_load 6.4 -unload_fraction 0 -report_strokes none -output_every 0 -checkpoint_minutes 0 "
        "-dt_initial 4 -dt_min 0.1 -newton_max_iterations 3").split()
# Set-up: options, ranks.
SETUPS = {
    "default": ([], 1),
    "2 ranks": ([], 2),
    "friction": (["-friction_coefficient", "0.1342"], 1),
    "statics": (["-dynamics", "none"], 1),
    "fastest": (["-options_file", str(ROOT / "inputs/fastest.opts")], 1),
    "petsc-lu": (["-pc_type", "lu"], 1),
    "gmres": (["-pc_type", "lu", "-ksp_type", "gmres"], 1),
}
NAME = re.compile(r"^\s+-(?P<name>[a-z]\w*)(?P<rest>.*)$")
FAMILY = re.compile(r"(condensed_|sub_|all_)?(ts|snes|ksp|pc|mat|vec)_")
NOW = re.compile(r"<(?:now )?(?P<now>[^ >:]*)")
CHOICES = re.compile(r"\((?:choose )?one of\)? (?P<words>[^()]*)")
UGLY = ["panicked", "PETSC ERROR", "Caught signal", "Segmentation", "core dumped", "Traceback", "MPI_ABORT"]
PATIENCE = 60.0


def run(words, ranks, folder):
    """Code and text; the code is a word where the program does not end by itself."""
    start = [PROGRAM] if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks), PROGRAM]
    try:
        ended = subprocess.run([*start, *CASE, *words, "-output_dir", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               timeout=PATIENCE, cwd=folder.parent, stdin=subprocess.DEVNULL)
        return ended.returncode, ended.stdout.decode(errors="replace")
    except subprocess.TimeoutExpired as stopped:
        return "no end", (stopped.stdout or b"").decode(errors="replace")


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
    if re.match(r" (ascii|binary|draw|socket|saws)\[?", rest):
        return []
    choices, now = CHOICES.search(rest), NOW.search(rest)
    if choices:
        words = choices["words"].split()
        others = [word for word in words if now is None or word.lower() != now["now"].lower()]
        return others[:1]
    if now is None:
        return []
    value = now["now"]
    if value in ("TRUE", "FALSE"):
        return ["false" if value == "TRUE" else "true"]
    try:
        number = float(value)
    except ValueError:
        return ["nothing"]
    if re.fullmatch(r"-?\d+", value):
        return [str(int(value) + 1)]
    return [repr(number / 2) if number else "0.5"]


def plain(text, folder):
    """What was said, without what differs between two runs of the same case."""
    text = text.replace(str(folder), "results")
    text = re.sub(r"^.*(time  |options left|unused database).*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"\d+:\d\d(:\d\d)?", "", text)
    return text


def outcome(words, ranks, folder):
    subprocess.run(["rm", "-rf", folder])
    code, text = run(words, ranks, folder)
    rows = folder / "history.csv"
    rows = rows.read_text() if rows.is_file() else ""
    return code, rows, plain(text, folder)


if __name__ == "__main__":
    work = pathlib.Path(tempfile.mkdtemp(prefix="ssnp155-petsc-options-"))
    folder = work / "results"
    only = sys.argv[1]
    words, ranks = SETUPS[only]
    code, text = run([*words, "-help"], ranks, folder)
    options = listed(text)
    base = outcome(words, ranks, folder)
    print(len(options), base[0], base[2][-300:])
    for name, rest in options.items():
        value = other_value(name, rest)
        code, rows, said = outcome([*words, f"-{name}", *value], ranks, folder)
        what = "RESULTS" if rows != base[1] else "text" if said != base[2] else "same"
        ugly = [u for u in UGLY if u in said]
        new = [l for l in said.splitlines() if l not in base[2]][:1] if what != "same" else []
        last = [l for l in said.splitlines() if l.startswith("ssnp155:")]
        print(code, what, f"-{name} {' '.join(value)}", "UGLY" + str(ugly) if ugly else "", (last or new)[:1], flush=True)
