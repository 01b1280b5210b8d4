"""Shapes of bodies: files, agglomerates, unions of spheres, and where they stand."""
