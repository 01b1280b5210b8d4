"""Water comes to rest on an elastic plate: scene, exact by the theory of plates."""
