"""Contact of particles with the faces of a mesh."""
