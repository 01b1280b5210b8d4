"""Advancing bodies in time: rotation, sums over blocks of rows, the limit of the step."""
