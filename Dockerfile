# ssnp155 in two stages: built with Rust, run on plain Debian. docs/using.md says more; scripts/image.sh tests it.
#   docker build -t ssnp155 .
#   mkdir -p results && docker run --rm --user "$(id -u):$(id -g)" -v "$PWD/results:/case/results" ssnp155
#
# The compiler and the release of Debian are pinned by the tags, the crates by Cargo.lock. Debian's packages are pinned
# by the release only: within a stable release they change for security and grave bugs, and an exact version would be
# gone from the archive after such a change. PETSc stays 3.22, MUMPS 5.7, Open MPI 5.0 and HDF5 1.14 with trixie.
FROM docker.io/library/rust:1.95-trixie AS build
# A certificate bundle for cargo, where the builder's network needs its own; empty otherwise.
ARG CARGO_HTTP_CAINFO
RUN apt-get update && apt-get install -y --no-install-recommends \
        clang libclang-dev pkg-config libpetsc-real-dev libmetis-dev libhdf5-openmpi-dev \
        libopenmpi-dev libopenblas0-serial \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY . .
RUN cargo build --release --locked

FROM docker.io/library/debian:trixie-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
        libpetsc-real3.22 libmetis5 libhdf5-openmpi-310 openmpi-bin libopenblas0-serial \
    && rm -rf /var/lib/apt/lists/* \
    && useradd solver && mkdir /case && chown solver /case
COPY --from=build /source/target/release/ssnp155 /usr/local/bin/ssnp155
COPY inputs /usr/local/share/ssnp155/inputs
# As in scripts/environment.sh: one thread per rank, no fixed cores, and no single-copy messages,
# for which containers have no rights. Root is the user outside where the engine runs without root.
ENV OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 \
    PRTE_MCA_hwloc_default_binding_policy=none \
    PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe \
    OMPI_MCA_smsc=^cma \
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1
USER solver
WORKDIR /case
CMD ["mpirun", "-n", "2", "ssnp155", "-options_file", "/usr/local/share/ssnp155/inputs/ssnp155.opts"]
