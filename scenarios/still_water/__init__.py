"""Water at rest in a tank: scene, exact by hydrostatics."""
