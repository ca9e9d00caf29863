#!/usr/bin/env python3
"""Measure whether the advice of the FAILED banner helps: the table of docs/it-does-not-converge.md.

    scripts/remedies.py [FOLDER]       results go to FOLDER (default results-remedies)

Runs cases that fail on purpose, reads the remedies from summary.json, and runs each case again with each remedy alone.
Small meshes, one rank, a few minutes. Prints a Markdown table. Needs the program, built for release.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

MESH = "-sheet_nx 60 -sheet_ny 2"
CASES = {
    "least step too long": f"{MESH} -dt_initial 2 -dt_min 2",
    "too few iterations": f"{MESH} -newton_max_iterations 4 -dt_min 0.01",
    "friction too stiff": f"{MESH} -friction_coefficient 0.1342 -friction_compliance 1e-9",
    "surface too stiff": f"{MESH} -contact_compliance 1e-9 -dt_min 0.1",
    "static": f"{MESH} -dynamics none",
    "steps too long": f"{MESH} -dt_initial 300 -dt_max 900 -dt_min 100",
    "contact at nodes": f"{MESH} -contact_location nodes -dt_min 0.1",
    "coarse, with friction": "-sheet_nx 12 -sheet_ny 1 -friction_coefficient 0.1342 -unload_fraction 1 -dt_min 0.1",
}


def run(folder, options):
    """Runs the program once; gives its summary."""
    program = Path(os.environ.get("CARGO_TARGET_DIR", "target")) / "release/ssnp155"
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "run.log", "w") as log:
        words = [program, *options.split(), "-output_every", "0", "-output_dir", folder]
        subprocess.run(words, stdout=log, stderr=subprocess.STDOUT, timeout=600)
    return json.loads((folder / "summary.json").read_text())


def told(summary):
    """How a run ended, in a few words."""
    steps = summary["counts"]["steps"]
    if summary["status"] == "finished":
        return f"finishes in {steps} steps"
    return f"stops at {summary['final']['stroke_mm'] if summary['final'] else 0:.2f} mm"


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "results-remedies")
    print("| case | options | ends | remedy | with it |\n|---|---|---|---|---|")
    for number, (name, options) in enumerate(CASES.items()):
        summary = run(folder / f"{number}", options)
        diagnosis = summary["diagnosis"]
        print(f"| {name} | `{options}` | {told(summary)} | {'' if diagnosis else 'none needed'} | |", flush=True)
        for which, remedy in enumerate(diagnosis["remedies"] if diagnosis else []):
            words = remedy.replace(":", " ").split()
            if not words[0].startswith("-"):
                continue
            given = f"{words[0]} {words[1]}"
            again = run(folder / f"{number}-{which}", f"{options} {given}")
            print(f"| | | | `{given}` | {told(again)} |", flush=True)


if __name__ == "__main__":
    main()
