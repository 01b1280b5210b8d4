"""A column of spheres collapses: run-out, between sand and glass beads."""
