#!/usr/bin/env python3
"""How far a run's force, displacement of A and angle may be from the solution without mesh and steps.

  scripts/error_bars.py [--effectivity] [OPTION ...]

OPTIONS go to the program as they are. Beside the run they describe its companions are made, each different in one thing:

  coarse     half the elements in each direction, twice the contact points per edge
  gauss      3 x 3 instead of 2 x 2 Gauss points (left out if the run has 3 x 3); with -quadrature_thickness about twice as many
             through the thickness (left out if that is more than there are)
  spacing    twice the contact points per edge (left out above 12 points, and where contact is not at points)
  steps      steps of twice the length
  scatter-N  steps of 17/18, 16/18 and 15/18 of the length

A bar is max(mesh, integration) + spacing + max(steps, scatter): mesh is the difference to `coarse` over 2^3 - 1; integration,
spacing and steps are those to `gauss`, `spacing` and `steps`; scatter is the largest difference to a `scatter-N`. Mesh and
integration see one and the same error, and so do steps and scatter: the larger counts. docs/error-bars.md says why, and how good
the bars are. -report_returns adds places on the way back.

With --effectivity a reference of twice the elements in each direction and half the step is made as well, and each bar is
compared with the distance to it, place by place, and the bars of a part of the path with its distances. There mesh and step can
cancel, so a run with the finer mesh and one with the shorter step are made, too, and a second effectivity is that to the sum of
the distances to these two. Tables are
Markdown on standard output; results-error-bars/error-bars.csv holds the parts. The program is target/release/ssnp155, or
$SSNP155; $ERROR_BARS is another folder for the results. With REUSE=1 a run that is there is not made again.
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
RESULTS = pathlib.Path(os.environ.get("ERROR_BARS", ROOT / "results-error-bars"))
# Order of the mesh's part; docs/error-bars.md measures it.
ORDER = 3
SCATTER = [17 / 18, 16 / 18, 15 / 18]
MOST_POINTS_PER_EDGE = 24
# About twice the points through an element that -quadrature_thickness offers.
MORE_THROUGH = {"2": "4", "3": "5", "4": "7", "5": "10", "7": "15"}
QUANTITIES = {"force_N": "force N", "dy_A_sheet_mm": "DY of A mm", "angle_deg": "angle deg"}
ANGLE = "angle deg"
# Share of the stroke up to which the path is smooth on any mesh.
EASY = 20 / 28.5
# Two places closer than this, ms, are one.
SAME_TIME = 1e-6
PARTS = ["mesh", "integration", "spacing", "steps", "scatter"]


def run(name, options):
    """The options, angles and history of one run."""
    folder = RESULTS / name
    if not (os.environ.get("REUSE") and (folder / "summary.json").exists()):
        command = [PROGRAM, *options, "-output_every", "0", "-overwrite", "-output_dir", str(folder)]
        print("run:", name, *options, file=sys.stderr, flush=True)
        ended = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        # A verdict that does not hold is no obstacle: companions are coarse.
        if not (folder / "summary.json").exists():
            sys.exit(f"error_bars: run '{name}' left no summary: {ended.stderr.strip() or ended.stdout.strip()}")
    summary = json.loads((folder / "summary.json").read_text())
    if summary["status"] != "finished":
        sys.exit(f"error_bars: run '{name}' did not finish: {summary['reason']}; choose options with which half the mesh "
                 "gets to the end, too")
    with open(folder / "history.csv", newline="") as file:
        history = [{column: float(value) for column, value in row.items()} for row in csv.DictReader(file)]
    return summary["provenance"]["options"], summary["angles_deg"], history


def scaled_steps(options, factor):
    """Options for steps of `factor` times the length."""
    changed = ["-dt_max", repr(float(options["dt_max"]) * factor)]
    for name in ("fixed_steps_load", "fixed_steps_unload"):
        if int(options[name]):
            changed += [f"-{name}", str(round(int(options[name]) / factor))]
    return changed


def mesh(nx, ny):
    return ["-sheet_nx", str(nx), "-sheet_ny", str(ny)]


def companions(options):
    """Name and changed options of every companion of a run with these options."""
    nx, ny, points = (int(options[name]) for name in ("sheet_nx", "sheet_ny", "contact_points_per_edge"))
    if nx < 2 or ny < 2:
        sys.exit(f"error_bars: a mesh of {nx} x {ny} elements has no half; take at least 2 x 2")
    twice = str(min(2 * points, MOST_POINTS_PER_EDGE))
    found = {"coarse": [*mesh((nx + 1) // 2, (ny + 1) // 2), "-contact_points_per_edge", twice]}
    through = options["quadrature_thickness"]
    if through == "same" and options["quadrature"] == "2":
        found["gauss"] = ["-quadrature", "3"]
    if through in MORE_THROUGH:
        found["gauss"] = ["-quadrature_thickness", MORE_THROUGH[through]]
    if options["contact_location"] == "points" and 2 * points <= MOST_POINTS_PER_EDGE:
        found["spacing"] = ["-contact_points_per_edge", twice]
    found["steps"] = scaled_steps(options, 2)
    for number, factor in enumerate(SCATTER, 1):
        found[f"scatter-{number}"] = scaled_steps(options, factor)
    return found


def at(history, time, column):
    """Value at a time, linear between rows."""
    for before, after in zip(history, history[1:]):
        if before["t_ms"] <= time <= after["t_ms"]:
            share = (time - before["t_ms"]) / (after["t_ms"] - before["t_ms"])
            return before[column] + share * (after[column] - before[column])
    return history[-1][column]


def values(options, result):
    """Values by (place, quantity): at the strokes to report, at full stroke, at the returns to report, and released."""
    _, angles, history = result
    stroke, load = float(options["stroke"]), float(options["time_load"])
    back, unload = float(options["unload_fraction"]), float(options["time_unload"])
    reported = [float(word) for word in options["report_strokes"].split(",") if word != "none"]
    times = {f"d = {depth:g} mm": load * depth / stroke for depth in reported if depth < stroke}
    times["full stroke"] = load
    returns = [float(word) for word in options["report_returns"].split(",") if word != "none"]
    times |= {f"{way:g} mm back": load + unload * way / (back * stroke) for way in returns if way < back * stroke}
    tenth = load + unload * 0.1 / back if back > 0.1 else load
    if all(abs(time - tenth) > SAME_TIME for time in times.values()):
        times["10 % unloaded"] = tenth
    if back > 0.0:
        times["withdrawn" if back == 1.0 else f"{100 * back:g} % unloaded"] = load + unload
    found = {}
    for place, time in times.items():
        for column, quantity in QUANTITIES.items():
            # A withdrawn punch carries nothing, and the sheet lies where it happens to.
            if place != "withdrawn" or quantity == ANGLE:
                found[place, quantity] = at(history, time, column)
    for place, angle in angles.items():
        if place == f"tools vanish at {stroke:g} mm":
            found["tools vanish", ANGLE] = angle
    return found


def bars(value, beside):
    """The parts of every bar and the bar itself, from the run's values and those of its companions by name."""
    found = {}
    for key, own in value.items():
        away = {name: abs(other[key] - own) for name, other in beside.items()}
        parts = {"mesh": away["coarse"] / (2**ORDER - 1), "integration": away.get("gauss", 0.0),
                 "spacing": away.get("spacing", 0.0), "steps": away["steps"],
                 "scatter": max(distance for name, distance in away.items() if name.startswith("scatter"))}
        bar = max(parts["mesh"], parts["integration"]) + parts["spacing"] + max(parts["steps"], parts["scatter"])
        found[key] = {**parts, "bar": bar}
    return found


def two_digits(number):
    """A bar to two digits."""
    return f"{number:.2g}" if number < 100 else f"{number:.0f}"


def write(value, found):
    with open(RESULTS / "error-bars.csv", "w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(["place", "quantity", "value", "bar", *PARTS])
        for key, bar in found.items():
            lines.writerow([*key, repr(value[key]), *(f"{bar[part]:.6g}" for part in ["bar", *PARTS])])


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


def stage(place, stroke):
    """The part of the path that a place belongs to."""
    if place.startswith("d = "):
        depth = float(place.split()[2])
        return f"down to {stroke * EASY:.0f} mm" if depth <= stroke * EASY else "down from there"
    if place == "full stroke":
        return "down from there"
    return "way back" if place.endswith(("% unloaded", "mm back")) else "released"


def norms(found, distances, apart, stroke):
    """Effectivity of a quantity along a part of the path: norm of its bars over norm of its distances to the reference, and
    over that of its distances to a finer mesh and a shorter step apart.

    A distance that passes through zero somewhere, as any does that has two signs, gives that place an effectivity without
    a bound; norms are what an estimate can be held to.
    """
    squares = {}
    for (place, quantity), distance in distances.items():
        key = place, quantity
        terms = (1, found[key]["bar"] ** 2, distance**2, apart[key] ** 2)
        sums = squares.setdefault((stage(place, stroke), quantity), (0, 0.0, 0.0, 0.0))
        squares[stage(place, stroke), quantity] = tuple(map(sum, zip(sums, terms)))
    rows = []
    for key, (places, bar, *away) in squares.items():
        row = [*key, str(places), two_digits(math.sqrt(bar / places))]
        for distance in away:
            row += [two_digits(math.sqrt(distance / places)), f"{math.sqrt(bar / distance):.2f}" if distance > 0.0 else "-"]
        rows.append(row)
    return rows


def main(arguments):
    judged = arguments[:1] == ["--effectivity"]
    extra = arguments[1:] if judged else arguments
    if {"-h", "--help"} & set(extra):
        sys.exit(__doc__)
    if "-restart" in extra:
        sys.exit("error_bars: companions begin at the start, so -restart has no meaning here; leave it out")
    own = run("run", extra)
    options = own[0]
    value = values(options, own)
    beside = {name: values(options, run(name, [*extra, *changed])) for name, changed in companions(options).items()}
    found = bars(value, beside)
    write(value, found)
    heads = ["place", "quantity", "value ± bar", *PARTS]
    shown = {key: [*key, f"{value[key]:.6g} ± {two_digits(bar['bar'])}", *(two_digits(bar[part]) for part in PARTS)]
             for key, bar in found.items()}
    if judged:
        finer = mesh(2 * int(options["sheet_nx"]), 2 * int(options["sheet_ny"]))
        shorter = scaled_steps(options, 0.5)
        away = {}
        for name, changed in (("reference", [*finer, *shorter]), ("finer", finer), ("shorter", shorter)):
            other = values(options, run(name, [*extra, *changed]))
            away[name] = {key: abs(value[key] - other[key]) for key in value}
        distances = away["reference"]
        apart = {key: away["finer"][key] + away["shorter"][key] for key in value}
        heads += ["distance to the reference", "effectivity"]
        for key, row in shown.items():
            distance = distances[key]
            row += [two_digits(distance), f"{found[key]['bar'] / distance:.2f}" if distance > 0.0 else "-"]
    table(heads, shown.values())
    if judged:
        table(["part of the path", "quantity", "places", "bars, root mean square", "distances", "effectivity",
               "finer mesh and shorter step apart", "effectivity"],
              norms(found, distances, apart, float(options["stroke"])))


if __name__ == "__main__":
    main(sys.argv[1:])
