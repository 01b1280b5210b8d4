"""Other programs on the shock tube: their inputs."""
