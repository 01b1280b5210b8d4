"""Supersonic flow over a wedge."""
