#!/usr/bin/env python3
"""What a run says about its contact: work, noise of the force, penetration, angles. One line of Markdown per folder.

    scripts/contact_noise.py [--header] RESULTS ...

The noise is the root mean square of the force less its smooth trend, a cubic fitted to all rows within 0.75 mm of stroke on
either side, as a share of the mean force; loading only. It needs rows at least every 0.2 mm: see scripts/contact_table.sh.
"""

import csv
import json
import sys
from pathlib import Path

HALF_WINDOW_MM = 0.75
RANGES_MM = [(15.0, 20.0), (20.0, 24.0)]
LEAST_ROWS = 9
COLUMNS = [
    "run", "steps", "iterations", "refused", "CPU s", "noise 15–20 %", "noise 20–24 %", "penetration µm", "F(10) N", "F(15) N",
    "F(20) N", "F(24) N", "angle loaded °", "angle back °",
]


def solve(matrix, right):
    """Solves a small linear system by elimination with pivoting."""
    n = len(right)
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


def trend(points, centre):
    """Value at `centre` of the cubic that fits the points nearby, or None if there are too few."""
    near = [(x - centre, y) for x, y in points if abs(x - centre) <= HALF_WINDOW_MM]
    if len(near) < LEAST_ROWS:
        return None
    moment = [sum(x**k for x, _ in near) for k in range(7)]
    matrix = [[moment[i + j] for j in range(4)] for i in range(4)]
    right = [sum(y * x**i for x, y in near) for i in range(4)]
    return solve(matrix, right)[0]


def noise(points, low, high):
    """Noise of the force between two strokes as a percentage of its mean."""
    inside = [(x, y) for x, y in points if low <= x <= high]
    smooth = [(y, trend(points, x)) for x, y in inside]
    if not inside or any(fit is None for _, fit in smooth):
        return None
    mean_square = sum((y - fit) ** 2 for y, fit in smooth) / len(smooth)
    return 100 * mean_square**0.5 / (sum(y for y, _ in smooth) / len(smooth))


def line(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    deepest = max(row["stroke_mm"] for row in rows)
    turn = next(i for i, row in enumerate(rows) if row["stroke_mm"] == deepest)
    loading = rows[: turn + 1]
    points = [(row["stroke_mm"], row["force_N"]) for row in loading]
    cpu, complete = "–", ""
    refused = sum(row["refused_solves"] for row in rows)
    iterations = sum(row["newton_iterations"] for row in rows)
    if (folder / "summary.json").exists():
        summary = json.loads((folder / "summary.json").read_text())
        cpu = f"{summary['timing']['cpu_s']:.0f}"
        counts = summary["counts"]
        refused, iterations = counts["refused_solves"], counts["newton_iterations"]
        if summary["status"] != "finished":
            complete = f" (ended at {rows[-1]['stroke_mm']:.2f} mm)"

    def force(stroke):
        row = min(loading, key=lambda row: abs(row["stroke_mm"] - stroke))
        return f"{row['force_N']:.2f}" if abs(row["stroke_mm"] - stroke) < 1e-6 else "–"

    cells = [folder.name + complete, f"{len(rows)}", f"{iterations:.0f}", f"{refused:.0f}", cpu]
    for low, high in RANGES_MM:
        value = noise(points, low, high)
        cells.append("–" if value is None else f"{value:.3f}")
    cells.append(f"{1e3 * max(row['max_penetration_mm'] for row in rows):.2f}")
    cells += [force(stroke) for stroke in (10, 15, 20, 24)]
    cells += [f"{loading[-1]['angle_deg']:.3f}", f"{rows[-1]['angle_deg']:.3f}" if len(rows) > len(loading) else "–"]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    if "--header" in arguments:
        print("| " + " | ".join(COLUMNS) + " |")
        print("|" + "---|" * len(COLUMNS))
    for name in arguments:
        if name != "--header":
            print(line(Path(name)))


if __name__ == "__main__":
    main(sys.argv[1:])
