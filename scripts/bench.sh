#!/usr/bin/env bash
# Measures every figure of docs/performance.md, prints the tables and compares them with those committed in
# docs/performance.json, by counts and ratios.
#   scripts/bench.sh [SECTION ...]     benchmark growth whole large ranks kernels; all of them by default (an hour)
#                                      each time is the least of three
#   UPDATE=1 scripts/bench.sh          writes the tables into docs/performance.md and the figures into docs/performance.json
# Exit code 0 if no count and no ratio is more than 10 % worse than the committed one. Wants an idle machine.
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/install.sh python3
source scripts/environment.sh
cargo build --release --locked
exec python3 scripts/bench.py "$@"
