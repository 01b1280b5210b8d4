"""Other programs on the problem of a scene: their error and CPU time, in the scene's measures."""
