"""Numerics that several solvers use."""
