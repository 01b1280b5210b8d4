"""Disturbs a run on purpose, at places that a seed chooses."""
