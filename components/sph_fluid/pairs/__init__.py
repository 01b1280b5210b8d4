"""Pairs of particles: the numbers of their law, their lists, and passes over them."""
