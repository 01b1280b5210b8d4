"""A cube floats: scene, exact by Archimedes and by linear theory of small waves."""
