"""Tanks that move: the fluid in the frame of its tank."""
