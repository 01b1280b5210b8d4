"""A dam break meets a fixed box: scene and experiment."""
