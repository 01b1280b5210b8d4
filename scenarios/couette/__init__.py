"""Friction heats the gas between two walls."""
