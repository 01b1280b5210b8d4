"""Other programs on the impacts of spheres: their inputs."""
