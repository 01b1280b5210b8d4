"""Shapes in the plane of x and z, 1 m deep along y: discs and polygons."""

import math
from typing import Literal

import numpy as np

from quintet.components.shared.geometry.bounds import ORIGIN, Bounds, Corners
from quintet.components.shared.geometry.polygons import Area, area_moments, in_order
from quintet.interfaces.component import Array
from quintet.interfaces.params import Positive, Vector, parameters


@parameters
class Disc:
    """A disc in the plane of x and z, 1 m deep along y.

    Parameters
    ----------
    shape
        Name of the shape.
    centre, radius : m
        Middle, and distance of the surface from it.
    """

    shape: Literal["disc"] = "disc"
    centre: Vector
    radius: Positive

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        (x, y, z), r = self.centre, self.radius
        return (x - r, y - 0.5, z - r), (x + r, y + 0.5, z + r)

    @property
    def share(self) -> float:
        """Part of the box of its bounds that it fills."""
        return 0.25 * math.pi

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return math.pi / 4.0 * (2.0 * self.radius) ** 2

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its centre, at unit density; about all axes that about y."""
        return math.pi / 32.0 * (2.0 * self.radius) ** 4 * np.eye(3)


@parameters
class Polygon:
    """A polygon in the plane of x and z, 1 m deep along y.

    Parameters
    ----------
    shape
        Name of the shape.
    corners : m
        x and z of its corners, in order round it, either way.
    origin : m
        Where the origin of its corners is.
    """

    shape: Literal["polygon"] = "polygon"
    corners: Corners
    origin: Vector = ORIGIN

    @property
    def outline(self) -> Array:
        """Corners (k, 2) m about the origin, from x to z."""
        return in_order(self.corners)

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        (x, y, z), outline = self.origin, self.outline
        (a, c), (b, d) = outline.min(axis=0).tolist(), outline.max(axis=0).tolist()
        return (x + a, y - 0.5, z + c), (x + b, y + 0.5, z + d)

    @property
    def share(self) -> float:
        """Part of the box of its bounds that it fills."""
        return area_moments(self.outline).area / math.prod(np.ptp(self.outline, axis=0).tolist())

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return self._moments.area

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its centre, at unit density; about all axes that about y."""
        return self._moments.moment * np.eye(3)

    @property
    def _moments(self) -> Area:
        outline = self.outline
        return area_moments(outline - area_moments(outline).centre)
