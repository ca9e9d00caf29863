#!/usr/bin/env python3
"""Checks the samples of scripts/study.py and what it makes of them, against closed values.

    scripts/check_studies.py FOLDER      (needs: pip install --requirement scripts/requirements.txt)

Plans fill their strata and repeat with their seed; shares of the variance, quantiles and control are those of functions for
which they are known, over many samples with fixed seeds; and a small sample of the program goes through, with its figure, to
FOLDER. Exit code 0 if all is well.
"""
import pathlib
import shutil
import subprocess
import sys

import numpy

from studies import analysis, plan

SCRIPTS = pathlib.Path(__file__).resolve().parent
TINY = ["-options_file", "inputs/band.opts", "-sheet_nx", "20", "-sheet_ny", "2", "-stroke", "0.2", "-time_load", "6.4",
        "-time_unload", "1"]
PROBLEMS = []


def expect(holds, what):
    if not holds:
        PROBLEMS.append(what)


def drawn(kind, runs, seed, parameters):
    points = plan.probabilities(kind, runs, seed, len(parameters))
    return numpy.array([[one.value(p) for one, p in zip(parameters, row)] for row in points])


def plans():
    for kind in ("lhs", "sobol"):
        points = numpy.array(plan.probabilities(kind, 64, 3, 5))
        strata = numpy.sort(numpy.floor(64 * points), axis=0)
        expect((strata == numpy.arange(64)[:, None]).all(), f"{kind}: not one point in each of 64 strata")
    for kind in ("lhs", "sobol", "random"):
        made = [plan.sample(kind, 16, seed, ["a=normal:1:0.1", "b=2:4"], []) for seed in (1, 1, 2)]
        expect(made[0].runs == made[1].runs != made[2].runs, f"{kind}: the seed does not make the plan")
    values = drawn("lhs", 1024, 1, [plan.parameter("a=normal:3:0.1"), plan.parameter("b=2:4")])
    expect(abs(values.mean(axis=0) - 3).max() < 1e-3, f"means {values.mean(axis=0)}")
    expect(abs(values.std(axis=0) / [0.1, 2 / 12**0.5] - 1).max() < 1e-2, f"deviations {values.std(axis=0)}")


def polynomial():
    """Of second degree, so the regression has to find its shares to rounding, from any points."""
    parameters = [plan.parameter("a=1:3"), plan.parameter("b=normal:5:0.5"), plan.parameter("c=0:1")]
    points = drawn("random", 40, 1, parameters)
    a, b = points[:, 0] - 2, (points[:, 1] - 5) / 0.5
    values = 7 + 2 * a + a**2 + b + 3 * a * b
    # var a = 1/3, var a^2 = 4/45, var b = 1, var ab = 1/3; all of them are uncorrelated.
    variances = numpy.array([4 / 3 + 4 / 45, 1, 0, 3, 0])
    shares = analysis.Regression(parameters, points, values).shares()
    expect(abs(shares - variances / variances.sum()).max() < 1e-10, f"shares of a polynomial: {shares}")


def ishigami():
    """Ishigami and Homma (1990), a = 7, b = 0.1: far from any polynomial of second degree, so for the bins only."""
    parameters = [plan.parameter(f"x{k}={-numpy.pi}:{numpy.pi}") for k in range(3)]
    first, second = 0.5 * (1 + 0.1 * numpy.pi**4 / 5)**2, 49 / 8
    exact = numpy.array([first, second, 0]) / (first + second + 0.01 * numpy.pi**8 * (1 / 18 - 1 / 50))
    found = []
    # Many runs, so that bins are narrow: wide ones lose what a quantity does within a bin.
    for seed in range(50):
        x = drawn("random", 4000, seed, parameters)
        found.append(analysis.bins(x, numpy.sin(x[:, 0]) + 7 * numpy.sin(x[:, 1])**2 + 0.1 * x[:, 2]**4 * numpy.sin(x[:, 0])))
    error = numpy.std(found, axis=0) / len(found)**0.5
    expect((abs(numpy.mean(found, axis=0) - exact) < 3 * error).all(), f"shares by bins: {numpy.mean(found, axis=0)}, not {exact}")


def bars():
    """95 % bars hold the truth about that often: a line with noise, whose share is a half."""
    parameters = [plan.parameter("a=normal:0:1"), plan.parameter("b=normal:0:1")]
    held = {"regression": 0, "bins": 0, "quantiles": 0}
    samples = 100
    for seed in range(samples):
        points = drawn("random", 200, seed, parameters)
        noise = numpy.random.default_rng(1000 + seed).normal(size=200)
        values = points[:, 0] + noise
        regression = analysis.Regression(parameters, points, values)
        for name, estimate in {"regression": lambda chosen: regression.shares(chosen)[0],
                               "bins": lambda chosen: analysis.bins(points[chosen], values[chosen])[0]}.items():
            bar = analysis.WIDTH * analysis.deviation_by_resampling(estimate, 200, resamples=200)
            held[name] += abs(estimate(slice(None)) - 0.5) < bar
        held["quantiles"] += sum(low <= exact <= high for (_, low, high), exact in
                                 zip(analysis.quantiles(values), numpy.array([-1.6448536, 0, 1.6448536]) * 2**0.5)) / 3
    # 95 less three deviations of the count, 2.2 each.
    for name, count in held.items():
        expect(count >= 88, f"bars of {name} hold the truth in {count:.0f} of {samples} samples")


def control():
    """A control that leaves a twentieth of the variance: the gain is 20 times (n - 3) / (n - 2) (Lavenberg and Welch 1981)."""
    chance = numpy.random.default_rng(5)
    known = chance.normal(size=400)
    values = known + chance.normal(size=400) / 19**0.5
    gain = analysis.gain(values, known, 0.0, 20)
    exact = (20 - 3) / (20 - 2) / (1 - numpy.corrcoef(values, known)[0, 1]**2)
    expect(abs(gain / exact - 1) < 0.1, f"gain {gain}, not {exact}")
    mean, error = analysis.controlled_mean(values, known, 0.0)
    expect(abs(mean) < 3 * error and 0.8 < error * (400 * 19)**0.5 < 1.2, f"controlled mean {mean} +- {error}")


def through_the_program(folder):
    shutil.rmtree(folder, ignore_errors=True)
    start = [sys.executable, "-B", SCRIPTS / "study.py"]
    words = ["sample", "24", "--plan", "lhs", "--seed", "2", "--folder", folder, "sheet_thickness=normal:1:0.01",
             "punch_radius=23.4:23.6", "friction_coefficient=0.1:0.17", "--", *TINY]
    for arguments in (words, ["analyse", folder, "loaded_deg", "--derivatives", "3"]):
        ended = subprocess.run([*start, *arguments], cwd=SCRIPTS.parent, capture_output=True, text=True, check=False)
        expect(ended.returncode == 0, f"{arguments[0]}: {ended.stderr}")
    derived = "| 3 with derivatives |" in ended.stdout and "| derivatives |" in ended.stdout
    expect(derived, f"no derivatives: {ended.stdout}{ended.stderr}")
    for name in ("runs.csv", "loaded_deg.svg", "loaded_deg.png"):
        expect((folder / name).exists() and (folder / name).stat().st_size > 1000, f"{name} is missing or empty")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for part in (plans, polynomial, ishigami, bars, control):
        part()
    through_the_program(pathlib.Path(sys.argv[1]).resolve())
    for problem in PROBLEMS:
        print("check_studies:", problem)
    print("check_studies:", f"{len(PROBLEMS)} problems" if PROBLEMS else "plans, shares, quantiles and control as they should be")
    sys.exit(1 if PROBLEMS else 0)


main()
