"""One run of the program, and what the tables show of it."""
import csv
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
RESULTS = pathlib.Path(os.environ.get("STUDY", ROOT / "results-study"))
WITHDRAWN = ["-unload_fraction", "1", "-time_unload", "1000"]


def run(name, options):
    """The summary and the history of one run."""
    folder = RESULTS / name
    command = [PROGRAM, *options, "-output_dir", str(folder), "-output_every", "0"]
    if not (os.environ.get("REUSE") and (folder / "summary.json").exists()):
        print("run:", " ".join(options), file=sys.stderr, flush=True)
        subprocess.run(command, stdout=subprocess.PIPE, check=False)
    try:
        summary, history = read(folder)
    except OSError:
        sys.exit(f"study: no summary from {' '.join(command)}")
    if summary["status"] != "finished":
        print("study: not finished:", summary["reason"], file=sys.stderr)
    return summary, history


def read(folder):
    """The summary and the history in a folder."""
    summary = json.loads((folder / "summary.json").read_text())
    with open(folder / "history.csv") as rows:
        history = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(rows)]
    return summary, history


def tools_vanish(angles):
    """The name of the angle without tools from the deepest stroke, or None."""
    return max((name for name in angles if name.startswith("tools vanish")),
               key=lambda name: float(name.split()[-2]), default=None)


def quantities(summary, history):
    """What the tables show; None where a run did not get there."""
    angles = summary["angles_deg"]
    loading = [row for row in history if row["t_ms"] <= float(summary["provenance"]["options"]["time_load"]) + 1e-6]

    def force(depth):
        found = [row["force_N"] for row in loading if abs(row["stroke_mm"] - depth) < 1e-6]
        return found[0] if found else None

    return {
        "F(5) N": force(5.0),
        "F(10) N": force(10.0),
        "F(20) N": force(20.0),
        "F max, d < 25 N": max((row["force_N"] for row in loading if row["stroke_mm"] < 25.0), default=None),
        "loaded deg": angles.get("full stroke"),
        "withdrawn deg": angles.get("end of the motion") if summary["status"] == "finished" else None,
        "tools vanish deg": angles.get(tools_vanish(angles)),
        "steps": summary["counts"]["steps"],
        "refused": summary["counts"]["refused_solves"],
        "iterations": summary["counts"]["newton_iterations"],
    }
