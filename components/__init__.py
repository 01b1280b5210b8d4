"""Solvers: one folder per kind, all of the same inner shape."""
