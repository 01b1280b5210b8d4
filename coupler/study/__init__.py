"""Series of runs: convergence studies and stability limits."""
