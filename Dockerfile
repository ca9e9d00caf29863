# ssnp155 in two stages: built with Rust, run on plain Debian.
#   docker build -t ssnp155 .
#   docker run --rm -v "$PWD/results:/case/results" ssnp155
FROM docker.io/library/rust:1.95-bookworm AS build
# A certificate bundle for cargo, where the builder's network needs its own; empty otherwise.
ARG CARGO_HTTP_CAINFO
RUN apt-get update && apt-get install -y --no-install-recommends \
        clang libclang-dev pkg-config libpetsc-real-dev libmetis-dev libhdf5-openmpi-dev \
        libopenmpi-dev libopenblas0-serial \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY . .
RUN cargo build --release --locked

FROM docker.io/library/debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
        libpetsc-real3.18 libmetis5 libhdf5-openmpi-103-1 openmpi-bin libopenblas0-serial \
    && rm -rf /var/lib/apt/lists/* \
    && useradd solver && mkdir /case && chown solver /case
COPY --from=build /source/target/release/ssnp155 /usr/local/bin/ssnp155
COPY inputs /usr/local/share/ssnp155/inputs
# One thread per rank; containers have neither fixed cores nor the rights for single-copy messages.
ENV OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 \
    OMPI_MCA_hwloc_base_binding_policy=none \
    OMPI_MCA_rmaps_base_oversubscribe=1 \
    OMPI_MCA_btl_vader_single_copy_mechanism=none
USER solver
WORKDIR /case
CMD ["mpirun", "-n", "2", "ssnp155", "-options_file", "/usr/local/share/ssnp155/inputs/ssnp155.opts"]
