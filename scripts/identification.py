#!/usr/bin/env python3
"""Makes the tables of docs/identification.md: identification from curves whose answer is known, and designs.

  scripts/identification.py curve FILE NOISE SEED [OPTION ...]   a curve of this program with noise, as a measured file
  scripts/identification.py twin SEEDS NAME,NAME [OPTION ...]    hidden values, found again from each seed
  scripts/identification.py theory SEEDS NAME,NAME [OPTION ...]  what the linear model says of the same noise, without a search
  scripts/identification.py valley NAME,NAME [OPTION ...]        the exact curve along the direction it determines least
  scripts/identification.py beside SEEDS NAME,NAME [OPTION ...]  how far twins have ended from the least sum of squares
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
    code, text = run(folder, [*options, *words(start), "-identify", str(file), "-parameters", sought, "-overwrite"])
    if code not in (0, 1):  # the file is that of an earlier search then, if there is one
        sys.exit(text)
    return code, json.loads((folder / "identification.json").read_text())


def logarithmic(name):
    """Whether the program scales a parameter by its logarithm."""
    return BOUNDS[name][0] > 0 and name != "hollomon_n"


def stretch(name, value, by_logarithm=logarithmic):
    """The derivative of a value by its place between its bounds, as in src/inverse/search.rs."""
    low, high = BOUNDS[name]
    return value * math.log(high / low) if by_logarithm(name) else high - low


def moved(name, value, way, by_logarithm=logarithmic):
    """The value at some way from another one, in the unit interval of its bounds."""
    low, high = BOUNDS[name]
    return value * (high / low) ** way if by_logarithm(name) else value + way * (high - low)


def joint_distance(found, exact, names):
    """The squared distance of an estimate from the hidden values, in the covariance at these, in the program's scales."""
    off = [math.log(one["estimate"] / TRUE[name]) * TRUE[name] if logarithmic(name) else one["estimate"] - TRUE[name]
           for one, name in zip(found["parameters"], names)]
    return float(numpy.dot(off, numpy.linalg.solve(exact["covariance"], off)))


def residuals(folder, measured, names):
    """Residuals divided by their uncertainties at the measured strokes, and their derivatives by the parameters."""
    with open(folder / "sensitivity.csv") as rows:
        table = {round(float(row["stroke_mm"]), 6): row for row in csv.DictReader(rows)}
    rows = [table[round(stroke, 6)] for stroke, _, _ in measured]
    residual = [(float(row["force_N"]) - force) / error for row, (_, force, error) in zip(rows, measured)]
    columns = [next(key for key in rows[0] if key in (f"d_force_N_by_{name}", f"d_force_N_by_{name}_MPa")) for name in names]
    slopes = [[float(row[key]) / error for key in columns] for row, (_, _, error) in zip(rows, measured)]
    return numpy.array(residual), numpy.array(slopes)


def read_measured(file):
    with open(file) as rows:
        return [[float(value) for value in row.values()] for row in csv.DictReader(rows)]


def prepare(names, options):
    """Parameters with bounds, start, options, exact forces, and the identification at the hidden values: one run."""
    options = [*TWIN, *options]
    parameters = {name: BOUNDS[name] for name in names}
    start = {name: value * START[name] if name in names else value for name, value in TRUE.items()}
    forces = exact_forces([*options, *words(TRUE)])
    write(RESULTS / "truth.csv", forces, 0.01, 0)
    _, exact = identify(RESULTS / "truth", RESULTS / "truth.csv", parameters, TRUE, [*options, "-most_runs", "1"])
    return parameters, start, options, forces, exact


def report_joint(what, total, freedom):
    print(f"sum of joint² {what}: {total:.1f} for {freedom} degrees of freedom, exceeded by chance in"
          f" {100 * scipy.stats.chi2.sf(total, freedom):.0f} of 100 cases")


def twin(seeds, names, options):
    """The bounds of Cramer and Rao are the standard errors at the hidden values. Recovered: converged in at most 15 runs, and each
    value within three of these. Joint distances: by the covariance there, and
    by how much smaller the sum of squares is than at the hidden values, which no curvature of the model spoils."""
    parameters, start, options, forces, exact = prepare(names, options)
    heads = " | ".join(f"{name} (off, in bounds of Cramer and Rao)" for name in names)
    print(f"| seed | runs | misfit² | way left | {heads} | joint², linear | joint², likelihood | recovered | code |")
    print("|---" * (len(names) + 8) + "|")
    totals = [0.0, 0.0]
    for seed in range(1, seeds + 1):
        file = RESULTS / f"twin-{seed}.csv"
        write(file, forces, 0.01, seed)
        at_truth = sum(((exact_force - force) / error) ** 2
                       for exact_force, (_, force, error) in zip(forces, read_measured(file)))
        code, found = identify(RESULTS / f"twin-{seed}", file, parameters, start, options)
        cells, recovered = [], found["converged"] and found["runs"] <= 15
        for one, best in zip(found["parameters"], exact["parameters"]):
            off = (one["estimate"] - TRUE[one["name"]]) / best["standard_error"]
            recovered = recovered and abs(off) <= 3
            cells.append(f"{one['estimate']:.5g} ± {one['standard_error']:.2g} ({off:+.2f})")
        misfit = found["chi_squared"] / found["degrees_of_freedom"]
        joint = [joint_distance(found, exact, names), at_truth - found["chi_squared"]]
        totals = [total + one for total, one in zip(totals, joint)]
        print(f"| {seed} | {found['runs']} | {misfit:.2f} | {found['distance']:.2f} | " + " | ".join(cells)
              + f" | {joint[0]:.2f} | {joint[1]:.2f} | {'yes' if recovered else 'no'} | {code} |", flush=True)
    for what, total in zip(("by the covariance", "by the likelihood"), totals):
        report_joint(what, total, seeds * len(names))


def theory(seeds, names, options):
    """What the noise of each seed does to the estimate by the derivatives at the hidden values alone."""
    _, _, _, forces, _ = prepare(names, options)
    _, slopes = residuals(RESULTS / "truth/run-001", read_measured(RESULTS / "truth.csv"), names)
    left, _, _ = numpy.linalg.svd(slopes, full_matrices=False)
    total = 0.0
    for seed in range(1, seeds + 1):
        write(RESULTS / "noise.csv", forces, 0.01, seed)
        noise = [(force - exact) / error for exact, (_, force, error) in zip(forces, read_measured(RESULTS / "noise.csv"))]
        joint = float(numpy.sum((left.T @ noise) ** 2))
        total += joint
        print(f"seed {seed}: joint² {joint:.2f}")
    report_joint("of the linear model", total, seeds * len(names))


def scales(names, values, by_logarithm=logarithmic):
    return numpy.array([stretch(name, values[name], by_logarithm) for name in names])


def run_at(values, names, measured, options):
    """Residuals and derivatives of a run with these values."""
    strokes = ",".join(f"{stroke:.6g}" for stroke, _, _ in measured)
    last = measured[-1][0]
    code, text = run(RESULTS / "beside", [*options, *words(values), "-report_strokes", strokes, "-stroke", f"{last}",
                                          "-unload_fraction", "0", "-time_load", f"{900 * last / 28.5!r}", "-output_every",
                                          "0", "-sensitivity", ",".join(names), "-overwrite"])
    if code not in (0, 1):
        sys.exit(text)
    return residuals(RESULTS / "beside", measured, names)


def along(values, names, direction, way, by_logarithm):
    """The values at some way along a direction in the unit box."""
    beside = dict(values)
    for name, part in zip(names, direction):
        beside[name] = moved(name, values[name], way * part, by_logarithm)
    return beside


def valley(names, options):
    """The sum of squares of the exact curve where the linear model has the square of the way, with each scale; and what noise
    adds to half its slope by the way, which in the linear model is the same everywhere."""
    _, _, options, forces, _ = prepare(names, options)
    measured = [[stroke, force, 0.01 * force] for stroke, force in zip(STROKES, forces)]
    _, at_truth = residuals(RESULTS / "truth/run-001", measured, names)
    noises = {}
    for seed in range(1, 6):
        chance = random.Random(seed)
        noises[seed] = [chance.gauss(0, 1) for _ in STROKES]
    slopes_by_noise = {seed: [] for seed in noises}
    ways = [-0.6, -0.4, -0.2, -0.1, 0, 0.1, 0.2, 0.4, 0.6]
    print("| way, standard errors | " + " | ".join(f"{way:g}" for way in ways) + " |")
    print("|---" * (len(ways) + 1) + "|")
    for what, by_logarithm in (("as the program scales", logarithmic), ("all by logarithms", lambda name: BOUNDS[name][0] > 0)):
        _, values, right = numpy.linalg.svd(at_truth * scales(names, TRUE, by_logarithm))
        direction = right[-1] / values[-1] * numpy.sign(right[-1][-1])
        sums = []
        for way in ways:
            there = along(TRUE, names, direction, way, by_logarithm)
            residual, slopes = run_at(there, names, measured, options)
            sums.append(f"{residual @ residual:.2g}")
            if by_logarithm is logarithmic:
                for seed, noise in noises.items():
                    slopes_by_noise[seed].append(f"{-numpy.dot(noise, slopes * scales(names, there) @ direction):.2f}")
        print(f"| sum of squares, {what} | " + " | ".join(sums) + " |", flush=True)
    for seed, row in slopes_by_noise.items():
        print(f"| slope by the noise of seed {seed} | " + " | ".join(row) + " |")


def beside(seeds, names, options):
    """Runs along the least determined direction around the ends of `twin`; in the other directions the sum of squares is
    taken to its least by the linear model."""
    options = [*TWIN, *options]
    ways = [0.03 * i for i in range(-10, 11)]
    print("| seed | way left, as the search says | way to the least sum beside | sum of squares less there |")
    print("|---|---|---|---|")
    for seed in range(1, seeds + 1):
        found = json.loads((RESULTS / f"twin-{seed}" / "identification.json").read_text())
        measured = read_measured(RESULTS / f"twin-{seed}.csv")
        here = {**TRUE, **{one["name"]: one["estimate"] for one in found["parameters"]}}
        # The directions the bounds leave open.
        free = [one["name"] for one in found["parameters"] if not one["at_bound"]]
        _, slopes = run_at(here, names, measured, options)
        open_columns = [names.index(name) for name in free]
        _, values, right = numpy.linalg.svd(slopes[:, open_columns] * scales(free, here))
        sums = []
        for way in ways:
            values_there = along(here, free, right[-1] / values[-1], way, logarithmic)
            residual, slopes = run_at(values_there, names, measured, options)
            left, _, _ = numpy.linalg.svd(slopes[:, open_columns] * scales(free, values_there), full_matrices=False)
            sums.append(residual @ residual - float(numpy.sum((left[:, :-1].T @ residual) ** 2)))
        least = int(numpy.argmin(sums))
        print(f"| {seed} | {found['distance']:.2f} | {abs(ways[least]):.2f} | {found['chi_squared'] - sums[least]:.3f} |",
              flush=True)


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
        case ["theory", seeds, names, *options]:
            theory(int(seeds), names.split(","), options)
        case ["valley", names, *options]:
            valley(names.split(","), options)
        case ["beside", seeds, names, *options]:
            beside(int(seeds), names.split(","), options)
        case ["code_aster", file]:
            code_aster(file)
        case _:
            sys.exit(__doc__)
