"""Shapes of bodies and regions, as scenes describe them: one spelling in all solvers.

A table of a scene that has a shape derives from classes of `shape_keys`, and finds one of these:

    { shape = "box", lowest = [0.0, 0.0, 0.0], highest = [1.0, 1.0, 0.5] }
    { shape = "sphere", centre = [0.0, 0.0, 0.1], radius = 0.05 }
    { shape = "cylinder", base = [0.0, 0.0, 0.0], top = [0.0, 0.0, 0.2], radius = 0.05 }
    { shape = "disc", centre = [0.1, 0.0, 0.1], radius = 0.05 }
    { shape = "polygon", corners = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }
    { shape = "mesh", file = "part.stl", scale = 0.001 }
"""

import math
from decimal import Decimal
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

import numpy as np

from quintet.components.shared.geometry.bounds import ORIGIN, Bounds, Mask
from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.interfaces.component import Array
from quintet.interfaces.params import Positive, Vector, parameters

if TYPE_CHECKING:
    from quintet.components.shared.geometry.mesh_files import Solid

ROUNDING = 1e-9  # of a cylinder's length: how far its axis may lean


@parameters
class Box:
    """A box along the axes.

    Parameters
    ----------
    shape
        Name of the shape.
    lowest, highest : m
        Its corners.
    """

    shape: Literal["box"] = "box"
    lowest: Vector
    highest: Vector

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        return self.lowest, self.highest

    @property
    def share(self) -> float:
        """Part of the box of its bounds that it fills."""
        return 1.0

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return math.prod(self.size)

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its middle, at unit density."""
        squares = np.array(self.size) ** 2
        inertia: Array = (np.eye(3) * squares.sum() - np.diag(squares)) / 12.0 * self.volume
        return inertia

    @property
    def size(self) -> Vector:
        """Edges [m], as the decimal numbers of the corners give them."""
        x, y, z = map(_difference, self.highest, self.lowest)
        return x, y, z

    @property
    def centre(self) -> Vector:
        """Its middle [m], as the decimal numbers of the corners give it."""
        x, y, z = map(_middle, self.highest, self.lowest)
        return x, y, z

    def contains(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether places [m] are inside."""
        pairs = zip((x, y, z), self.lowest, self.highest, strict=True)
        a, b, c = ((low < place) & (place < high) for place, low, high in pairs)
        return a & b & c


@parameters
class Sphere:
    """A sphere.

    Parameters
    ----------
    shape
        Name of the shape.
    centre, radius : m
        Middle, and distance of the surface from it.
    """

    shape: Literal["sphere"] = "sphere"
    centre: Vector
    radius: Positive

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        (x, y, z), r = self.centre, self.radius
        return (x - r, y - r, z - r), (x + r, y + r, z + r)

    @property
    def share(self) -> float:
        """Part of the box of its bounds that it fills."""
        return math.pi / 6.0

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return math.pi / 6.0 * (2.0 * self.radius) ** 3

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its middle, at unit density."""
        return np.eye(3) * self.volume * (2.0 * self.radius) ** 2 / 10.0

    def contains(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether places [m] are inside."""
        a, b, c = self.centre
        return np.asarray((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2 < self.radius**2)


@parameters
class Cylinder:
    """A cylinder along an axis of the world; a tube, where it has an inner radius.

    Parameters
    ----------
    shape
        Name of the shape.
    base, top : m
        Centres of its ends.
    radius : m
        Outer one of a tube.
    inner_radius : m
        Of a tube.
    """

    shape: Literal["cylinder"] = "cylinder"
    base: Vector
    top: Vector
    radius: Positive
    inner_radius: Positive | None = None

    def __post_init__(self) -> None:
        lengths = [b - a for a, b in zip(self.base, self.top, strict=True)]
        along = [
            axis for axis in range(3) if abs(lengths[axis]) > ROUNDING * max(map(abs, lengths))
        ]
        if len(along) != 1 or lengths[along[0]] < 0.0:
            raise ValueError(
                "a cylinder must go from its base up to its top along x, y or z; found "
                f"{self.base} and {self.top} m. Correct them."
            )
        if self.inner_radius is not None and self.inner_radius >= self.radius:
            raise ValueError(
                "inner_radius of a cylinder must be below its radius; found "
                f"{self.inner_radius:g} and {self.radius:g} m. Correct it."
            )

    @property
    def axis(self) -> int:
        """Number of the axis that it is along."""
        return max(range(3), key=lambda axis: self.top[axis] - self.base[axis])

    @property
    def length(self) -> float:
        """From end to end [m]."""
        return self.top[self.axis] - self.base[self.axis]

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        low, high = [x - self.radius for x in self.base], [x + self.radius for x in self.base]
        low[self.axis], high[self.axis] = self.base[self.axis], self.top[self.axis]
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    @property
    def share(self) -> float:
        """Part of the box of its bounds that it fills."""
        hollow = 0.0 if self.inner_radius is None else (self.inner_radius / self.radius) ** 2
        return 0.25 * math.pi * (1.0 - hollow)

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return self.share * (2.0 * self.radius) ** 2 * self.length

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its middle, at unit density."""
        squares = self.radius**2 + (self.inner_radius or 0.0) ** 2
        across = (3.0 * squares + self.length**2) / 12.0
        moments = np.where(np.arange(3) == self.axis, 0.5 * squares, across)
        return np.diag(self.volume * moments)

    def contains(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether places [m] are inside."""
        places, k = (x, y, z), self.axis
        first, second = (axis for axis in range(3) if axis != k)
        aside2 = (places[first] - self.base[first]) ** 2 + (places[second] - self.base[second]) ** 2
        within = (self.base[k] < places[k]) & (places[k] < self.top[k])
        return within & (aside2 < self.radius**2) & (aside2 >= (self.inner_radius or 0.0) ** 2)


@parameters
class Mesh:
    """A closed surface in a file.

    Parameters
    ----------
    shape
        Name of the shape.
    file
        STL, OBJ, PLY, or voxels as .npy; named from the scene's folder on.
    scale : m
        What one unit of length in the file, or one voxel, stands for.
    origin : m
        Where the origin of the file is.
    """

    shape: Literal["mesh"] = "mesh"
    file: str
    scale: Positive = 1.0
    origin: Vector = ORIGIN

    @property
    def solid(self) -> "Solid":
        """The surface about the file's origin, and what it encloses."""
        return read_solid(self.file, self.scale)

    @property
    def triangles(self) -> Array:
        """Triangles (t, 3, 3) m of the surface where it is."""
        return self.solid.triangles + np.array(self.origin)

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        triangles = self.triangles
        low, high = triangles.min(axis=(0, 1)).tolist(), triangles.max(axis=(0, 1)).tolist()
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return self.solid.volume

    @property
    def inertia(self) -> Array:
        """Inertia (3, 3) m5 about its centre of mass, at unit density."""
        return self.solid.inertia

    def contains(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether places [m] are inside."""
        # Scenes without meshes do not import the reader of meshes.
        from quintet.components.shared.geometry.mesh_files import inside

        places = np.broadcast_arrays(x, y, z)
        points = np.stack([place.ravel() for place in places], axis=1)
        return inside(points, self.triangles).reshape(places[0].shape)


Shape = Box | Sphere | Cylinder | Disc | Polygon | Mesh


@lru_cache(maxsize=16)
def read_solid(file: str, scale: float) -> "Solid":
    """Read a closed surface once, whoever needs it; see `mesh_files.read`."""
    # As above.
    from quintet.components.shared.geometry.mesh_files import read

    return read(file, scale)


def _difference(high: float, low: float) -> float:
    """Difference as of decimal numbers: 5.35 - 5.2 is 0.15."""
    return float(Decimal(repr(high)) - Decimal(repr(low)))


def _middle(high: float, low: float) -> float:
    """Middle as of decimal numbers: that of 5.2 and 5.35 is 5.275."""
    return float((Decimal(repr(high)) + Decimal(repr(low))) / 2)
