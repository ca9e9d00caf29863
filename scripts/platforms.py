#!/usr/bin/env python3
"""The table of docs/platforms.md from what scripts/platforms.sh has left.

  scripts/platforms.py RESULTS NAME ...

Exit code 0 if on every platform all tests passed, all verdicts hold, and force and angle agree with the first one: the
forces up to 20 mm within 1e-8. Beyond, rounding decides which solve is refused, and the path with it: shown only.
"""
import csv
import json
import pathlib
import re
import sys

LIMIT = 1e-8
STROKES = (5.0, 10.0, 15.0, 20.0)


def force_at(folder, stroke):
    """Force (N) at a stroke (mm) on the way down."""
    with open(folder / "history.csv") as file:
        for row in csv.DictReader(file):
            if abs(float(row["stroke_mm"]) - stroke) < 1e-9:
                return float(row["force_N"])
    raise SystemExit(f"platforms: {folder} has no row at {stroke} mm")


def tests(path):
    """Passed and failed tests, and what they say about PETSc."""
    text = path.read_text()
    # The ranks' lines may run into one another; only rank 0 speaks of tests.
    passed = len(re.findall(r"\.\.\. ok", text))
    # A panic may be what a test is about; one that fails a test ends in an error of cargo's.
    failed = len(re.findall(r"\.\.\. FAILED|^error", text, re.M))
    petsc = re.search(r"PETSc (\S+), MUMPS: (\w+)", text)
    return passed, failed, petsc and petsc.groups()


def column(results, name):
    """Values of one platform by row, and its complaints."""
    folder = results / name
    versions = (folder / "versions.txt").read_text()
    find = lambda pattern: (re.search(pattern, versions) or [None, "none"])[1]
    complaints, rows = [], {}
    passed, failed, petsc = tests(folder / "tests-1.log")
    version, mumps = petsc or ("?", "?")
    rows["PETSc"] = version
    rows["MUMPS"] = find(r"MUMPS ([\d.]+)") if mumps == "true" else "none"
    hydra = re.search(r"Version: +(\S+)", versions)
    rows["MPI"] = f"MPICH {hydra[1]}" if hydra else "Open MPI " + find(r"Open MPI\) (\S+)")
    rows["HDF5"] = find(r"HDF5 ([\d.]+\d)")
    rows["rustc"] = find(r"rustc (\S+)")
    for ranks in (1, 2):
        passed, failed, _ = tests(folder / f"tests-{ranks}.log")
        rows[f"tests of the wrapper, {ranks} rank{'s' * (ranks > 1)}"] = f"{passed} of {passed + failed}"
        if failed or not passed:
            complaints.append(f"{name}: tests on {ranks} ranks")
    values = {}
    for ranks in (1, 2):
        run = folder / f"ranks-{ranks}"
        summary = json.loads((run / "summary.json").read_text())
        verdicts = [verdict["verdict"] == "holds" for verdict in summary["verdicts"]]
        on = f", {ranks} rank{'s' * (ranks > 1)}"
        rows["verdicts that hold" + on] = f"{sum(verdicts)} of {len(verdicts)}"
        if not all(verdicts):
            complaints.append(f"{name}: verdicts on {ranks} ranks")
        for stroke in STROKES:
            values[ranks, stroke] = force_at(run, stroke)
            if ranks == 1:
                rows[f"force at {stroke:g} mm, N"] = f"{values[ranks, stroke]:.9f}"
        if ranks == 1:
            rows["angle at full stroke, degrees"] = f"{summary['angles_deg']['full stroke']:.6f}"
        counts = summary["counts"]
        rows["steps, Newton iterations" + on] = f"{counts['steps']}, {counts['newton_iterations']}"
        seconds = re.search(r"time +([\d.]+) s of processors", (folder / f"run-{ranks}.log").read_text())
        rows["processor time, s" + on] = seconds[1] if seconds else "?"
    return rows, values, complaints


def main(results, names):
    columns, complaints, first = {}, [], None
    for name in names:
        rows, values, mistakes = column(results, name)
        complaints += mistakes
        first = first or values
        largest = max(abs(values[ranks, stroke] / first[1, stroke] - 1) for ranks, stroke in values)
        rows["largest difference of a force, relative"] = f"{largest:.0e}"
        if largest > LIMIT:
            complaints.append(f"{name}: a force differs by {largest:.1e}")
        columns[name] = rows
    print("| |", " | ".join(names), "|")
    print("|---|" + "---|" * len(names))
    for row in columns[names[0]]:
        print(f"| {row} |", " | ".join(columns[name][row] for name in names), "|")
    for complaint in complaints:
        print("platforms:", complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2:]))
