#!/usr/bin/env bash
# Runs the whole verification suite and writes docs/verification.md with its pictures.
#   scripts/verify.sh [NAME ...]     only the cases whose names hold a NAME; the page stays as it is
set -euo pipefail
cd "$(dirname "$0")/.."

bash scripts/install.sh
source scripts/environment.sh
if [ $# -eq 0 ]; then
    set -- --document
fi
exec cargo test --release --locked --test verification -- "$@"
