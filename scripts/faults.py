#!/usr/bin/env python3
"""Kill runs, fill their disk, damage their checkpoints, many times; every run must come to the end of an unbroken one.

    scripts/faults.py [SEED]        (needs: cargo build --release; for the full disk: root)

Prints one line per campaign with its counts, and ends with code 1 if one count is not what it must be. The seed (155 if
none is given) fixes all random choices but the moments at which the machine is slow or fast.
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "ssnp155"
CASE = """-sheet_nx 60 -sheet_ny 2 -stroke 12 -time_load 378 -unload_fraction 0.2 -time_unload 60 -report_strokes none
          -dt_max 4 -friction_coefficient 0.1342 -output_every 2""".split()
KILLS = 20
FLIPS = 400
CUTS = 100
DISKS = 24


def command(folder, *more, ranks=1):
    start = [] if ranks == 1 else ["mpirun", "-n", str(ranks)]
    return [*start, str(PROGRAM), *CASE, "-output_dir", str(folder), *more]


def run(folder, *more, ranks=1, seconds=None):
    return subprocess.run(command(folder, *more, ranks=ranks), capture_output=True, text=True, timeout=seconds)


def rows(folder):
    return (folder / "history.csv").read_bytes()


def checkpoints(folder):
    found = [path for path in folder.glob("checkpoint-*") if path.suffix == ""]
    return sorted(found, key=lambda path: int(path.name.split("-")[1]))


def interrupted_somewhere(work, name, how, ranks, choose, reference, seconds):
    """Stops runs KILLS times at random moments and lets them go on; tells whether all came to the same end."""
    more = ["-checkpoint_every", "3"]
    hits, false_ends, same, runs = 0, 0, 0, 0
    while hits < KILLS:
        folder = work / name.replace(" ", "-")
        shutil.rmtree(folder, ignore_errors=True)
        runs += 1
        code = None
        while code != 0:
            again = ["-restart"] if folder.exists() and checkpoints(folder) else []
            process = subprocess.Popen(command(folder, *more, *again, ranks=ranks), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            try:
                code = process.wait(timeout=choose.uniform(0.1, 0.9) * seconds if hits < KILLS else None)
                if code != 0:
                    sys.exit(f"{name}: a run that nobody stopped ended with code {code}")
            except subprocess.TimeoutExpired:
                process.send_signal(how)
                code = process.wait()
                wait_for_ranks(folder)
                # A signal that came after the last step finds the run finished.
                hits += code != 0
                summary = folder / "summary.json"
                said = summary.exists() and '"status": "finished"' in summary.read_text()
                false_ends += (said or code == 0) and rows(folder) != reference
        same += rows(folder) == reference
    print(f"{name}: {hits} stops in {runs} runs, {same} of the runs with every row of the unbroken one, "
          f"{false_ends} false ends", flush=True)
    return same == runs and false_ends == 0


def wait_for_ranks(folder):
    """Ranks whose mpirun was killed live a moment longer."""
    while any(str(folder).encode() in line for line in command_lines()):
        time.sleep(0.05)


def command_lines():
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = path.read_bytes()
        except OSError:
            continue
        if b"ssnp155" in line.split(b"\0")[0]:
            yield line


def damage(work, choose):
    """Flips bits of a checkpoint and cuts its files; the program must refuse each time and leave the results alone."""
    folder = work / "damage"
    run(folder, "-checkpoint_every", "5", "-ts_max_steps", "5")
    checkpoint = checkpoints(folder)[-1]
    before, refused, sentences = rows(folder), 0, 0
    files = sorted(checkpoint.iterdir())
    for trial in range(FLIPS + CUTS):
        file = choose.choice(files)
        whole = file.read_bytes()
        if trial < FLIPS:
            bit = choose.randrange(8 * len(whole))
            broken = bytearray(whole)
            broken[bit // 8] ^= 1 << bit % 8
        else:
            broken = whole[: choose.randrange(len(whole))]
        file.write_bytes(broken)
        ended = run(folder, "-restart")
        refused += ended.returncode == 2 and rows(folder) == before
        sentences += len(ended.stderr.strip().splitlines()) == 1
        file.write_bytes(whole)
    accepted = run(folder, "-restart", "-ts_max_steps", "6").stdout.count("resumed from")
    print(f"damage: {refused} of {FLIPS} flipped bits and {CUTS} cut files refused, {sentences} in one sentence; "
          f"the whole checkpoint accepted {accepted} of 1 times", flush=True)
    return refused == sentences == FLIPS + CUTS and accepted == 1


def full_disk(work, references):
    """Runs on 1 and 2 ranks by turns on file systems that are too small, then makes them large enough and goes on."""
    disk = work / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk], stderr=subprocess.DEVNULL).returncode:
        print("full disk: SKIPPED, a file system cannot be mounted here (only root may)")
        return True
    resize = lambda size: subprocess.run(["mount", "-o", f"remount,size={size}", disk], check=True)
    refused, went_on, same, finished = 0, 0, 0, 0
    try:
        for trial in range(DISKS):
            shutil.rmtree(disk / "run", ignore_errors=True)
            resize(f"{1200 + 500 * trial}k")
            # Where ranks write together, a full disk must not leave one waiting for the other.
            ranks = 1 + trial % 2
            ended = run(disk / "run", "-checkpoint_every", "3", ranks=ranks, seconds=300)
            if ended.returncode == 0:
                finished += 1
                continue
            told = [line for line in ended.stderr.splitlines() if line.startswith("ssnp155: ")]
            clear = len(told) == 1 and "make room and go on with -restart" in told[0]
            refused += ended.returncode == 2 and clear and not (disk / "run/summary.json").exists()
            resize("200m")
            if checkpoints(disk / "run"):
                went_on += 1
                resumed = run(disk / "run", "-restart", ranks=ranks)
                same += resumed.returncode == 0 and rows(disk / "run") == references[ranks - 1]
    finally:
        subprocess.run(["umount", disk], check=True)
    print(f"full disk: {DISKS} sizes, {finished} large enough, {refused} ended with a sentence and code 2; {went_on} had a checkpoint, "
          f"{same} of them came to the same end with more room", flush=True)
    return refused == DISKS - finished and same == went_on


def main():
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 155
    print(f"seed {seed}")
    choose = random.Random(seed)
    work = Path(tempfile.mkdtemp(prefix="ssnp155-faults-"))
    begin = time.monotonic()
    good = run(work / "unbroken").returncode == 0
    seconds = time.monotonic() - begin
    reference = rows(work / "unbroken")
    good &= run(work / "two", ranks=2).returncode == 0
    two = rows(work / "two")
    good &= interrupted_somewhere(work, "kill -9", signal.SIGKILL, 1, choose, reference, seconds)
    good &= interrupted_somewhere(work, "SIGTERM", signal.SIGTERM, 1, choose, reference, seconds)
    good &= interrupted_somewhere(work, "kill -9 of mpirun, 2 ranks", signal.SIGKILL, 2, choose, two, seconds)
    good &= interrupted_somewhere(work, "SIGUSR1 to mpirun, 2 ranks", signal.SIGUSR1, 2, choose, two, seconds)
    good &= damage(work, choose)
    good &= full_disk(work, [reference, two])
    shutil.rmtree(work)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
