"""Runs that carry derivatives (docs/sensitivity.md), and the linear prediction they make.

One run's derivatives are those of its own path: where contact opens and closes point by point, they can be far from how the
quantity changes over the width of a tolerance. So there are several runs, one with every parameter at its mean and others
at points of the sample, and the median of each slope counts.
"""
import csv
import dataclasses
import json
import shutil
import subprocess
import sys

import numpy

from studies.program import PROGRAM, WITHDRAWN, tools_vanish
from studies.runs_table import fingerprints

ANGLES = {"loaded_deg": lambda _: "full stroke", "withdrawn_deg": lambda _: "end of the motion", "tools_vanish_deg": tools_vanish}
FORCES = {"force_5_N": 5.0, "force_10_N": 10.0, "force_20_N": 20.0}
UNITS = ("", "_mm", "_MPa", "_mm_per_MPa")


@dataclasses.dataclass
class Linear:
    """Slope by each parameter, median over the runs (each a row of `each`); `mean` is the prediction's mean exactly."""
    centre: numpy.ndarray
    mean: float
    slopes: numpy.ndarray
    each: numpy.ndarray

    def __call__(self, points):
        return self.mean + (points - self.centre) @ self.slopes


def linear(folder, sample, quantity, runs):
    """The prediction from `runs` runs, in the middle and as the first of the sample; None, with a sentence, if there is none."""
    centre = numpy.array([one.mean for one in sample.parameters])
    places = {"middle": centre, **{f"{number:04}": point for number, point in zip(sample.numbers[:runs - 1], sample.points)}}
    made, values, slopes = [], [], []
    for name, place in places.items():
        target = folder / f"derivatives-{name}"
        try:
            if not there(target, sample.parameters, place):
                make(target, sample.said, sample.parameters, place)
            value, slope = found(target, quantity, sample.parameters)
        except LookupError as error:
            print(f"study: no derivatives from {target}: {error.args[0]}", file=sys.stderr)
            # What the program refuses once it refuses always.
            if not target.exists():
                return None
            continue
        made.append(place)
        values.append(value)
        slopes.append(slope)
    if not made:
        return None
    each = numpy.array(slopes)
    median = numpy.median(each, axis=0)
    return Linear(centre, numpy.median(values - (numpy.array(made) - centre) @ median), median, each)


def there(target, parameters, place):
    """Whether the run has been made, with these values."""
    try:
        options = json.loads((target / "summary.json").read_text())["provenance"]["options"]
    except OSError:
        return False
    return numpy.allclose([float(options[one.name]) for one in parameters], place, rtol=1e-9)


def make(target, said, parameters, place):
    """Makes a run; LookupError if the program refuses it."""
    now = fingerprints(said["options"])
    if any(now[name] != said[name] for name in now):
        sys.exit("study: the program or an option file is not the one the runs were made with, so derivatives would belong to "
                 "others; name the program in SSNP155")
    chosen = [word for one, value in zip(parameters, place) for word in (f"-{one.name}", f"{value:.10g}")]
    command = [PROGRAM, *WITHDRAWN, *said["options"], *chosen, "-sensitivity", ",".join(one.name for one in parameters),
               "-output_every", "0", "-overwrite", "-output_dir", str(target)]
    print(f"study: a run with derivatives, {target}", file=sys.stderr, flush=True)
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if not (target / "summary.json").exists():
        shutil.rmtree(target, ignore_errors=True)
        raise LookupError(" ".join(ended.stderr.split()) or f"the run ended with code {ended.returncode}")


def found(target, quantity, parameters):
    """The quantity of a run and its derivative by each parameter; LookupError if it has none."""
    summary = json.loads((target / "summary.json").read_text())
    if summary["status"] != "finished":
        raise LookupError(f"the run did not finish: {summary['reason']}")
    if quantity in ANGLES:
        name = ANGLES[quantity](summary["angles_deg"])
        slopes = summary["sensitivity"]["angles"].get(name, {})
        value, slopes = summary["angles_deg"].get(name), [slopes.get(one.name) for one in parameters]
    elif quantity in FORCES:
        value, slopes = force(target, FORCES[quantity], parameters)
    else:
        value, slopes = None, []
    if value is None or None in slopes:
        raise LookupError(f"the program has none of {quantity}")
    return value, slopes


def force(target, depth, parameters):
    """From the row that ends at the stroke, going down."""
    with open(target / "sensitivity.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if abs(float(row["stroke_mm"]) - depth) < 1e-6:
            columns = [[row[name] for unit in UNITS if (name := f"d_force_N_by_{one.name}{unit}") in row] for one in parameters]
            return float(row["force_N"]), [float(column[0]) if column else None for column in columns]
    return None, []
