"""One run with every parameter at its mean, and the derivatives it carries (docs/sensitivity.md)."""
import csv
import json
import shutil
import subprocess
import sys

from studies.program import PROGRAM, WITHDRAWN, tools_vanish
from studies.runs_table import fingerprints

ANGLES = {"loaded_deg": lambda _: "full stroke", "withdrawn_deg": lambda _: "end of the motion", "tools_vanish_deg": tools_vanish}
FORCES = {"force_5_N": 5.0, "force_10_N": 10.0, "force_20_N": 20.0}
UNITS = ("", "_mm", "_MPa", "_mm_per_MPa")


def derivatives(folder, said, parameters, quantity):
    """The quantity and its derivative by each parameter; None, with a sentence, where there are none."""
    target = folder / "middle"
    why = None if (target / "summary.json").exists() else make(target, said, parameters)
    if why is None:
        summary = json.loads((target / "summary.json").read_text())
        if summary["status"] == "finished":
            value, slopes = angle(summary, quantity, parameters) if quantity in ANGLES else force(target, quantity, parameters)
            if value is not None and None not in slopes:
                return value, slopes
            why = f"the program has none of {quantity}"
        else:
            why = f"the run in the middle did not finish: {summary['reason']}"
    print(f"study: no derivatives: {why}", file=sys.stderr)
    return None


def make(target, said, parameters):
    """Makes the run; a sentence if the program refuses it."""
    now = fingerprints(said["options"])
    if any(now[name] != said[name] for name in now):
        sys.exit("study: the program or an option file is not the one the runs were made with, so derivatives would belong to "
                 "others; name the program in SSNP155")
    chosen = [word for one in parameters for word in (f"-{one.name}", f"{one.mean:.10g}")]
    command = [PROGRAM, *WITHDRAWN, *said["options"], *chosen, "-sensitivity", ",".join(one.name for one in parameters),
               "-output_every", "0", "-overwrite", "-output_dir", str(target)]
    print("study: the run in the middle, with its derivatives", file=sys.stderr)
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if (target / "summary.json").exists():
        return None
    shutil.rmtree(target, ignore_errors=True)
    return " ".join(ended.stderr.split()) or f"the run in the middle ended with code {ended.returncode}"


def angle(summary, quantity, parameters):
    name = ANGLES[quantity](summary["angles_deg"])
    slopes = summary["sensitivity"]["angles"].get(name, {})
    return summary["angles_deg"].get(name), [slopes.get(one.name) for one in parameters]


def force(target, quantity, parameters):
    """From the row that ends at the stroke, going down."""
    with open(target / "sensitivity.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if quantity in FORCES and abs(float(row["stroke_mm"]) - FORCES[quantity]) < 1e-6:
            slopes = [[row[name] for unit in UNITS if (name := f"d_force_N_by_{one.name}{unit}") in row] for one in parameters]
            return float(row["force_N"]), [float(found[0]) if found else None for found in slopes]
    return None, []
