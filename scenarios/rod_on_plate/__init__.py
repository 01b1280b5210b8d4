"""A wave passes from finite elements to particles that are glued to them, and back: scene."""
