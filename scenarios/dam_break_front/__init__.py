"""The front of a dam break: scene and two experiments."""
