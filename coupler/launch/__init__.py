"""Launching a run: component processes and MPI jobs, started, watched and ended."""
