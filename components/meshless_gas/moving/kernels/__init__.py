"""Loops over the nodes of bodies' clouds."""
