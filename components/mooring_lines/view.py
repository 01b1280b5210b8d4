"""What a picture shows of lines."""

import numpy as np

from quintet.components.mooring_lines.kernels import draw_lines
from quintet.components.mooring_lines.state import Array, Lines
from quintet.interfaces.component import Fields

POINTS = 101  # along a line
THICK = 0.004  # radius over a line's length, with which it is drawn


def view(fairlead: Array, lines: Lines, pull: Array) -> Fields:
    """Points along all lines, as small spheres, with their tension."""
    points = np.zeros((len(fairlead), POINTS, 3))
    tension = np.zeros((len(fairlead), POINTS))
    draw_lines(fairlead, lines, pull.copy(), points, tension)
    radius = np.repeat(THICK * lines.length, POINTS)
    return {"points": points.reshape(-1, 3), "radius": radius, "tension": tension.reshape(-1)}
