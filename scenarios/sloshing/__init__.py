"""Water sloshes in a tank after a push: scene, exact by linear theory."""
