"""Scenes: one folder per physical case, with its reference and what it must reproduce."""
