#!/usr/bin/env bash
# Installs what is missing, builds, runs the benchmark, then all tests and checks.
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/install.sh python3 python3-venv
source scripts/environment.sh

echo "test: formatting, lints, documentation"
cargo fmt --all --check
cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

echo "test: the benchmark on 2 ranks"
bash scripts/run.sh

echo "test: the fields, read back by VTK"
[ -x .venv/bin/python ] || python3 -m venv .venv
.venv/bin/python -c 'import vtk' 2>/dev/null || .venv/bin/pip install --quiet --requirement scripts/requirements.txt
.venv/bin/python scripts/read_fields.py results

echo "test: cargo test"
cargo test --workspace --release --locked
