"""A dam break meets three stacked cubes: scene and experiment."""
