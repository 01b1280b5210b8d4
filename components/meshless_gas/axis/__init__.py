"""Axis of symmetry of clouds that bodies carry: circles of nodes grow with their radius."""
