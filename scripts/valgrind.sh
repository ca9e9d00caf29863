#!/usr/bin/env bash
# Runs the tests of the PETSc wrapper and a small case under valgrind's memcheck on one rank.
#   scripts/valgrind.sh
# Exit code 0 if there is no invalid access, no use of a value that was never set, and no lost memory but that of the
# libraries below, which scripts/valgrind.supp and Open MPI's own list name. About 10 minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/install.sh valgrind
source scripts/environment.sh
# Memcheck knows AVX2, but not the newest instructions that OpenBLAS would choose.
export OPENBLAS_CORETYPE=Haswell

check() {
    echo "valgrind: $*"
    valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite \
        --num-callers=40 --gen-suppressions="${GEN_SUPPRESSIONS:-no}" --suppressions=scripts/valgrind.supp \
        --suppressions=/usr/share/openmpi/openmpi-valgrind.supp "$@" >/dev/null
}

# Where cargo put the test programs.
mapfile -t tests < <(cargo test --package petsc --release --locked --no-run --message-format=json |
    python3 -c '
import json, sys
for line in sys.stdin:
    found = json.loads(line)
    if found.get("executable") and found.get("profile", {}).get("test"):
        print(found["executable"])')
[ ${#tests[@]} -ge 4 ] || {
    echo "valgrind: only ${#tests[@]} test programs" >&2
    exit 1
}
cargo build --release --locked
for test in "${tests[@]}"; do
    check "$test"
done

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
small=(-sheet_nx 20 -sheet_ny 1 -stroke 0.1 -time_load 4 -time_unload 2 -output_dir "$results")
program=${CARGO_TARGET_DIR:-target}/release/ssnp155
check "$program" "${small[@]}"
check "$program" "${small[@]}" -friction_coefficient 0.1342
check "$program" "${small[@]}" -dynamics none -options_file inputs/band.opts
echo "valgrind: clean"
