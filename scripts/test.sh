#!/usr/bin/env bash
# Installs what is missing, builds, runs the benchmark, then all tests and checks.
set -euo pipefail
cd "$(dirname "$0")/.."

# What checks formatting and lints is in packages of its own where Rust is Debian's.
rust=$(command -v cargo || echo /usr/bin/cargo)
[ "$rust" = /usr/bin/cargo ] && lints=(rustfmt rust-clippy) || lints=()
bash scripts/install.sh python3 python3-venv chromium chromium-driver "${lints[@]}"
source scripts/environment.sh

echo "test: formatting, lints, documentation"
cargo fmt --all --check
# What Clippy thinks changes with its version: an older one warns of things that it has since taken back.
minor=$(rustc --version | cut -d. -f2)
[ "$minor" -ge 90 ] && deny=(-D warnings) || deny=()
cargo clippy --workspace --all-targets --locked -- "${deny[@]}"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

echo "test: the benchmark on 2 ranks"
bash scripts/run.sh

echo "test: the fields, read back by VTK"
[ -x .venv/bin/python ] || python3 -m venv .venv
.venv/bin/python -c 'import matplotlib, scipy, selenium, vtk' 2>/dev/null || .venv/bin/pip install --quiet --requirement scripts/requirements.txt
.venv/bin/python scripts/read_fields.py results

echo "test: the report in a browser: of this run, of one that fails, is interrupted, is resumed, and of two side by side"
# A run of the program that has to end with this code.
ends_with() {
    local wanted=$1 code=0
    shift
    "${CARGO_TARGET_DIR:-target}/release/ssnp155" "$@" >/dev/null || code=$?
    [ "$code" -eq "$wanted" ] || { echo "test: code $code and not $wanted: ssnp155 $*" >&2; exit 1; }
}
.venv/bin/python -B scripts/check_report.py --self-test
.venv/bin/python scripts/check_report.py results
ends_with 1 -sheet_nx 40 -sheet_ny 2 -newton_max_iterations 3 -dt_min 0.1 -overwrite -output_dir results/failed
.venv/bin/python scripts/check_report.py results/failed
ends_with 3 -friction_coefficient 0.1342 -sheet_nx 85 -sheet_ny 3 -dt_initial 0.5 -dt_max 0.5 -wall_limit 5 \
    -overwrite -output_dir results/interrupted
.venv/bin/python scripts/check_report.py results/interrupted
short=(-friction_coefficient 0.1342 -sheet_nx 40 -sheet_ny 2 -stroke 8 -time_load 252 -unload_fraction 0.1 -time_unload 25
    -dt_max 1 -report_strokes 4 -output_dir results/resumed)
ends_with 3 "${short[@]}" -wall_limit 1 -overwrite
ends_with 0 "${short[@]}" -restart newest
.venv/bin/python scripts/check_report.py results/resumed
ends_with 0 -compare results,results/failed -output_dir results/compared
.venv/bin/python scripts/check_report.py results/compared

echo "test: samples of studies, against closed values"
.venv/bin/python -B scripts/check_studies.py results/check-studies

echo "test: cargo test"
cargo test --workspace --release --locked
