"""Spheres that fly under loads of a partner, and bounce."""
