"""Meshes of structures: boxes, cylinders, outer faces, and which elements meet at nodes."""
