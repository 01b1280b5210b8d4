"""Friction on a slope and a floor: rest, slide and roll."""
