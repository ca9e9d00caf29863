#!/usr/bin/env bash
# Runs the benchmark on 1, 2, 3 and 4 ranks and compares force and angle at three strokes.
#   scripts/compare_ranks.sh [OPTION ...]     options go to ssnp155
# Exit code 0 if all forces agree within 1e-8 (relative) and all angles within 1e-6 degrees of those of one rank.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/environment.sh

cargo build --release --locked
program=${CARGO_TARGET_DIR:-target}/release/ssnp155
for ranks in 1 2 3 4; do
    echo "compare: $ranks rank(s)"
    mkdir -p "results/ranks-$ranks"
    mpirun -n "$ranks" "$program" "$@" -report_strokes 5,10,15 -output_every 0 \
        -output_dir "results/ranks-$ranks" >"results/ranks-$ranks/run.log" || echo "compare: $ranks rank(s) ended with code $?"
done

python3 - <<'PYTHON'
import csv, json, sys

def rows(ranks):
    with open(f"results/ranks-{ranks}/history.csv") as file:
        return {round(float(row["stroke_mm"]), 6): row for row in csv.DictReader(file) if float(row["t_ms"]) <= 900}

first, agree = rows(1), True
print(f"{'ranks':>5} {'d mm':>5} {'force N':>14} {'relative':>9} {'angle deg':>12} {'difference':>10}")
for ranks in (1, 2, 3, 4):
    mine = rows(ranks)
    for stroke in (5.0, 10.0, 15.0):
        force, angle = (float(mine[stroke][name]) for name in ("force_N", "angle_deg"))
        reference, reference_angle = (float(first[stroke][name]) for name in ("force_N", "angle_deg"))
        by_force, by_angle = abs(force / reference - 1), abs(angle - reference_angle)
        agree = agree and by_force < 1e-8 and by_angle < 1e-6
        print(f"{ranks:5} {stroke:5g} {force:14.8f} {by_force:9.1e} {angle:12.8f} {by_angle:10.1e}")
    summary = json.load(open(f"results/ranks-{ranks}/summary.json"))
    counts, timing = summary["counts"], summary["timing"]
    print(f"      {summary['status']}: {counts['steps']} steps, {counts['newton_iterations']} iterations, "
          f"{counts['refused_solves']} refused, {timing['cpu_s']:.1f} s of processors, {timing['wall_s']:.1f} s")
print("all agree" if agree else "they DIFFER")
sys.exit(0 if agree else 1)
PYTHON
