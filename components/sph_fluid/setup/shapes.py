"""Fluid in other shapes than boxes: spheres, cylinders, prisms, and what a file holds."""

import math
from typing import Annotated, Literal

from pydantic import Field

from quintet.components.sph_fluid.setup.geometry import Axis, Box, Spot
from quintet.interfaces.params import DataFile, Number, Positive, Vector, parameters

ACROSS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}  # the two axes across one
NEEDS = {
    "sphere": ("centre", "diameter"),
    "cylinder": ("centre", "diameter", "height"),
    "prism": ("corners", "ends"),
    "mesh": ("file",),
}
OWN = sorted({name for names in NEEDS.values() for name in names})


@parameters
class FluidShape:
    """A body of fluid that is no box.

    Parameters
    ----------
    shape
        In two dimensions a cylinder or prism along y.
    centre : m
        Of a sphere or cylinder.
    diameter : m
        Of a sphere or cylinder.
    height : m
        Of a cylinder, along its axis.
    axis
        Of a cylinder or prism.
    corners : m
        Corners of a prism's polygon in order round it, on the two axes across: x and y of a prism
        along z, x and z along y, y and z along x. It need not be convex.
    ends : m
        Lower and upper end of a prism along its axis.
    file
        Closed surface of a mesh (STL, OBJ, PLY), beside the scene.
    scale : m
        What a unit of length in the file stands for.
    position : m
        Where the file's origin is.
    hydrostatic
        Whether it starts under the pressure of fluid at rest below its highest point; what falls
        freely does not.
    """

    shape: Literal["sphere", "cylinder", "prism", "mesh"]
    centre: Vector | None = None
    diameter: Positive | None = None
    height: Positive | None = None
    axis: Axis = "z"
    corners: Annotated[tuple[Spot, ...], Field(min_length=3, max_length=1000)] | None = None
    ends: tuple[Number, Number] | None = None
    file: DataFile | None = None
    scale: Positive = 1.0
    position: Vector = (0.0, 0.0, 0.0)
    hydrostatic: bool = True

    def __post_init__(self) -> None:
        """Check that all is said that the shape needs, and nothing else."""
        needed = NEEDS[self.shape]
        said = [name for name in OWN if getattr(self, name) is not None]
        if sorted(needed) != said:
            raise ValueError(
                f"shapes: a {self.shape} needs {' and '.join(needed)}; found "
                f"{', '.join(said) or 'none of them'}. Correct it."
            )
        if self.ends is not None and self.ends[0] >= self.ends[1]:
            raise ValueError(
                f"shapes: ends must be the lower and the upper end; found {self.ends} m. Exchange "
                "them."
            )
        if self.corners is not None:
            # Polygons are left out of scenes that have none.
            from quintet.components.sph_fluid.setup.prisms import require_simple

            require_simple(self.corners)

    @property
    def box(self) -> Box:
        """Lowest and highest corner [m] of what it reaches over."""
        if self.shape == "mesh":
            return _mesh(self).box
        low, high = [0.0] * 3, [0.0] * 3
        k, across = "xyz".index(self.axis), ACROSS[self.axis]
        if self.corners is not None and self.ends is not None:
            low[k], high[k] = self.ends
            for axis, places in zip(across, zip(*self.corners, strict=True), strict=True):
                low[axis], high[axis] = min(places), max(places)
        elif self.centre is not None and self.diameter is not None:
            half = [0.5 * self.diameter] * 3
            half[k] = 0.5 * (self.height or self.diameter)
            low = [c - one for c, one in zip(self.centre, half, strict=True)]
            high = [c + one for c, one in zip(self.centre, half, strict=True)]
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        if self.shape == "mesh":
            return _mesh(self).volume
        if self.corners is not None and self.ends is not None:
            pairs = zip(self.corners, (*self.corners[1:], self.corners[0]), strict=True)
            area = 0.5 * sum(a * d - b * c for (a, b), (c, d) in pairs)
            return abs(area) * (self.ends[1] - self.ends[0])
        diameter = self.diameter or 0.0
        if self.shape == "sphere":
            return math.pi / 6.0 * diameter**3
        return 0.25 * math.pi * diameter**2 * (self.height or 0.0)


def _mesh(shape: FluidShape):  # type: ignore[no-untyped-def]
    # The reader of meshes is left out of scenes without any.
    from quintet.components.sph_fluid.setup.mesh_shapes import read_mesh

    return read_mesh(shape.file, shape.scale, shape.position)
