#!/usr/bin/env python3
"""Makes the tables of docs/identification.md: identification from curves whose answer is known, and designs.

  scripts/identification.py curve FILE NOISE SEED [OPTION ...]   a curve of this program with noise, as a measured file
  scripts/identification.py twin SEEDS NAME,NAME [OPTION ...]    hidden values, found again from each seed
  scripts/identification.py code_aster FILE                      the curve of code_aster as a measured file

Needs scripts/requirements.txt. The program is target/release/ssnp155, or $SSNP155. Results stay in results-identification/.
"""
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys

import numpy
import scipy.stats

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
RESULTS = ROOT / "results-identification"
STROKES = [0.2 * i for i in range(1, 101)]  # mm, every 0.2 mm down to 20
TRUE = {"friction_coefficient": 0.1342, "hollomon_k": 550.4, "hollomon_n": 0.223}
BOUNDS = {"friction_coefficient": (0, 0.5), "hollomon_k": (200, 1000), "hollomon_n": (0.05, 0.5)}
# Every start is 30 % off, none on the same side as all others.
START = {"friction_coefficient": 0.7, "hollomon_k": 1.3, "hollomon_n": 0.7}
TWIN = ["-hardening", "hollomon", "-sheet_nx", "60", "-sheet_ny", "2"]


def run(folder, options):
    """Exit code and screen of the program."""
    command = [PROGRAM, *options, "-output_dir", str(folder)]
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return ended.returncode, ended.stdout


def words(values):
    return [word for name, value in values.items() for word in (f"-{name}", f"{value:.10g}")]


def exact_forces(options):
    """Forces of this program at STROKES."""
    folder = RESULTS / "curve"
    strokes = ",".join(f"{stroke:.6g}" for stroke in STROKES)
    last = STROKES[-1]
    code, text = run(folder, [*options, "-report_strokes", strokes, "-stroke", f"{last}", "-unload_fraction", "0",
                              "-time_load", f"{900 * last / 28.5!r}", "-output_every", "0"])
    if code not in (0, 1):
        sys.exit(text)
    with open(folder / "history.csv") as rows:
        force = {round(float(row["stroke_mm"]), 6): float(row["force_N"]) for row in csv.DictReader(rows)}
    return [force[round(stroke, 6)] for stroke in STROKES]


def write(file, forces, noise, seed):
    """A measured file of these forces with normal noise, `noise` being a share of each force."""
    chance = random.Random(seed)
    with open(file, "w") as table:
        table.write("stroke_mm,force_N,uncertainty_N\n")
        for stroke, exact in zip(STROKES, forces):
            table.write(f"{stroke:.6g},{exact * (1 + noise * chance.gauss(0, 1)):.6f},{noise * exact:.6f}\n")


def identify(folder, file, parameters, start, options):
    """The exit code and identification.json."""
    sought = ",".join(f"{name}:{low}:{high}" for name, (low, high) in parameters.items())
    code, text = run(folder, [*options, *words(start), "-identify", str(file), "-parameters", sought])
    if code not in (0, 1):  # the file is that of an earlier search then, if there is one
        sys.exit(text)
    return code, json.loads((folder / "identification.json").read_text())


def joint_distance(found, exact, names):
    """The squared distance of an estimate from the hidden values, in the covariance at these; of K by its logarithm, as the
    program scales it."""
    def scale(name):
        return TRUE[name] if name == "hollomon_k" else 1.0

    def away(name, value):
        return math.log(value / TRUE[name]) if name == "hollomon_k" else value - TRUE[name]

    off = [away(one["name"], one["estimate"]) for one in found["parameters"]]
    covariance = [[value / scale(one) / scale(other) for value, other in zip(row, names)]
                  for row, one in zip(exact["covariance"], names)]
    return float(numpy.dot(off, numpy.linalg.solve(covariance, off)))


def twin(seeds, names, options):
    """The bounds of Cramer and Rao are the standard errors at the hidden values, from one run there."""
    options = [*TWIN, *options]
    parameters = {name: BOUNDS[name] for name in names}
    start = {name: value * START[name] if name in names else value for name, value in TRUE.items()}
    heads = " | ".join(f"{name} (off, in bounds of Cramer and Rao)" for name in names)
    forces = exact_forces([*options, *words(TRUE)])
    write(RESULTS / "truth.csv", forces, 0.01, 0)
    _, exact = identify(RESULTS / "truth", RESULTS / "truth.csv", parameters, TRUE, [*options, "-most_runs", "1"])
    print(f"| seed | runs | misfit² | way left | {heads} | joint² | code |")
    print("|---" * (len(names) + 6) + "|")
    total = 0.0
    for seed in range(1, seeds + 1):
        file = RESULTS / f"twin-{seed}.csv"
        write(file, forces, 0.01, seed)
        code, found = identify(RESULTS / f"twin-{seed}", file, parameters, start, options)
        cells = []
        for one, best in zip(found["parameters"], exact["parameters"]):
            off = (one["estimate"] - TRUE[one["name"]]) / best["standard_error"]
            cells.append(f"{one['estimate']:.5g} ± {one['standard_error']:.2g} ({off:+.2f})")
        misfit = found["chi_squared"] / found["degrees_of_freedom"]
        joint = joint_distance(found, exact, names)
        total += joint
        print(f"| {seed} | {found['runs']} | {misfit:.2f} | {found['distance']:.2f} | " + " | ".join(cells)
              + f" | {joint:.2f} | {code} |", flush=True)
    freedom = seeds * len(names)
    print(f"sum of joint²: {total:.1f} for {freedom} degrees of freedom, exceeded by chance in"
          f" {100 * scipy.stats.chi2.sf(total, freedom):.0f} of 100 cases")


def code_aster(file):
    """The way down to 20 mm; the uncertainties are those of inputs/reference/values.csv, between them linear."""
    with open(ROOT / "inputs/reference/code_aster-15.2-frictionless.csv") as rows:
        table = [row for row in csv.DictReader(line for line in rows if not line.startswith("#"))]
    known = [(0, 1), (1, 1), (10, 2), (20, 3)]

    def uncertainty(stroke):
        for (left, low), (right, high) in zip(known, known[1:]):
            if stroke <= right:
                return low + (high - low) * (stroke - left) / (right - left)
        return known[-1][1]

    with open(file, "w") as out:
        out.write("stroke_mm,force_N,uncertainty_N\n")
        for row in table:
            stroke = float(row["punch_mm"])
            if float(row["t_ms"]) <= 900 and 0.5 <= stroke <= 20:
                out.write(f"{stroke:g},{row['force_punch_N']},{uncertainty(stroke):.3f}\n")


if __name__ == "__main__":
    RESULTS.mkdir(exist_ok=True)
    match sys.argv[1:]:
        case ["curve", file, noise, seed, *options]:
            write(file, exact_forces(options), float(noise), int(seed))
        case ["twin", seeds, names, *options]:
            twin(int(seeds), names.split(","), options)
        case ["code_aster", file]:
            code_aster(file)
        case _:
            sys.exit(__doc__)
