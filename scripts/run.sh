#!/usr/bin/env bash
# Installs what is missing, builds, and runs a case: the benchmark on 2 ranks unless told otherwise.
#   scripts/run.sh [-n RANKS] [OPTION ...]     options go to ssnp155
set -euo pipefail
cd "$(dirname "$0")/.."

ranks=2
if [ "${1:-}" = "-n" ]; then
    ranks=$2
    shift 2
fi
[ $# -gt 0 ] || set -- -options_file inputs/ssnp155.opts

bash scripts/install.sh
source scripts/environment.sh
echo "build: cargo build --release"
cargo build --release --locked
echo "run: mpirun -n $ranks ssnp155 $*"
exec mpirun -n "$ranks" "${CARGO_TARGET_DIR:-target}/release/ssnp155" "$@"
