"""A hull from an STL file floats: scene, exact by Archimedes for its triangles."""
