"""A sphere that flies, one that stands in a stream, and what lies between."""
