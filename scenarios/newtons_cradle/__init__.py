"""Spheres on springs that strike in a row."""
