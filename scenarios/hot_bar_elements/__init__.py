"""Arinchev's bar in finite elements, held at points: scene, and how it depends on the mesh."""
