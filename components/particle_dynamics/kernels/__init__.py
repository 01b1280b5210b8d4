"""Loops over points and pairs, compiled."""
