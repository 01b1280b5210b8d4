"""Friction and heat conduction; imported only where a scene's gas has viscosity."""
