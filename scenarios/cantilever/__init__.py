"""A cantilever of tetrahedra from a file of Gmsh swings: scene, exact by Timoshenko."""
