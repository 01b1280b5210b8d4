"""Dust in a stream: scene, and the exact relaxation of both."""
