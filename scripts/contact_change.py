#!/usr/bin/env python3
"""What a stiffer or softer contact changes, and how a run lies beside a curve from elsewhere. Markdown on standard output.

  scripts/contact_change.py DEFAULT STIFFER SOFTER [DEFAULT STIFFER SOFTER ...]     folders of runs, in threes
  scripts/contact_change.py --curve CURVE.csv RUN                                  force of a run less that of the curve

Only the part where the punch goes down is compared; forces are those of the whole sheet.
"""

import csv
import json
import sys
from pathlib import Path

STROKES_MM = (1, 5, 10, 15, 18, 20, 22, 24)
RANGES_MM = [(0.5, 5), (5, 15), (15, 20), (20, 24), (24, 26), (26, 28.5)]


class Run:
    """The rows of a run while the punch goes down, and its counts."""

    def __init__(self, folder):
        self.name = folder.name
        with open(folder / "history.csv", newline="") as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        deepest = max(row["stroke_mm"] for row in rows)
        turn = next(i for i, row in enumerate(rows) if row["stroke_mm"] == deepest)
        self.loading = rows[: turn + 1]
        self.summary = json.loads((folder / "summary.json").read_text())
        self.finished = self.summary["status"] == "finished"

    def force(self, stroke):
        """The force where a step ended at this stroke."""
        found = [row["force_N"] for row in self.loading if abs(row["stroke_mm"] - stroke) < 1e-6]
        return found[0] if found else None

    def angle(self):
        return self.loading[-1]["angle_deg"] if self.finished else None

    def depth(self):
        return f"{1e3 * max(row['max_penetration_mm'] for row in self.loading):.2f}"


def row(cells):
    print("| " + " | ".join(cells) + " |")


def changes(folders):
    heads = [f"d = {stroke}" for stroke in STROKES_MM]
    heads = ["run", *heads, "angle loaded", "penetration µm", "steps", "refused", "iterations", "CPU s"]
    row(heads)
    print("|" + "---|" * len(heads))
    for first in range(0, len(folders), 3):
        default, *others = [Run(folder) for folder in folders[first : first + 3]]
        for run in (default, *others):
            cells = [run.name + ("" if run.finished else f" (stops at {run.loading[-1]['stroke_mm']:.2f} mm)")]
            for stroke in STROKES_MM:
                ours, base = run.force(stroke), default.force(stroke)
                if ours is None or base is None:
                    cells.append("–")
                else:
                    cells.append(f"{ours:.2f} N" if run is default else f"{100 * (ours / base - 1):+.2f} %")
            if run.angle() is None or default.angle() is None:
                cells.append("–")
            else:
                cells.append(f"{run.angle():.3f}°" if run is default else f"{run.angle() - default.angle():+.3f}°")
            counts = run.summary["counts"]
            cells += [run.depth(), str(counts["steps"]), str(counts["refused_solves"]), str(counts["newton_iterations"])]
            row([*cells, f"{run.summary['timing']['cpu_s']:.0f}"])


def beside(curve, folder):
    run = Run(folder)
    ours = [(line["stroke_mm"], line["force_N"]) for line in run.loading]
    with open(curve, newline="") as file:
        lines = csv.DictReader(line for line in file if not line.startswith("#"))
        table = [(float(line["punch_mm"]), float(line["force_punch_N"])) for line in lines]
    depths = [stroke for stroke, _ in table]
    theirs = table[: depths.index(max(depths)) + 1]

    def at(stroke):
        """Our force between two rows."""
        for (a, low), (b, high) in zip(ours, ours[1:]):
            if a <= stroke <= b:
                return low + (high - low) * (stroke - a) / (b - a)
        return None

    row(["d mm", "mean N", "rms N", "span ours N", "span of the curve N"])
    print("|---|---|---|---|---|")
    for low, high in RANGES_MM:
        pairs = [(at(stroke), force) for stroke, force in theirs if low <= stroke <= high]
        pairs = [(mine, force) for mine, force in pairs if mine is not None]
        differences = [mine - force for mine, force in pairs]
        mean = sum(differences) / len(differences)
        rms = (sum(value * value for value in differences) / len(differences)) ** 0.5
        within = [force for stroke, force in ours if low <= stroke <= high]
        spans = [f"{min(forces):.0f}…{max(forces):.0f}" for forces in (within, [force for _, force in pairs])]
        row([f"{low:g}…{high:g}", f"{mean:+.2f}", f"{rms:.2f}", *spans])


def main(arguments):
    match arguments:
        case ["--curve", curve, folder]:
            beside(Path(curve), Path(folder))
        case folders if folders and len(folders) % 3 == 0:
            changes([Path(folder) for folder in folders])
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
