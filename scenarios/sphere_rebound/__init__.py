"""Spheres strike each other and a plane: Chung and Ooi's tests 1, 3 and 4."""
