#!/usr/bin/env bash
# Fuzzes the readers of options and hardening tables with libFuzzer, by the stable compiler's own coverage pass.
#   fuzz/run.sh TARGET [SECONDS]     TARGET: options or hardening; needs clang++
set -euo pipefail
cd "$(dirname "$0")"
export CXX=clang++
export RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
# A target of its own: otherwise the flags would also reach build scripts, which have no coverage runtime.
host=$(rustc -vV | sed -n 's/^host: //p')
cargo build --release --target "$host" --bin "$1"
mkdir -p "corpus/$1"
[ "$1" = options ] && cp ../inputs/*.opts corpus/options/
[ "$1" = hardening ] && cp ../inputs/reference/hardening.csv corpus/hardening/
exec "${CARGO_TARGET_DIR:-target}/$host/release/$1" -max_total_time="${2:-60}" -max_len=2000 -print_final_stats=1 "corpus/$1"
