# Sourced by the other scripts: how Open MPI and BLAS behave on small machines and in containers. Open MPI 5 has handed
# the start of the ranks to PRRTE, whose settings have names of their own; each version ignores the other's, and so does
# MPICH.

# One thread per rank; the ranks are the parallelism.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
# Jobs side by side would otherwise all be pinned to the first core.
export OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_hwloc_default_binding_policy=none
# More ranks than cores are slow but correct: ranks that wait then yield their core, Open MPI sees to that itself. It is
# not asked to where there are cores enough (mpi_yield_when_idle): MUMPS looks for messages at every block of its fronts,
# on one rank as well, and each look would yield the core of a rank that works.
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
# What a rank says is enough where one fails; Open MPI 5 adds a paragraph of its own all the same.
export OMPI_MCA_orte_execute_quiet=1
# Containers often run as root, and without the rights for single-copy messages.
if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    export PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_smsc=^cma
