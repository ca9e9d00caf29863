#!/usr/bin/env python3
"""How far the angle after release depends on mesh, integration, steps, contact and mass: one thing changed at a time.

  scripts/released.py [OPTION ...]                                 without friction
  scripts/released.py -friction_coefficient 0.1342 [OPTION ...]    with friction

The base is inputs/released.opts. Without friction the tools vanish at full stroke, and the way back is left out: it changes nothing.
With friction inputs/released-friction.opts says why the way back is a tenth of the stroke in short steps, at whose end the tools
vanish. A row says where the yielding ends, and a run that still yields at the end of its way is refused; the row "all the way out" is
full withdrawal. OPTIONS go to every run after those of the base, before what a run changes. Tables are Markdown on standard output. The
program is target/release/ssnp155, or $SSNP155. Results stay in results-released-study/; with REUSE=1 a run that is there is not made
again, and with ONLY=WORD,WORD only the base and the runs named WORD or WORD-... are made.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
RESULTS = ROOT / "results-released-study"
BASE = ["-options_file", "inputs/band.opts", "-options_file", "inputs/released.opts"]
LOADING = ["-unload_fraction", "0"]
BACK = ["-options_file", "inputs/released-friction.opts"]
POINTS = "-contact_points_per_edge"


def mesh(nx, ny):
    return ["-sheet_nx", str(nx), "-sheet_ny", str(ny)]


def through(points):
    return ["-quadrature_thickness", str(points)]


STEPS = ("9", "8.5", "8", "7.5", "7", "6.5", "6", "3.7", "3.5", "3.2", "3", "2.7", "2.5", "2.2", "2")

# Name, what it is, and the changed options, in the order of the table.
CHANGES = [("base", "base: inputs/released.opts, steps of at most 4 ms", [])]
CHANGES += [(f"step-{dt}", f"longest step {dt} ms", ["-dt_max", dt]) for dt in STEPS]
CHANGES += [
    ("points-5", "5 Gauss points through each element", through(5)),
    ("points-10", "10 Gauss points through each element", through(10)),
    ("points-15", "15 Gauss points through each element", through(15)),
    ("along-3", "3 Gauss points along each element", ["-quadrature", "3"]),
    ("fine-340-4", "... on 340 x 4 elements, 6 contact points", ["-quadrature", "3", *mesh(340, 4), POINTS, "6"]),
    ("fine-340-8", "... on 340 x 8 elements, 6 contact points", ["-quadrature", "3", *mesh(340, 8), POINTS, "6"]),
    ("mesh-170-3", "170 x 3 elements, 10 points through each", [*mesh(170, 3), *through(10)]),
    ("mesh-170-6", "170 x 6 elements, 5 points through each", [*mesh(170, 6), *through(5)]),
    ("mesh-170-8", "170 x 8 elements, 4 points through each", [*mesh(170, 8), *through(4)]),
    ("mesh-170-8-7", "170 x 8 elements, 7 points through each", mesh(170, 8)),
    ("mesh-170-12", "170 x 12 elements, 3 points through each", [*mesh(170, 12), *through(3)]),
    ("mesh-120-4", "120 x 4 elements, 17 contact points", [*mesh(120, 4), POINTS, "17"]),
    ("mesh-240-4", "240 x 4 elements, 8 contact points", [*mesh(240, 4), POINTS, "8"]),
    ("mesh-340-4", "340 x 4 elements, 6 contact points", [*mesh(340, 4), POINTS, "6"]),
    ("mesh-340-8", "340 x 8 elements, 4 points through each, 6 contact points", [*mesh(340, 8), *through(4), POINTS, "6"]),
    ("mesh-340-8-7", "340 x 8 elements, 7 points through each, 6 contact points", [*mesh(340, 8), POINTS, "6"]),
    ("contact-9", "9 contact points", [POINTS, "9"]),
    ("contact-16", "16 contact points", [POINTS, "16"]),
    ("contact-20", "20 contact points", [POINTS, "20"]),
    ("contact-24", "24 contact points", [POINTS, "24"]),
    ("closest", "contact at the closest points", ["-contact_location", "closest"]),
    ("compliance-half", "half the contact compliance", ["-contact_compliance", "2.5e-5"]),
    ("compliance-twice", "twice the contact compliance", ["-contact_compliance", "1e-4"]),
    ("density-tenth", "a tenth of the density", ["-density", "2.7e-4"]),
    ("density-tenfold", "ten times the density", ["-density", "2.7e-2"]),
    ("static", "no mass", ["-dynamics", "none"]),
]
# With friction: the way back and the compliances are worth more rows.
FRICTION_CHANGES = [
    ("back-800", "way back in 800 equal steps", ["-fixed_steps_unload", "800"]),
    ("back-200", "way back in 200 equal steps", ["-fixed_steps_unload", "200"]),
    ("back-free", "way back in steps of at most 4 ms", ["-fixed_steps_unload", "0"]),
    ("back-free-8", "... steps of at most 8 ms, down as well", ["-fixed_steps_unload", "0", "-dt_max", "8"]),
    ("back-free-9", "... steps of at most 9 ms, down as well", ["-fixed_steps_unload", "0", "-dt_max", "9"]),
    ("out", "all the way out, in 4000 equal steps", ["-unload_fraction", "1", "-time_unload", "1000", "-fixed_steps_unload", "4000"]),
    ("compliance-quarter", "a quarter of the contact compliance", ["-contact_compliance", "1.25e-5"]),
    ("slip-half", "half the friction compliance", ["-friction_compliance", "2.5e-4"]),
    ("slip-twice", "twice the friction compliance", ["-friction_compliance", "1e-3"]),
]
# The plastic work has stopped growing where it is within this share of its last value.
YIELDED = 1e-9


def run(name, options):
    """The summary of one run."""
    folder = RESULTS / name
    if not (os.environ.get("REUSE") and (folder / "summary.json").exists()):
        print("run:", name, *options, file=sys.stderr, flush=True)
        command = [PROGRAM, *options, "-output_every", "0", "-overwrite", "-output_dir", str(folder)]
        subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
    try:
        return json.loads((folder / "summary.json").read_text())
    except OSError:
        sys.exit(f"released: no summary from run {name}")


def angles(summary):
    """Loaded, tools vanished at full stroke and at the end of the motion, degrees; none where the run did not get there."""
    found = summary["angles_deg"]
    vanished = [(name.startswith("tools vanish at 28.5"), angle) for name, angle in found.items() if name.startswith("tools vanish")]
    released = dict(vanished) if summary["status"] == "finished" else {}
    return found.get("full stroke"), released.get(True), released.get(False)


def last_yielding(name, summary):
    """Where the plastic work grows for the last time: way of the punch from the turn, mm, and the work, mJ."""
    options = summary["provenance"]["options"]
    with open(RESULTS / name / "history.csv", newline="") as file:
        rows = [(float(row["t_ms"]), float(row["stroke_mm"]), float(row["plastic_dissipation_mJ"])) for row in csv.DictReader(file)]
    last = rows[-1][2]
    grown = next(number for number, row in enumerate(rows) if row[2] > (1.0 - YIELDED) * last)
    time, travel, _ = rows[grown]
    if summary["status"] == "finished" and (grown == len(rows) - 1 or time <= float(options["time_load"])):
        sys.exit(f"released: {name} yields until the end of its way back, or not at all there; its angle is not that after withdrawal")
    return float(options["stroke"]) - travel, last


def show(value, digits=3):
    return "-" if value is None else f"{value:.{digits}f}"


def difference(value, base):
    return "-" if value is None or base is None else f"{value - base:+.3f}"


def main(extra):
    if {"-h", "--help"} & set(extra):
        sys.exit(__doc__)
    friction = "-friction_coefficient" in extra
    way = BACK if friction else LOADING
    only = [word for word in os.environ.get("ONLY", "").split(",") if word]
    heads = ["what", "loaded", "tools vanish", "to the base", "steps", "refused", "iterations"]
    if friction:
        heads[3:3] = ["withdrawn", "yields until mm", "plastic work mJ"]
    print("| " + " | ".join(heads) + " |\n" + "|" + "---|" * len(heads))
    base = None
    for name, what, changed in CHANGES + (FRICTION_CHANGES if friction else []):
        if only and name != "base" and not any(name == word or name.startswith(f"{word}-") for word in only):
            continue
        name = ("friction-" if friction else "") + name
        summary = run(name, [*BASE, *way, *extra, *changed])
        loaded, vanish, withdrawn = angles(summary)
        released = withdrawn if friction else vanish
        base = released if base is None else base
        cells = [what, show(loaded), show(vanish)]
        if friction:
            end, work = last_yielding(name, summary)
            cells += [show(withdrawn), show(end, 2), show(work, 1)]
        counts = summary["counts"]
        cells += [difference(released, base), str(counts["steps"]), str(counts["refused_solves"]), str(counts["newton_iterations"])]
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
