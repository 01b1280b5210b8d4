"""Waves that end: paddles that absorb them, and damping zones."""
