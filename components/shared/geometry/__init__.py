"""Shapes of bodies: what a scene says of them, what they enclose, their lattices and surfaces."""
