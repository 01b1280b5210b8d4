"""What a scene says about one body: its shape, its material, how it moves at the start."""

import math
from functools import lru_cache
from typing import Literal

from quintet.components.shared.materials.params import Material, MaterialName
from quintet.interfaces.params import DataFile, Number, Positive, Vector, parameters

Axis = Literal["x", "y", "z"]
NEEDS = {
    "box": ("lowest", "highest"),
    "sphere": ("centre", "diameter"),
    "cylinder": ("centre", "diameter", "height"),
    "tube": ("centre", "diameter", "inner_diameter", "height"),
    "mesh": ("file",),
}
MAY = {"mesh": ("scale", "position")}
OWN = sorted({name for names in (*NEEDS.values(), *MAY.values()) for name in names})
Gradient = tuple[Vector, Vector, Vector]


@parameters
class Body:
    """A body, filled with particles: a lattice of them, or layers of circles in a tube.

    Parameters
    ----------
    shape
        In two dimensions a box, or a cylinder or tube along y: a ring.
    lowest, highest : m
        Corners of a box.
    centre : m
        Of a sphere, cylinder or tube.
    diameter : m
        Of a sphere or cylinder; outer one of a tube.
    inner_diameter : m
        Of a tube.
    height : m
        Of a cylinder or tube, along its axis.
    axis
        Of a cylinder or tube.
    file
        Closed surface of a mesh: STL, OBJ, PLY, or voxels as .npy; named from the scene's folder
        on.
    scale : m
        What one unit of length in the file, or one voxel, stands for; 1 if not given.
    position : m
        Where the file's origin lies; the origin if not given.
    material
        Name of a material of the library, or its table.
    velocity : m/s
        At the start; of the middle of its box if it turns or strains.
    angular_velocity : rad/s
        At the start, about the middle of its box.
    velocity_gradient : 1/s
        At the start: rows of ∂v_a/∂x_b, about the middle of its box, added to the rest.
    """

    shape: Literal["box", "sphere", "cylinder", "tube", "mesh"] = "box"
    lowest: Vector | None = None
    highest: Vector | None = None
    centre: Vector | None = None
    diameter: Positive | None = None
    inner_diameter: Positive | None = None
    height: Positive | None = None
    axis: Axis = "z"
    file: DataFile | None = None
    scale: Positive | None = None
    position: Vector | None = None
    material: MaterialName | Material
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    velocity_gradient: Gradient = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def __post_init__(self) -> None:
        needed, allowed = NEEDS[self.shape], MAY.get(self.shape, ())
        said = [name for name in OWN if getattr(self, name) is not None]
        if sorted(needed) != [name for name in said if name not in allowed]:
            raise ValueError(
                f"bodies: a {self.shape} needs {' and '.join(needed)}; found "
                f"{', '.join(said) or 'none of them'}. Correct it."
            )
        if self.inner_diameter is not None and self.diameter is not None:
            if self.inner_diameter >= self.diameter:
                raise ValueError(
                    "bodies: inner_diameter of a tube must be below its diameter; found "
                    f"{self.inner_diameter:g} and {self.diameter:g} m. Correct it."
                )
        low, high = self.box
        if not all(a < b for a, b in zip(low, high, strict=True)):
            raise ValueError(
                f"bodies: highest must be beyond lowest along every axis; found {low} and {high} m."
            )

    @property
    def box(self) -> tuple[Vector, Vector]:
        """Lowest and highest corner [m] of what it reaches over."""
        if self.file is not None:
            return surface_box(self.file, self.scale or 1.0, self.position or (0.0, 0.0, 0.0))
        if self.lowest is not None and self.highest is not None:
            return self.lowest, self.highest
        assert self.centre is not None and self.diameter is not None
        half = [0.5 * self.diameter] * 3
        if self.height is not None:
            half["xyz".index(self.axis)] = 0.5 * self.height
        (x, y, z), (a, b, c) = self.centre, half
        return (x - a, y - b, z - c), (x + a, y + b, z + c)

    def volume(self, dimensions: int, axisymmetric: bool = False) -> float:
        """Volume [m3]; in two dimensions of a slice 1 m deep, or of what is turned about z."""
        if self.file is not None:
            return surface_volume(self.file, self.scale or 1.0)
        if axisymmetric and self.shape == "box":
            (low, _, bottom), (high, _, top) = self.box
            return math.pi * (high**2 - max(low, 0.0) ** 2) * (top - bottom)
        if axisymmetric:
            dimensions = 3
        edges = [b - a for a, b in zip(*self.box, strict=True)]
        if dimensions == 2:
            edges[1] = 1.0
        share = {"box": 1.0, "sphere": math.pi / 6.0}.get(self.shape, 0.25 * math.pi)
        if self.inner_diameter is not None and self.diameter is not None:
            share *= 1.0 - (self.inner_diameter / self.diameter) ** 2
        return share * math.prod(edges)

    @property
    def motion(self) -> tuple[object, ...]:
        """All of its motion at the start."""
        return self.velocity, self.angular_velocity, self.velocity_gradient


@lru_cache(maxsize=16)
def surface_box(file: str, scale: float, position: Vector) -> tuple[Vector, Vector]:
    """Lowest and highest corner [m] of a surface in a file."""
    # Scenes without meshes do not import the reader of meshes.
    from quintet.components.shared.geometry.mesh_files import read

    triangles = read(file, scale).triangles
    low: list[Number] = (triangles.min(axis=(0, 1)) + position).tolist()
    high: list[Number] = (triangles.max(axis=(0, 1)) + position).tolist()
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


@lru_cache(maxsize=16)
def surface_volume(file: str, scale: float) -> float:
    """Volume [m3] in a surface in a file."""
    # As above.
    from quintet.components.shared.geometry.mesh_files import read

    return read(file, scale).volume
