"""A hull from an STL file floats in waves of a piston: scene, and its response by linear theory."""
