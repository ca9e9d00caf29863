#!/usr/bin/env python3
"""Derivatives of a run by -sensitivity against central differences of whole runs, with a study of the difference's step.

    scripts/sensitivity.py PARAMETER,... [--shares 1e-4,1e-5] [--until 20] [--folder FOLDER] [-- OPTIONS]

runs the case of OPTIONS once with -sensitivity and twice per parameter and share with the parameter above and below its
value, all with the same steps (choose them with -fixed_steps_load and -fixed_steps_unload), and prints a table: per
parameter and quantity the largest difference in a row as a share of the column's largest derivative, for the share that
agrees best, and the stroke where it is. Rows beyond --until (mm, going down) are listed apart. Where it is above 1e-5, a
second table has the derivative between the differences to the side below and to the side above: at a kink they differ, and the
derivative is one of them. Further lines are the derivatives of the released angles. A share whose runs have other steps,
because another solve was refused, is left out. The program is target/release/ssnp155, or $SSNP155.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

PROGRAM = os.environ.get("SSNP155", str(pathlib.Path(__file__).parent.parent / "target/release/ssnp155"))
WORTH_A_LOOK = 1e-5
QUANTITIES = ["force_N", "angle_deg", "dy_A_sheet_mm"]


def rows(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def run(folder, options):
    folder.mkdir(parents=True, exist_ok=True)
    words = [PROGRAM, *options, "-output_dir", str(folder), "-output_every", "0", "-overwrite"]
    ended = subprocess.run(words, capture_output=True, text=True)
    if ended.returncode not in (0, 1) or "FAILED" in ended.stdout:
        sys.exit(f"{' '.join(words)}\n{ended.stdout[-2000:]}{ended.stderr}")
    return rows(folder / "history.csv"), json.loads((folder / "summary.json").read_text())


def column(table, quantity, name):
    """The column of the derivative of a quantity by a parameter."""
    for unit in ("", "_mm", "_MPa", "_mm_per_MPa"):
        key = f"d_{quantity}_by_{name}{unit}"
        if key in table[0]:
            return [float(row[key]) for row in table]
    sys.exit(f"no derivatives of {quantity} by {name}")


def compare(name, share, value, exact, above, below, until):
    """Per quantity: largest difference up to `until` and beyond it, each with its stroke, and there the difference to the side
    below, the derivative, and the difference to the side above."""
    found = {}
    strokes = [float(row["stroke_mm"]) for row in exact]
    deepest = strokes.index(max(strokes))
    for quantity in QUANTITIES:
        slopes = column(exact, quantity, name)
        worst = [(0.0, 0.0, ()), (0.0, 0.0, ())]
        first = [i for i, stroke in enumerate(strokes) if i <= deepest and stroke <= until]
        for part in (0, 1):
            members = [i for i in range(len(slopes)) if (i in first) == (part == 0)]
            scale = max((abs(slopes[i]) for i in members), default=0.0)
            for i in members:
                low, middle, high = (float(table[i][quantity]) for table in (below, exact, above))
                difference = (high - low) / (2 * share * value)
                error = abs(difference - slopes[i]) / max(scale, 1e-300)
                if error > worst[part][0]:
                    sides = ((middle - low) / (share * value), slopes[i], (high - middle) / (share * value))
                    worst[part] = (error, strokes[i], sides)
        found[quantity] = worst
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parameters")
    parser.add_argument("--shares", default="1e-4,1e-5,1e-6")
    parser.add_argument("--until", type=float, default=20.0)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("results-sensitivity"))
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:end])
    given.options = words[end + 1:]
    names = given.parameters.split(",")
    _, summary = run(given.folder / "exact", [*given.options, "-sensitivity", given.parameters])
    exact = rows(given.folder / "exact/sensitivity.csv")
    values = {name: float(summary["provenance"]["options"][name]) for name in names}
    print("| parameter | quantity | up to", given.until, "mm | share | at | beyond | share | at |")
    print("|---|---|---|---|---|---|---|---|")
    angles, at_kinks = [], []
    for name in names:
        found = {}
        for share in map(float, given.shares.split(",")):
            sides = []
            for factor in (1 + share, 1 - share):
                table, end = run(given.folder / "beside", [*given.options, f"-{name}", repr(values[name] * factor)])
                sides.append((table, end))
            if any([row["t_ms"] for row in table] != [row["t_ms"] for row in exact] for table, _ in sides):
                print(f"# {name}, share {share:g}: other steps")
                continue
            found[share] = compare(name, share, values[name], exact, sides[0][0], sides[1][0], given.until)
            for angle, slopes in summary["sensitivity"]["angles"].items():
                pair = [end["angles_deg"][angle] for _, end in sides]
                difference = (pair[0] - pair[1]) / (2 * share * values[name])
                angles.append((name, angle, slopes[name], share, difference))
        for quantity in QUANTITIES if found else []:
            parts = []
            for part in (0, 1):
                share = min(found, key=lambda share: found[share][quantity][part][0])
                error, stroke, sides = found[share][quantity][part]
                if error > WORTH_A_LOOK:
                    at_kinks.append((name, quantity, stroke, share, *sides))
                parts.append(f"{error:.1e} | {share:g} | {stroke:.2f}")
            print(f"| `{name}` | {quantity} | {' | '.join(parts)} |")
    print()
    print("| parameter | quantity | at | share | difference below | derivative | difference above |")
    print("|---|---|---|---|---|---|---|")
    for name, quantity, stroke, share, below, slope, above in at_kinks:
        print(f"| `{name}` | {quantity} | {stroke:.2f} | {share:g} | {below:.7g} | {slope:.7g} | {above:.7g} |")
    print()
    print("| parameter | angle | derivative | share | difference of runs |")
    print("|---|---|---|---|---|")
    for name, angle, slope, share, difference in angles:
        shown = "none" if slope is None else f"{slope:.6g}"
        print(f"| `{name}` | {angle} | {shown} | {share:g} | {difference:.6g} |")


main()
