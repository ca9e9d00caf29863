#!/usr/bin/env bash
# Installs the Debian packages the build and the run need, if any are missing: Debian's Rust among them where there is no
# other and the packaged one is new enough. Safe to run again.
#   scripts/install.sh [PACKAGE ...]     with further packages
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
    gcc libc6-dev ca-certificates pkg-config       # toolchain
    clang libclang-dev                             # bindgen reads PETSc's headers with it
    libpetsc-real-dev                              # PETSc, and MUMPS with it
    libmetis-dev libhdf5-openmpi-dev               # partition, fields
    libopenmpi-dev openmpi-bin                     # messages
    libopenblas0-serial                            # MUMPS lives on BLAS: the default one is slow
    "$@"
)

# Ends unless the packaged Rust is what Cargo.toml asks for.
check_packaged_rust() {
    local needed packaged
    needed=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
    packaged=$(LC_ALL=C apt-cache policy rustc | sed -n 's/^ *Candidate: //p')
    dpkg --compare-versions "$packaged" ge "$needed" || {
        echo "install: no cargo is on the PATH, and the packaged Rust is $packaged; install Rust $needed or later" >&2
        exit 1
    }
}

command -v cargo >/dev/null || packages+=(cargo rustc)

missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "install: every package is there"
    exit
fi

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
[[ " ${missing[*]} " != *" rustc "* ]] || check_packaged_rust
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
