"""A sphere in a supersonic stream."""
