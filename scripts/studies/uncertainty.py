"""Tables of a sample: `scripts/study.py analyse`."""
import csv
import dataclasses
import json
import sys

import numpy

from studies import analysis, derived, figure, plan
from studies.runs_table import QUANTITIES
from studies.tables import table

# Runs in a group of those whose means show what the control is worth.
GROUP = 20
# Points for the quantiles of the linear prediction, which cost nothing.
LINEAR_POINTS = 2**16


@dataclasses.dataclass
class Sample:
    """Parameters, and for each finished run its number, a row of their values (`points`), and the quantity there."""
    said: dict
    parameters: list
    numbers: list
    points: numpy.ndarray
    values: numpy.ndarray


def read(folder, quantity):
    """The finished runs of a sample."""
    try:
        said = json.loads((folder / "plan.json").read_text())
        with open(folder / "runs.csv", newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        sys.exit(f"study: {error.filename} cannot be read: {error.strerror}; study.py sample makes it")
    if said["plan"] == "factorial":
        sys.exit(f"study: {folder} is a factorial, whose values were chosen; only a sample has quantiles and shares")
    if quantity not in QUANTITIES.values():
        sys.exit(f"study: {quantity} is no quantity of the table; there are {', '.join(QUANTITIES.values())}")
    parameters = [plan.parameter(f"{name}={word}") for name, word in said["parameters"].items()]
    finished = [row for row in rows if row["status"] == "finished" and row[quantity]]
    if len(finished) < said["runs"]:
        print(f"study: {said['runs'] - len(finished)} of {said['runs']} runs are missing or failed; "
              "what is found holds for the others only", file=sys.stderr)
    if len(finished) < GROUP:
        sys.exit(f"study: {len(finished)} finished runs with {quantity} are too few; take {GROUP} or more")
    points = numpy.array([[float(row[one.name]) for one in parameters] for row in finished])
    values = numpy.array([float(row[quantity]) for row in finished])
    if numpy.ptp(values) == 0:
        sys.exit(f"study: {quantity} is {values[0]:g} in every run; there is nothing to share out")
    return Sample(said, parameters, [int(row["run"]) for row in finished], points, values)


def number(value, bar):
    """A value to the second digit of its bar."""
    places = max(0, 1 - int(numpy.floor(numpy.log10(bar)))) if bar > 0 else 4
    return f"{value:.{places}f}"


def with_bar(value, bar):
    return f"{number(value, bar)} ± {number(bar, bar)}"


def within(mark):
    """A quantile and its bounds."""
    middle, low, high = mark
    width = min(middle - low, high - middle)
    bound = [number(one, width) if numpy.isfinite(one) else "not bounded" for one in (low, high)]
    return f"{number(middle, width if numpy.isfinite(width) else 0.01)} ({bound[0]} to {bound[1]})"


def percent(value, bar=None):
    return f"{100 * value:.1f}" if bar is None else with_bar(100 * value, 100 * bar)


def spread(sample, marks, control):
    """Mean, deviation and quantiles, of the runs and of the linear prediction."""
    values = sample.values
    bar = analysis.WIDTH * values.std(ddof=1) / len(values)**0.5
    deviation_bar = analysis.WIDTH * analysis.deviation_by_resampling(lambda chosen: values[chosen].std(ddof=1), len(values))
    rows = [[f"{len(values)} runs", with_bar(values.mean(), bar), with_bar(values.std(ddof=1), deviation_bar), *map(within, marks)]]
    if control:
        drawn = plan.probabilities("sobol", LINEAR_POINTS, 1, len(sample.parameters))
        points = numpy.array([[one.value(p) for one, p in zip(sample.parameters, row)] for row in drawn])
        prediction = control(points)
        rows.append([f"{len(control.each)} with derivatives", number(prediction.mean(), bar), number(prediction.std(), deviation_bar),
                     *(number(numpy.quantile(prediction, p), bar) for p in analysis.PROBABILITIES)])
    table(["from", "mean", "standard deviation", *(f"{100 * p:g} % quantile" for p in analysis.PROBABILITIES)], rows)


def shares(sample, control):
    """Share of the variance by parameter, as {method: [(share, bar)]}; the regression, or None."""
    runs, found, regression = len(sample.values), {}, None
    try:
        regression = analysis.Regression(sample.parameters, sample.points, sample.values)
        bars = analysis.deviation_by_resampling(regression.shares, runs)
        found["regression"] = list(zip(regression.shares(), analysis.WIDTH * bars))
    except ValueError as error:
        print(f"study: no regression: {error}", file=sys.stderr)
    bars = analysis.deviation_by_resampling(lambda chosen: analysis.bins(sample.points[chosen], sample.values[chosen]), runs)
    found["bins"] = list(zip(analysis.bins(sample.points, sample.values), analysis.WIDTH * bars))
    if control:
        found["derivatives"] = [(share, None) for share in analysis.linear_shares(sample.parameters, control.slopes)]
    return found, regression


def show_shares(sample, found, regression):
    names = [one.name for one in sample.parameters] + ["two together", "not explained"]
    table(["share of the variance, %", *found],
          [[name, *(percent(*column[k]) if k < len(column) else "" for column in found.values())] for k, name in enumerate(names)])
    if regression:
        left = 100 * (1 - regression.unseen())
        print(f"Of the variance of runs they have not seen, the polynomials of the regression leave {left:.2g} %.\n")


def show_slopes(sample, control, regression):
    """Derivatives of the runs beside the slopes over the whole sample."""
    runs = len(control.each)
    heads = ["parameter", "standard deviation", "derivative in the middle", f"median of {runs} runs", "smallest", "largest"]
    rows = [[one.name, *(f"{value:.4g}" for value in (one.deviation, control.each[0, k], control.slopes[k], control.each[:, k].min(),
                                                      control.each[:, k].max()))] for k, one in enumerate(sample.parameters)]
    if regression:
        heads.append("slope over the sample")
        for row, slope in zip(rows, regression.slopes(sample.parameters)):
            row.append(with_bar(slope[0], analysis.WIDTH * slope[1]))
    table(heads, rows)


def show_control(sample, control):
    """What the linear prediction is worth as a control variate of the mean."""
    prediction, values = control(sample.points), sample.values
    helped, error = analysis.controlled_mean(values, prediction, control.mean)
    plain = values.std(ddof=1) / len(values)**0.5
    table(["mean", "of the runs", "with the derivatives as control"],
          [["estimate", with_bar(values.mean(), analysis.WIDTH * plain), with_bar(helped, analysis.WIDTH * error)],
           [f"variance over groups of {GROUP} runs", "1", f"1 / {analysis.gain(values, prediction, control.mean, GROUP):.3g}"]])
    correlation = numpy.corrcoef(values, prediction)[0, 1]
    print(f"Correlation of runs and linear prediction {correlation:.5f}, largest difference {abs(values - prediction).max():.3g}.\n")


def report(folder, quantity, derived_runs):
    """Prints the tables and draws the figure beside runs.csv."""
    sample = read(folder, quantity)
    control = derived.linear(folder, sample, quantity, derived_runs) if derived_runs else None
    marks = analysis.quantiles(sample.values)
    found, regression = shares(sample, control)
    spread(sample, marks, control)
    show_shares(sample, found, regression)
    if control:
        show_slopes(sample, control, regression)
        show_control(sample, control)
    print("figure:", figure.draw(folder, quantity, sample, marks, found, control))
