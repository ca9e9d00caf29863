"""The table of a plan's runs, `runs.csv`, and what it belongs to, `plan.json`.

The table is written anew after every run and put in the place of the old one in one move, so it is complete whenever
the study is killed. Rows stand in the order of the plan, and hold nothing that differs from one machine or day to
another: an interrupted study that goes on ends with the table of one that was not.
"""
import csv
import fcntl
import hashlib
import json
import os
import pathlib
import sys

from studies.program import PROGRAM

QUANTITIES = {"F(5) N": "force_5_N", "F(10) N": "force_10_N", "F(20) N": "force_20_N", "F max, d < 25 N": "force_max_N",
              "loaded deg": "loaded_deg", "withdrawn deg": "withdrawn_deg", "tools vanish deg": "tools_vanish_deg",
              "steps": "steps", "refused": "refused", "iterations": "iterations"}


class RunsTable:
    """Rows by number of the run, as words."""

    def __init__(self, folder, plan):
        self.folder, self.plan = folder, plan
        self.columns = ["run", *plan.names, "status", "reason", "verdicts", *QUANTITIES.values()]
        self.rows = {}
        said = {**plan.words, "options": plan.options, **fingerprints(plan.options)}
        path = folder / "plan.json"
        folder.mkdir(parents=True, exist_ok=True)
        self.lock = only_one(folder)
        # A plan without a run, perhaps with a wrong word in it, is nothing to keep.
        if path.exists() and (folder / "runs.csv").exists():
            self.refuse_another(said, json.loads(path.read_text()))
            self.read()
        else:
            replace(path, json.dumps(said, indent=1) + "\n")

    def refuse_another(self, said, found):
        other = [name for name in {**said, **found} if said.get(name) != found.get(name)]
        if other:
            sys.exit(f"study: {self.folder}/runs.csv is the table of another study, which differs in: {', '.join(other)}; "
                     "give this one a folder of its own with --folder, or remove that one")

    def read(self):
        with open(self.folder / "runs.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            number = int(row["run"]) if row.get("run", "").isdecimal() else 0
            if not 1 <= number <= len(self.plan.runs) or [row.get(name) for name in self.plan.names] != self.plan.runs[number - 1]:
                sys.exit(f"study: row {row.get('run')} of {self.folder}/runs.csv has other values than this plan; "
                         "give this study a folder of its own with --folder, or remove that one")
            self.rows[number] = row

    def missing(self, again):
        """Numbers of the runs that are to be made; with `again`, failed ones too."""
        if again:
            self.rows = {number: row for number, row in self.rows.items() if row["status"] == "finished"}
        return [number for number in range(1, len(self.plan.runs) + 1) if number not in self.rows]

    def failed(self):
        return [number for number, row in self.rows.items() if row["status"] != "finished"]

    def add(self, number, found):
        """A run with its status, and what it found."""
        values = dict(zip(self.plan.names, self.plan.runs[number - 1]))
        self.rows[number] = {**dict.fromkeys(self.columns, ""), "run": str(number), **values, **found}
        path = self.folder / "runs.csv"
        with open(path.with_suffix(".new"), "w", newline="") as file:
            lines = csv.DictWriter(file, self.columns, lineterminator="\n")
            lines.writeheader()
            lines.writerows(self.rows[key] for key in sorted(self.rows))
            file.flush()
            os.fsync(file.fileno())
        path.with_suffix(".new").replace(path)


def only_one(folder):
    """Holds the folder for this study until it ends, however it ends."""
    lock = open(folder / ".lock", "w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        sys.exit(f"study: another study is at work in {folder}; let it end, or give this one a folder of its own with --folder")
    return lock


def replace(path, text):
    """Writes a file in one move."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


def fingerprints(options):
    """Checksums of the program and of the option files: with others the same words are another study."""
    files = [word for before, word in zip(options, options[1:]) if before == "-options_file"]
    return {"program": checksum(PROGRAM), "option files": {file: checksum(file) for file in files}}


def checksum(path):
    try:
        return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()
    except OSError as error:
        sys.exit(f"study: {path} cannot be read: {error.strerror}")
