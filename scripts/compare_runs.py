#!/usr/bin/env python3
"""Compares two runs of the benchmark that should be the same: status, verdicts, and the well-posed numbers.

  scripts/compare_runs.py FOLDER FOLDER

Well-posed is what rounding cannot change: the force at the strokes up to 20 mm, where the path is unique, and the
imposed displacements. Beyond, the sheet slides through between punch and die, where a platform whose rounding refuses another
solve would take other steps; there each run must hold its verdicts, and the differences are only shown. Exit code 0 if the
runs agree within 1e-10 (relative).
"""
import csv
import json
import pathlib
import sys

LIMIT = 1e-10
UNIQUE_TO = 20.0  # mm
# Verdicts whose computed value is compared, by the beginning of their names; the forces come from the history.
IMPOSED = "DY at A, punch side"


def forces(folder, time_load):
    """Force (N) by stroke (mm) at the rows of whole millimetres on the way down."""
    with open(folder / "history.csv") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    down = [row for row in rows if row["t_ms"] <= time_load]
    by_stroke = {round(row["stroke_mm"], 6): row["force_N"] for row in down}
    return {stroke: force for stroke, force in by_stroke.items() if stroke == int(stroke)}


def main(first, second):
    summaries = [json.loads((folder / "summary.json").read_text()) for folder in (first, second)]
    mistakes = []
    print("status:", *(summary["status"] for summary in summaries))
    if summaries[0]["status"] != summaries[1]["status"]:
        mistakes.append("status")

    def compare(name, one, other, binding):
        difference = abs(one - other) / max(abs(one), abs(other), 1e-300)
        print(f"{name:66} {one:16.9g} {other:16.9g} {difference:9.1e} {'' if binding else '(only shown)'}")
        if binding and not difference <= LIMIT:
            mistakes.append(name)

    verdicts = [{f"{row['quantity']} ({row['comparison']}: {row['source']})": row for row in summary["verdicts"]} for summary in summaries]
    if verdicts[0].keys() != verdicts[1].keys() or not verdicts[0]:
        mistakes.append("the list of verdicts")
    for name in verdicts[0].keys() & verdicts[1].keys():
        one, other = verdicts[0][name], verdicts[1][name]
        if one["verdict"] != other["verdict"]:
            mistakes.append(f"the verdict on {name}")
    for name in [name for name in verdicts[0] if name in verdicts[1]]:
        compare(name, verdicts[0][name]["computed"], verdicts[1][name]["computed"], name.startswith(IMPOSED))

    time_load = [float(summary["provenance"]["options"]["time_load"]) for summary in summaries]
    by_stroke = [forces(folder, time) for folder, time in zip((first, second), time_load)]
    common = sorted(by_stroke[0].keys() & by_stroke[1].keys())
    if len([stroke for stroke in common if 0.0 < stroke <= UNIQUE_TO]) < 3:
        mistakes.append("fewer than three common strokes up to 20 mm")
    for stroke in common:
        compare(f"force at d = {stroke:g} mm", by_stroke[0][stroke], by_stroke[1][stroke], stroke <= UNIQUE_TO)

    if mistakes:
        sys.exit("the runs DIFFER: " + "; ".join(mistakes))
    print("the runs agree")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*map(pathlib.Path, sys.argv[1:]))
