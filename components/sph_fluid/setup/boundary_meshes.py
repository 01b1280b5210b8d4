"""Tanks and obstacles from files: what a scene says of them."""

from typing import Literal, NamedTuple

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.shape_keys import MeshKeys
from quintet.interfaces.params import Number, parameters

Quaternion = tuple[Number, Number, Number, Number]
UNIT = 1e-6  # by which the length of a quaternion may differ from 1


class Filling(NamedTuple):
    """How wall particles are placed behind surfaces."""

    spacing: float  # m
    reach: float  # m, to which depth the fluid feels walls
    offset: float  # spacings from the surface to the first layer
    dry: tuple[tuple[int, float], ...] = ()  # axis and place [m] of each of the tank's walls
    tank: Bounds | None = None  # m
    around: Bounds | None = None  # m, the tank with its wall particles

    @property
    def of_moved(self) -> "Filling":
        """Filling of a mesh that moves: also of what is in the tank's walls at the start."""
        return self._replace(dry=(), tank=None, around=None)


@parameters
class BoundaryMesh(MeshKeys):
    """A surface of triangles that stands still, with wall particles behind it.

    Parameters
    ----------
    file
        STL, OBJ or PLY; a closed one also as voxels in .npy. Named from the scene's folder on.
    surface
        Whether it is closed, as an obstacle, a vessel with walls of its own thickness, or a tank
        with a lid; or open, as a tank without one. A closed one must have no holes.
    fluid_side
        Where the fluid is: in front, the side to which the triangles look, outside a closed
        surface; or behind them, inside a closed one.
    orientation : 1
        Unit quaternion w, x, y, z, by which the surface is turned about the origin of the file.
    """

    surface: Literal["closed", "open"] = "closed"
    fluid_side: Literal["front", "back"] = "front"
    orientation: Quaternion = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.file is None:
            raise ValueError("boundary.meshes: a mesh needs its file; found none. Add file.")
        length = sum(x * x for x in self.orientation) ** 0.5
        if abs(length - 1.0) > UNIT:
            raise ValueError(
                f"boundary.meshes.orientation must be of length 1; found {length:g}. Divide it by "
                "its length."
            )

    @property
    def path(self) -> str:
        """Path of the file."""
        return self.file or ""

    @property
    def is_solid(self) -> bool:
        """Whether wall particles fill the inside of a closed surface."""
        return self.surface == "closed" and self.fluid_side == "front"
