"""The coupler: reads a scene, starts components, carries fields between them, keeps the books."""
