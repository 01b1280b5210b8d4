"""Spheres settle in a box: weight, packing fraction, rest."""
