"""A standing wave that fades: scene, exact by linear theory."""
