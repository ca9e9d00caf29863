#!/usr/bin/env bash
# Installs the Debian packages the build and the run need, if any are missing. Safe to run again.
set -euo pipefail

packages=(
    gcc libc6-dev ca-certificates pkg-config       # toolchain
    clang libclang-dev                             # bindgen reads PETSc's headers with it
    libpetsc-real-dev                              # PETSc, and MUMPS with it
    libmetis-dev libhdf5-openmpi-dev               # partition, fields
    libopenmpi-dev openmpi-bin                     # messages
    libopenblas0-serial                            # MUMPS lives on BLAS: the default one is slow
    "$@"
)

missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done

if [ ${#missing[@]} -eq 0 ]; then
    echo "install: every package is there"
else
    echo "install: ${missing[*]}, and what they need"
    as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "install: packages are missing and neither root nor sudo is at hand" >&2
            exit 1
        }
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

command -v cargo >/dev/null || {
    echo "install: cargo is not on the PATH; a Rust toolchain is needed" >&2
    exit 1
}
