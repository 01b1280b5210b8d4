"""Other programs on the settling packing: their inputs."""
