#!/usr/bin/env python3
"""Uses the program as a shell, a cluster or a person who knows PETSc would, and compares how each case ends.

    scripts/hard_use.py             all cases; writes docs/hard-use.md  (needs: cargo build --release)
    scripts/hard_use.py fast        those of a second or two each, which cargo test runs
    scripts/hard_use.py WORD        those with this word in their name or command; the page follows if the others ended well before

The program is $SSNP155 or target/release/ssnp155. A case is what is done, the command, and how it has to end: the exit code, the last
sentence (a regular expression) and what lies in the folder. Whatever the case, nothing may end by a signal, with a traceback as the last
words, or be still for 60 s: no line on the screen, in a log or in a table. There is no other limit of time, so a slow machine does not
change what is found. Where .venv has VTK, its reader opens the field files that a case leaves. Ends with code 1 if a case ends otherwise.
The rows of the page are kept in target/hard-use.json.
"""
import dataclasses
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from hard_use_cases import CASES
from watched import watched

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
PAGE = ROOT / "docs/hard-use.md"
KEPT = ROOT / "target/hard-use.json"
NEVER = ["panicked", "PETSC ERROR", "Caught signal", "Segmentation", "core dumped", "Traceback", "MPI_ABORT"]
SHELL = """
set -o pipefail
steps() { until [ "$(cat "$1/history.csv" 2>/dev/null | wc -l)" -ge "$2" ]; do sleep 0.02; done; }
"""
LAST = re.compile(r"^(?:[=#~]  )?((?:ssnp155: |FINISHED|FAILED|INTERRUPTED).*)$", re.MULTILINE)


def filled(template, case, folder):
    """The command of a template: RUN is the program on the case's ranks, DIR the folder of results."""
    start = PROGRAM if case.ranks == 1 else f"mpirun --oversubscribe -n {case.ranks} {PROGRAM}"
    return template.replace("RUN", start).replace("DIR", str(folder))


def shown(template, case):
    """The command as the page shows it."""
    start = "ssnp155" if case.ranks == 1 else f"mpirun -n {case.ranks} ssnp155"
    return template.replace("RUN", start).replace("-output_dir DIR", "").replace("DIR", "results").strip()


def bash(command, folder, environment):
    return watched(["bash", "-c", SHELL + command], folder.parent, environment)


def tried(case, folder):
    """How the case ended: code, last sentence, all that was said, and what does not agree."""
    for command in case.before:
        bash(filled(command, case, folder), folder, {})
    log = folder / "run.log"
    before = log.stat().st_mtime_ns if log.is_file() else None
    code, text = bash(filled(case.command, case, folder), folder, case.environment)
    # A log that is older is that of another run.
    logged = log.read_text() if log.is_file() and log.stat().st_mtime_ns != before else ""
    sentences = LAST.findall(text) or LAST.findall(logged)
    last = sentences[-1] if sentences else ""
    wrong = []
    if code != case.code:
        wrong.append(f"code {code} and not {case.code}")
    if not re.search(case.last, last):
        wrong.append(f"the last sentence is not /{case.last}/")
    # Lines are broken where a terminal ends.
    if case.says not in " ".join((text + " " + logged).split()):
        wrong.append(f"nowhere '{case.says}'")
    for word in NEVER:
        if word in text:
            wrong.append(f"the text has '{word}'")
    for name in case.files.split():
        there = any(folder.glob(name.lstrip("!")))
        if there == name.startswith("!"):
            wrong.append(f"{name.lstrip('!')} is {'' if there else 'not '}there")
    return code, last, text, wrong


FIELDS = ["fields.vtkhdf", "tools.vtkhdf", "contact.vtkhdf"]


def keep_fields(folder, to):
    """Copies the field files of a case that left some, for VTK to read them all at once."""
    if (folder / FIELDS[0]).is_file():
        to.mkdir(parents=True)
        for name in FIELDS:
            shutil.copy(folder / name, to)


def open_fields(folders):
    """How many cases left field files that VTK's reader does not take; says so."""
    if not folders:
        return 0
    python = ROOT / ".venv/bin/python"
    if not python.exists() or subprocess.run([python, "-c", "import vtk"], capture_output=True).returncode:
        print("no field file was opened: .venv has no VTK (scripts/test.sh makes it)")
        return 0
    read = subprocess.run([python, ROOT / "scripts/read_fields.py", *folders], capture_output=True, text=True)
    bad = {line.split("/fields/")[1].split("/")[0] for line in read.stderr.splitlines() if "/fields/" in line}
    print(f"VTK's reader opens the fields of {len(folders) - len(bad)} of {len(folders)} cases that left some", read.stderr)
    return len(bad) or int(read.returncode != 0)


def effort(folder):
    """Steps, refused solves and Newton iterations of a run that left a summary."""
    try:
        counts = json.loads((folder / "summary.json").read_text())["counts"]
    except (OSError, ValueError, KeyError):
        return ""
    return f"{counts['steps']} steps, {counts['refused_solves']} refused, {counts['newton_iterations']} Newton iterations"


def row(case, code, last, counts):
    ranks = "" if case.ranks == 1 else f" ({case.ranks} ranks)"
    last = last.replace("|", "\\|").replace("<", "&lt;")
    command = shown(case.command, case).replace("|", "\\|").replace("\n", " ")
    for name, words in case.shorter:
        command = command.replace(words, name)
    environment = "".join(f"{name}={value} " for name, value in case.environment.items())
    return f"| {case.what}{ranks} | `{environment}{' '.join(command.split())}` | {code} | {last} | {counts} |"


def main():
    # Under nohup every child would inherit that this signal is ignored.
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    chosen = sys.argv[1] if len(sys.argv) > 1 else ""
    cases = [case for case in CASES if (case.fast if chosen == "fast" else chosen in f"{case.what} {case.command}")]
    work = pathlib.Path(tempfile.mkdtemp(prefix="ssnp155-hard-use-", dir=os.environ.get("HARD_USE_DIR")))
    work.chmod(0o755)
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    failed = 0
    for number, case in enumerate(cases):
        folder = work / f"{number}" / "results"
        folder.parent.mkdir()
        folder.parent.chmod(0o777)
        began = time.monotonic()
        code, last, text, wrong = tried(case, folder)
        seconds = time.monotonic() - began
        failed += bool(wrong)
        print(f"{'WRONG' if wrong else 'good '} {seconds:5.1f} s  {case.what} ({case.ranks}): code {code}; {last}", flush=True)
        if wrong:
            print(f"      {'; '.join(wrong)}\n      {shown(case.command, case)}\n" + "\n".join(text.splitlines()[-12:]), flush=True)
        last = last.replace(str(folder.parent) + "/", "")
        last = re.sub(r"process \d+ on \S+ since [^;]* UTC", "process 4711 on node7 since 2026-01-31 12:00:00 UTC", last)
        kept[key(case)] = None if wrong else row(case, code, last, effort(folder) if case.counts else "")
        if chosen != "fast":
            KEPT.write_text(json.dumps(kept, indent=1))
        keep_fields(folder, work / "fields" / str(number))
        shutil.rmtree(folder.parent, ignore_errors=True)
    failed += open_fields(sorted((work / "fields").glob("*")))
    shutil.rmtree(work, ignore_errors=True)
    print(f"{len(cases) - failed} of {len(cases)} cases end as they have to")
    if chosen == "fast":
        sys.exit(1 if failed else 0)
    left = [case for case in CASES if not kept.get(key(case))]
    if not left:
        write_page(kept)
    elif not chosen:
        print(f"the page is not written: {len(left)} cases did not end well")
    sys.exit(1 if failed else 0)


def key(case):
    """What a row is kept under: all that the case is."""
    return repr(dataclasses.astuple(case))


def write_page(kept):
    rows = {}
    for case in CASES:
        rows.setdefault(case.group, []).append(kept[key(case)])
    text = ("# Hard use\n\n<!-- Written by scripts/hard_use.py; changes by hand are lost. -->\n\n"
            "What a shell, a cluster, or a person who knows PETSc does to a run, and how it ends. `scripts/hard_use.py` did each of these and\n"
            "found the exit code, the last sentence and the files in the folder as it expects them; a part of it runs with `cargo test`.\n"
            "Nothing ended by a signal or with a traceback. Where no case is named, `SMALL` is a sheet of 20 x 2 elements and a stroke of\n"
            "0.2 mm, which takes 4 steps and 14 Newton iterations by default; `LONG` takes long enough to be interrupted.\n")
    for group, lines in rows.items():
        text += f"\n## {group}\n\n| what | command | code | last sentence | counts |\n|---|---|---|---|---|\n" + "\n".join(lines) + "\n"
    PAGE.write_text(text)


if __name__ == "__main__":
    main()
