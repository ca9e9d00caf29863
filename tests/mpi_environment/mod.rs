//! What scripts/environment.sh sets, for tests that start mpirun themselves: more ranks than cores, and as root.

/// Variables and values. Open MPI 5 reads the names that begin with PRTE, older versions the others.
pub const FEW_CORES: [(&str, &str); 12] = [
    ("OPENBLAS_NUM_THREADS", "1"),
    ("OMP_NUM_THREADS", "1"),
    ("OMPI_MCA_hwloc_base_binding_policy", "none"),
    ("PRTE_MCA_hwloc_default_binding_policy", "none"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"),
    ("OMPI_MCA_orte_execute_quiet", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
    ("OMPI_MCA_btl_vader_single_copy_mechanism", "none"),
    ("OMPI_MCA_smsc", "^cma"),
    // All ranks are here; Open MPI 5 complains of networks it will not use.
    ("OMPI_MCA_btl", "^tcp"),
];
