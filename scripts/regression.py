#!/usr/bin/env python3
"""Measures inputs/reference/regression.csv: what this program itself finds for the four cases in inputs/.

  scripts/regression.py [--write]

Runs each case on one rank with the band solver (inputs/band.opts), whose values go to the file, on one rank with MUMPS,
and the first one on 2 ranks, which change nothing but rounding. The tolerance of a value is 1e-8 of it, and ten
times the spread of the runs, rounded up to 1, 2 or 5, where that is more: after d = 20 mm the sheet snaps through between
punch and die, and rounding decides on the steps. Where it does, three runs are few to know by how much: twice the spread
that other longest steps bring (-dt_max 8.5, 8 and 7.5 instead of 9) counts as well. Without --write the table is only shown, with the spread. The file is to be
written anew only where a change is meant to change results, and the commit says so. The program is
target/release/ssnp155, or $SSNP155. Results stay in results-regression/; with REUSE=1 a run that is there is not made again.
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
RESULTS = ROOT / "results-regression"
CASES = ["ssnp155", "ssnp155-friction", "ssnp155-springback", "ssnp155-friction-springback"]
BAND = ["-options_file", "inputs/band.opts"]
VARIANTS = {"band": (1, BAND), "mumps": (1, []), "2-ranks": (2, [])}
# Other steps, for the values whose steps rounding decides on.
STEPS = {f"dt_max-{dt}": (1, [*BAND, "-dt_max", dt]) for dt in ("8.5", "8", "7.5")}
STROKES_MM = [1, 5, 10, 15, 20, 24]
LEAST = 1e-8
SAFETY = 10.0
STEPS_SAFETY = 2.0
# Spread from which on rounding must have changed the steps.
AMPLIFIED = 1e-6
HEAD = """\
# What this program itself finds for the cases in inputs/: regression, not reference (those are in values.csv and
# values-friction.csv). "case" is the name of the option file; a run whose physics, mesh and steps are exactly the file's is
# compared, whatever its linear solver and number of ranks. Columns as there; a tolerance is a share of the value.
# Measured by `scripts/regression.py --write` on one rank with inputs/band.opts. The tolerance is 1e-8 or, where it is more,
# ten times the spread between that run, MUMPS and 2 ranks: from d = 20 mm on the sheet snaps through between punch and die,
# and rounding decides on the steps. Where it does, twice the spread with other longest steps counts as well.
case,id,quantity,unit,value,tolerance,when,source
"""


def run(case, variant):
    """History and summary of a run."""
    ranks, options = (VARIANTS | STEPS)[variant]
    folder = RESULTS / f"{case}-{variant}"
    if not (os.environ.get("REUSE") and (folder / "summary.json").exists()):
        print("run:", case, variant, file=sys.stderr, flush=True)
        start = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        command = [*start, PROGRAM, "-options_file", f"inputs/{case}.opts", *options, "-output_every", "0"]
        # A verdict that does not hold is what this is for.
        within = ["bash", "-c", 'source scripts/environment.sh && exec "$@"', "run"]
        subprocess.run([*within, *command, "-output_dir", str(folder)], cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
    summary = json.loads((folder / "summary.json").read_text())
    if summary["status"] != "finished":
        sys.exit(f"regression: {case} {variant} did not finish: {summary['reason']}")
    with open(folder / "history.csv", newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    return rows, summary


def quantities(rows, summary):
    """Values by (id, quantity, unit, when)."""
    options = summary["provenance"]["options"]
    time_load = float(options["time_load"])
    loading = [row for row in rows if row["t_ms"] <= time_load + 1e-9]
    withdrawn = float(options["unload_fraction"]) == 1.0
    full, end = loading[-1], rows[-1]
    force, dy, angle = "force of the punch", "DY at A, sheet side", "angle between the arms"
    found = {}
    for stroke in STROKES_MM:
        [row] = [row for row in loading if abs(row["stroke_mm"] - stroke) < 1e-9]
        found[f"force_d{stroke}", force, "N", f"d = {stroke}"] = row["force_N"]
    found["force_loaded", force, "N", "full stroke"] = full["force_N"]
    found["dy_a_sheet_loaded", dy, "mm", "full stroke"] = full["dy_A_sheet_mm"]
    found["angle_loaded", angle, "deg", "full stroke"] = full["angle_deg"]
    if withdrawn:
        found["angle_released", angle, "deg", "tools withdrawn"] = end["angle_deg"]
    else:
        found["dy_a_sheet_unloaded", dy, "mm", "end of unloading"] = end["dy_A_sheet_mm"]
        found["angle_unloaded", angle, "deg", "end of unloading"] = end["angle_deg"]
        found["force_unloaded", force, "N", "end of unloading"] = end["force_N"]
    return found


def tolerance(spread, by_steps):
    """From the spread that rounding and other steps bring: at least LEAST; 1, 2 or 5 times a power of ten."""
    wanted = max(LEAST, SAFETY * spread, STEPS_SAFETY * by_steps if spread > AMPLIFIED else 0.0)
    power = 10.0 ** math.floor(math.log10(wanted) + 1e-9)
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= wanted * (1 - 1e-9))


def line(case, variant, rows, summary):
    """A row of the table of docs/results.md."""
    time_load = float(summary["provenance"]["options"]["time_load"])
    loading = [row for row in rows if row["t_ms"] <= time_load + 1e-9]
    force = {round(row["stroke_mm"], 6): row["force_N"] for row in loading}
    largest = max((row for row in loading if row["stroke_mm"] <= 24.4), key=lambda row: row["force_N"])
    angles, counts = summary["angles_deg"], summary["counts"]
    vanish = next(value for name, value in angles.items() if name.startswith("tools vanish at 28.5"))
    cells = [f"`{case}.opts`", variant, *(f"{force[float(stroke)]:.2f}" for stroke in (1, 10, 20)),
             f"{largest['force_N']:.1f} at {largest['stroke_mm']:.1f}", f"{loading[-1]['force_N']:.1f}",
             f"{loading[-1]['dy_A_sheet_mm']:.3f}", f"{angles['full stroke']:.2f}", f"{angles['end of the motion']:.2f}",
             f"{vanish:.2f}", f"{counts['steps']} ({len(loading)})",
             f"{counts['refused_solves']} ({sum(row['refused_solves'] for row in loading):.0f})",
             f"{counts['newton_iterations']}"]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    write = arguments == ["--write"]
    if arguments and not write:
        sys.exit(__doc__)
    lines, table = [], []
    for case in CASES:
        # Several ranks take long on a busy machine, and the path of the first case is the most sensitive.
        variants = [variant for variant in VARIANTS if variant != "2-ranks" or case == CASES[0]]
        results = {variant: run(case, variant) for variant in variants}
        other_steps = [quantities(*run(case, variant)) for variant in STEPS]
        table += [line(case, variant, *result) for variant, result in results.items()]
        by_variant = {variant: quantities(*result) for variant, result in results.items()}
        source = f"ssnp155 {results['band'][1]['provenance']['version']}"
        for key, value in by_variant["band"].items():
            def largest_change(others):
                return max(abs(other[key] / value - 1.0) for other in others)

            spread, by_steps = largest_change(by_variant.values()), largest_change(other_steps)
            allowed = tolerance(spread, by_steps)
            name, quantity, unit, when = key
            print(f"  {name:22} {value:22.15g} spread {spread:.1e}, other steps {by_steps:.1e}, tolerance {allowed:g}")
            quantity = f'"{quantity}"' if "," in quantity else quantity
            lines.append(f"{case},{name},{quantity},{unit},{value:.12g},{100 * allowed:.10g} %,{when},{source}")
    print("\n" + "\n".join(table))
    if write:
        (ROOT / "inputs/reference/regression.csv").write_text(HEAD + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
