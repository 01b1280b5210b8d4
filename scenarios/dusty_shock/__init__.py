"""A shock in a dusty gas: scene, and the exact relaxation behind it."""
