#!/usr/bin/env python3
"""Runs the solver over a set of options and tabulates forces and angles.

  scripts/study.py sweep NAME VALUE,VALUE,... [OPTION ...]   one option, any values
  scripts/study.py convergence [OPTION ...]                  meshes and step sizes, both friction cases
  scripts/study.py sensitivity [OPTION ...]                  angle after release against the data, +-5 %

Tables are Markdown on standard output. Options given last go to every run. The program is
target/release/ssnp155, or $SSNP155. Results of single runs stay in results-study/; with REUSE=1 a run that
is there is not made again.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
FRICTION = "0.1342"
WITHDRAWN = ["-unload_fraction", "1", "-time_unload", "1000"]


def run(name, options):
    """The summary and the history of one run."""
    folder = ROOT / "results-study" / name
    command = [PROGRAM, *options, "-output_dir", str(folder), "-output_every", "0"]
    if not (os.environ.get("REUSE") and (folder / "summary.json").exists()):
        print("run:", " ".join(options), file=sys.stderr, flush=True)
        subprocess.run(command, stdout=subprocess.PIPE, check=False)
    try:
        summary = json.loads((folder / "summary.json").read_text())
    except OSError:
        sys.exit(f"study: no summary from {' '.join(command)}")
    if summary["status"] != "finished":
        print("study: not finished:", summary["reason"], file=sys.stderr)
    with open(folder / "history.csv") as rows:
        history = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(rows)]
    return summary, history


def quantities(summary, history):
    """What the tables show; None where a run did not get there."""
    angles = summary["angles_deg"]
    loading = [row for row in history if row["t_ms"] <= 900.0 + 1e-6]

    def force(depth):
        found = [row["force_N"] for row in loading if abs(row["stroke_mm"] - depth) < 1e-6]
        return found[0] if found else None

    deepest = max((name for name in angles if name.startswith("tools vanish")),
                  key=lambda name: float(name.split()[-2]), default=None)
    return {
        "F(5) N": force(5.0),
        "F(10) N": force(10.0),
        "F(20) N": force(20.0),
        "F max, d < 25 N": max((row["force_N"] for row in loading if row["stroke_mm"] < 25.0), default=None),
        "loaded deg": angles.get("full stroke"),
        "withdrawn deg": angles.get("end of the motion") if summary["status"] == "finished" else None,
        "tools vanish deg": angles.get(deepest),
        "steps": summary["counts"]["steps"],
        "refused": summary["counts"]["refused_solves"],
        "iterations": summary["counts"]["newton_iterations"],
    }


def show(value):
    if value is None:
        return "-"
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(show(value) for value in row) + " |", flush=True)
    print()


def sweep(name, values, extra):
    rows = []
    for value in values:
        found = quantities(*run(f"{name}-{value}", [f"-{name}", value, *WITHDRAWN, *extra]))
        rows.append([value, *found.values()])
    table([name, *found], rows)


def convergence(extra):
    """Three meshes with the default step, three steps on the default mesh."""
    meshes, steps = [(85, 3), (170, 5), (340, 10)], ["9", "4.5", "2.25"]
    for friction in ["0", FRICTION]:
        found = {}
        for nx, ny, largest in [(*mesh, "9") for mesh in meshes] + [(170, 5, step) for step in steps[1:]]:
            options = ["-friction_coefficient", friction, "-sheet_nx", str(nx), "-sheet_ny", str(ny)]
            options += ["-dt_max", largest, *WITHDRAWN, *extra]
            found[nx, largest] = quantities(*run(f"convergence-{friction}-{nx}-{largest}", options))
        print(f"Coefficient of friction {friction}:\n")
        heads = ["mesh", "dt_max ms", *found[170, "9"]]
        names = {nx: f"{nx} x {ny}" for nx, ny in meshes}
        table(heads, [[names[nx], largest, *values.values()] for (nx, largest), values in found.items()])
        rows = []
        for quantity in list(found[170, "9"])[:7]:
            by_mesh = [found[nx, "9"][quantity] for nx, _ in meshes]
            by_step = [found[170, step][quantity] for step in steps]
            if None in by_mesh + by_step:
                continue
            # Second order in the mesh, first in the step; the error is what the last refinement of each still changed.
            mesh, step = by_mesh[2] - by_mesh[1], by_step[2] - by_step[1]
            rows.append([quantity, by_mesh[2] + mesh / 3.0 + (by_step[2] - by_step[0]) + step,
                         abs(mesh) + abs(step), mesh, step])
        table(["quantity", "extrapolated", "error estimate", "170 to 340 changes it by",
               "the last halving of the step by"], rows)


def sensitivity(extra):
    data = ["sheet_thickness", "die_shoulder_radius", "friction_coefficient", "yield stress"]
    for friction in ["0", FRICTION]:
        base = ["-friction_coefficient", friction, *WITHDRAWN, *extra]
        middle = quantities(*run(f"sensitivity-{friction}", base))
        rows = [["none", "", "", *list(middle.values())[4:7]]]
        defaults = {"sheet_thickness": 1.0, "die_shoulder_radius": 4.0, "friction_coefficient": float(friction)}
        for name in data:
            if name == "friction_coefficient" and friction == "0":
                continue
            for sign in [-1, 1]:
                factor = 1 + 0.05 * sign
                if name == "yield stress":
                    changed = ["-hardening_file", str(scaled_hardening(factor))]
                    value = f"x {factor:.2f}"
                else:
                    value = f"{defaults[name] * factor:.5g}"
                    changed = [f"-{name}", value]
                found = quantities(*run(f"sensitivity-{friction}-{name.replace(' ', '-')}-{sign}", base + changed))
                rows.append([name, value, found["withdrawn deg"] - middle["withdrawn deg"]
                             if found["withdrawn deg"] is not None else None, *list(found.values())[4:7]])
        print(f"Coefficient of friction {friction}:\n")
        table(["changed", "to", "change of the withdrawn angle", *list(middle)[4:7]], rows)


def scaled_hardening(factor):
    """The benchmark's table with all stresses times the factor, at the same plastic strains."""
    lines = [line for line in (ROOT / "inputs/reference/hardening.csv").read_text().splitlines()
             if line and not line.startswith("#")][1:]
    path = ROOT / "results-study" / f"hardening-{factor:.2f}.csv"
    path.parent.mkdir(exist_ok=True)
    with open(path, "w") as out:
        out.write("strain,stress\n")
        for line in lines:
            strain, stress = map(float, line.split(","))
            plastic = max(strain - stress / 70500.0, 0.0)
            plastic = 0.0 if plastic < 1e-6 else plastic
            out.write(f"{plastic + factor * stress / 70500.0:.12e},{factor * stress:.12e}\n")
    return path


def main(arguments):
    match arguments:
        case ["sweep", name, values, *extra]:
            sweep(name.lstrip("-"), values.split(","), extra)
        case ["convergence", *extra]:
            convergence(extra)
        case ["sensitivity", *extra]:
            sensitivity(extra)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
