#!/usr/bin/env bash
# Builds, tests and runs the benchmark on several platforms, each in a bare root of its own, and prints one table.
#   scripts/platforms.sh [here] [bookworm] [trixie] [newest] [mpich] [3.19] ...     bookworm to mpich unless named
#   here               this machine as it is
#   bookworm, trixie   Debian 12 and 13 with their packages
#   newest             the newest PETSc 3.26 from its source package (PyPI), without MUMPS, in the root of trixie
#   mpich              the same built with MPICH, in a Debian 13 of its own
#   3.19 to 3.26       that PETSc from its source package, without MUMPS, in the root of bookworm
# Needs root, debootstrap, a Rust toolchain and pip. From the environment:
#   PLATFORM_ROOTS     where the roots are and stay, 4 GB each: target/platforms unless given
#   CARGO_PROFILE_...  as cargo takes them; CARGO_PROFILE_RELEASE_LTO=off builds sooner
#   PLATFORM_MIRROR    Debian's mirror; the first one of this machine unless given
# Each root takes some minutes the first time. Results: results-platforms/NAME/, and the table of docs/platforms.md.
set -euo pipefail
cd "$(dirname "$0")/.."

[ $# -gt 0 ] || set -- bookworm trixie newest mpich
project=$PWD
mkdir -p "${PLATFORM_ROOTS:=target/platforms}"
roots=$(cd "$PLATFORM_ROOTS" && pwd)
mirror=${PLATFORM_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' | head -n 1)}
newest=3.26
results=$project/results-platforms
mkdir -p "$results"

# Runs a script, given on the standard input, in a root: the project at /source, the toolchain where it is outside.
# What is mounted is seen by this command alone, and goes with it. What the script starts reads nothing, or mpirun would
# swallow the rest of it.
inside() {
    local root=$roots/$1 script
    script=$(cat)
    shift
    if [ "$root" = "$roots/here" ]; then
        env PROJECT="$project" "$@" bash -euo pipefail -c "$script" </dev/null
        return
    fi
    mkdir -p "$root/source" "$root/opt/cargo" "$root/opt/rustup"
    unshare --mount bash -c '
        set -e
        root=$1 project=$2 script=$3
        shift 3
        for place in proc sys dev; do mount --rbind "/$place" "$root/$place"; done
        mount --bind "${CARGO_HOME:-$HOME/.cargo}" "$root/opt/cargo"
        mount --bind "${RUSTUP_HOME:-$HOME/.rustup}" "$root/opt/rustup"
        mount --bind "$project" "$root/source"
        exec chroot "$root" env -i HOME=/root LC_ALL=C.UTF-8 \
            CARGO_HOME=/opt/cargo RUSTUP_HOME=/opt/rustup \
            PATH=/opt/cargo/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
            $(env | grep "^CARGO_PROFILE_") \
            RUSTUP_TOOLCHAIN="${RUSTUP_TOOLCHAIN:-stable}" SSL_CERT_FILE=/etc/ssl/certs/ca-certificates.crt \
            CARGO_HTTP_CAINFO=/etc/ssl/certs/ca-certificates.crt PROJECT=/source "$@" bash -euo pipefail -c "$script"
    ' inside "$root" "$project" "$script" "$@" </dev/null
}

# A bare Debian with what a Rust toolchain needs, once, and what the project installs.
debian() {
    local root=$1 release=$2
    [ -x "$roots/$root/usr/bin/gcc" ] ||
        debootstrap --variant=minbase --include=ca-certificates,gcc,libc6-dev,git "$release" "$roots/$root" "$mirror"
    # The network of this machine: resolver, certificates and settings of apt.
    cp /etc/resolv.conf "$roots/$root/etc/resolv.conf"
    cp /etc/ssl/certs/ca-certificates.crt "$roots/$root/etc/ssl/certs/ca-certificates.crt"
    inside "$root" <<<'cd "$PROJECT" && bash scripts/install.sh'
}

# A release of PETSc, built without MUMPS and without Fortran by the root's mpicc into its /opt/petsc-RELEASE, once.
from_source() {
    local root=$1 release=$2
    [ ! -e "$roots/$root/opt/petsc-$release/lib/libpetsc.so" ] || return 0
    [ -x "$roots/pip/bin/pip" ] || python3 -m venv "$roots/pip"
    "$roots/pip/bin/pip" install --quiet setuptools wheel numpy
    rm -rf "$roots/$root/opt/src"
    "$roots/pip/bin/pip" download --quiet --no-deps --no-build-isolation --no-binary petsc \
        --dest "$roots/$root/opt/src" "petsc==$release.*"
    inside "$root" RELEASE="$release" <<'END'
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends python3 make >/dev/null
cd /opt/src
tar xzf petsc-3.*.tar.gz
cd petsc-3.*/
export PETSC_DIR=$PWD PETSC_ARCH=optimised
python3 ./configure --prefix="/opt/petsc-$RELEASE" --with-cc=mpicc --with-cxx=0 --with-fc=0 --with-debugging=0 --with-x=0 \
    --with-shared-libraries=1 COPTFLAGS=-O2 --with-blaslapack-lib="-llapack -lblas"
make -j"$(nproc)" all
make install
END
}

# MPICH in place of Open MPI, beside which Debian's PETSc stays unused.
mpich() {
    inside "$1" <<'END'
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mpich libmpich-dev libhdf5-mpich-dev >/dev/null
update-alternatives --set mpi /usr/bin/mpicc.mpich
update-alternatives --set mpirun /usr/bin/mpirun.mpich
END
}

# Tests of the wrapper on 1 and 2 ranks, and the benchmark on 1 and 2 ranks.
measure() {
    local name=$1 root=$2
    shift 2
    rm -rf "${results:?}/$name"
    mkdir -p "$results/$name"
    echo "platforms: $name"
    [ "$name" = here ] || set -- CARGO_TARGET_DIR="/build-$name" "$@"
    inside "$root" NAME="$name" "$@" <<'END'
cd "$PROJECT"
results=results-platforms/$NAME
source scripts/environment.sh
{
    rustc --version
    # All of it, or a closed pipe would end this script.
    mpirun --version | sed -n 1,2p
    dpkg-query -W -f='MUMPS ${Version}\n' libmumps-dev
    dpkg-query -W -f='HDF5 ${Version}\n' libhdf5-openmpi-dev
} >"$results/versions.txt"
cargo build --release --locked
cargo build --release --locked -p petsc --tests
for ranks in 1 2; do
    export CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="mpirun -n $ranks"
    cargo test --release --locked -p petsc --tests --no-fail-fast >"$results/tests-$ranks.log" 2>&1 ||
        echo "platforms: tests on $ranks ranks failed, see $results/tests-$ranks.log"
    mpirun -n "$ranks" "${CARGO_TARGET_DIR:-target}/release/ssnp155" -options_file inputs/ssnp155.opts \
        -output_dir "$results/ranks-$ranks" >"$results/run-$ranks.log" 2>&1 ||
        echo "platforms: the benchmark on $ranks ranks ended with code $?"
done
END
}

for name in "$@"; do
    case $name in
    here) measure here here ;;
    bookworm | trixie)
        debian "$name" "$name"
        measure "$name" "$name"
        ;;
    newest)
        debian trixie trixie
        from_source trixie "$newest"
        measure newest trixie PETSC_DIR="/opt/petsc-$newest"
        ;;
    mpich)
        debian trixie-mpich trixie
        mpich trixie-mpich
        from_source trixie-mpich "$newest"
        measure mpich trixie-mpich PETSC_DIR="/opt/petsc-$newest" HDF5_DIR=/usr/lib/x86_64-linux-gnu/hdf5/mpich
        ;;
    3.19 | 3.2[0-6])
        debian bookworm bookworm
        from_source bookworm "$name"
        measure "$name" bookworm PETSC_DIR="/opt/petsc-$name"
        ;;
    *)
        echo "platforms: no platform is called $name; there are here, bookworm, trixie, newest, mpich and 3.19 to 3.26" >&2
        exit 2
        ;;
    esac
done
python3 scripts/platforms.py "$results" "$@"
