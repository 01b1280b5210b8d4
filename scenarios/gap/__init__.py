"""Water enters gaps between fixed blocks: scene, exact by hydrostatics."""
