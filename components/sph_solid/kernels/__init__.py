"""Kernels of bodies of particles: sums over pairs, the material of each, motion."""
