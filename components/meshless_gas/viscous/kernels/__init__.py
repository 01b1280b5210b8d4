"""Loops over nodes of a gas with friction."""
