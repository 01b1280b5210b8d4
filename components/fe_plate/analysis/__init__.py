"""Stability of the scheme: the fastest mode of a structure as it stands."""
