"""Stability of the scheme: the step linearised at a solid's state."""
