"""Other programs on the dam break: their inputs."""
