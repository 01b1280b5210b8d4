"""A square floats in two dimensions: scene, exact by Archimedes and by linear theory."""
