#!/usr/bin/env bash
# Builds the container image, runs its default command (the benchmark on 2 ranks), and compares with a native run.
#   scripts/image.sh
# Takes docker if its engine runs, otherwise buildah. From the environment:
#   IMAGE_BUILD_ARGS   further words for the build, for example --build-arg CARGO_HTTP_CAINFO=...
#   IMAGE_RUN_ARGS     further words for the run
# buildah reads its own variables, too: BUILDAH_ISOLATION=chroot helps where namespaces are not allowed.
# Exit code 0 if both runs ended alike and agree where scripts/compare_runs.py says they must.
set -euo pipefail
cd "$(dirname "$0")/.."

image=ssnp155
results=$PWD/results-image
read -ra build_args <<<"${IMAGE_BUILD_ARGS:-}"
read -ra run_args <<<"${IMAGE_RUN_ARGS:-}"

build() {
    if [ "$engine" = docker ]; then
        docker build "${build_args[@]}" -t "$image" .
    else
        buildah build "${build_args[@]}" -t "$image" .
    fi
}

# Runs the image's default command, with a folder for its results.
run() {
    if [ "$engine" = docker ]; then
        docker run --rm --user "$(id -u):$(id -g)" "${run_args[@]}" -v "$1:/case/results" "$image"
    else
        local container command code=0
        # buildah starts no default command of its own accord.
        mapfile -t command < <(buildah inspect --format '{{range .OCIv1.Config.Cmd}}{{println .}}{{end}}' "$image" | sed '/^$/d')
        container=$(buildah from "$image")
        buildah run --user "$(id -u):$(id -g)" "${run_args[@]}" -v "$1:/case/results" "$container" -- "${command[@]}" ||
            code=$?
        buildah rm "$container" >/dev/null
        return $code
    fi
}

size_bytes() {
    if [ "$engine" = docker ]; then
        docker image inspect --format '{{.Size}}' "$image"
    else
        buildah images --format '{{.Size}}' "$image"
    fi
}

# docker may be there without its engine.
if docker info >/dev/null 2>&1; then
    engine=docker
elif command -v buildah >/dev/null; then
    engine=buildah
else
    echo "image: neither a running docker nor buildah is at hand; start or install one of them" >&2
    exit 1
fi

echo "image: $engine builds $image"
start=$SECONDS
build
echo "image: built in $((SECONDS - start)) s; size $(size_bytes)"

rm -rf "$results"
mkdir -p "$results/image" "$results/native"
echo "image: run in the container"
start=$SECONDS
run "$results/image" >"$results/image.log" || echo "image: the container ended with code $?"
echo "image: ran for $((SECONDS - start)) s"

source scripts/environment.sh
cargo build --release --locked
echo "image: run without it"
mpirun -n 2 "${CARGO_TARGET_DIR:-target}/release/ssnp155" -options_file inputs/ssnp155.opts \
    -output_dir "$results/native" >"$results/native.log" || echo "image: the native run ended with code $?"

exec python3 scripts/compare_runs.py "$results/image" "$results/native"
