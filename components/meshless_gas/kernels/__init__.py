"""Loops over nodes: gradients, residuals, boundaries, steps in time."""
