"""A steel bar strikes a rigid wall: scene, against published computations."""
