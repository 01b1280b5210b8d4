"""A slab that is heated through one face: scene, exact temperature of the face."""
