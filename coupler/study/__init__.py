"""Runs of many: convergence studies and stability limits."""
