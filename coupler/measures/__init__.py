"""Quantities that are compared with references: curves, periods, orders of convergence."""
