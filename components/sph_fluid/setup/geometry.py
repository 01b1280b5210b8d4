"""Words of a fluid's parameters for places: axes, faces of a tank, cells and levels of boxes."""

import math
from typing import Annotated, Literal, get_args

from pydantic import Field

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import cells_between
from quintet.interfaces.params import Number, Vector

Spot = tuple[Number, Number]  # x and y, m
Axis = Literal["x", "y", "z"]
Face = Literal["x-", "x+", "y-", "y+", "z-", "z+"]
UprightFace = Literal["x-", "x+", "y-", "y+"]
Exponent = Annotated[int, Field(ge=1, le=8)]
Smoothing = Annotated[float, Field(ge=1.0, le=3.0)]

FACES: tuple[Face, ...] = get_args(Face)
ROUNDING = 1e-6  # of a spacing


def cells(box: Bounds, spacing: float, dimensions: int) -> tuple[int, int, int]:
    """Whole number of particles along each edge of a box; one along y in two dimensions."""
    x, y, z = (cells_between(low, high, spacing) for low, high in zip(*box, strict=True))
    return (x, y, z) if dimensions == 3 else (x, 1, z)


def levels(box: Bounds, gravity: Vector) -> tuple[float, float]:
    """Lowest and highest level [m] of a box, measured against gravity [m/s2]."""
    size = math.hypot(*gravity) or 1.0
    pairs = [(-low * g, -high * g) for low, high, g in zip(*box, gravity, strict=True)]
    return sum(map(min, pairs)) / size, sum(map(max, pairs)) / size
