"""Fluid in boxes and in other shapes: spheres, cylinders, prisms, and what a file holds."""

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from quintet.components.shared.geometry import shape_keys
from quintet.components.shared.geometry.bounds import Bounds, Corners, Mask
from quintet.components.shared.geometry.polygons import area, inside_polygon, require_simple
from quintet.components.shared.geometry.shapes import Cylinder, Mesh, Sphere
from quintet.components.sph_fluid.setup.geometry import Axis
from quintet.interfaces.component import Array
from quintet.interfaces.params import Number, parameters

ACROSS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}  # the two axes across one
NEEDS = {
    **{name: shape_keys.NEEDS[name] for name in ("box", "sphere", "cylinder", "mesh")},
    "prism": ("corners", "ends"),
}
MAY = {"mesh": ("scale", "origin")}


@dataclass(frozen=True)
class Prism:
    """A prism along an axis, over a polygon that need not be convex."""

    corners: Corners
    ends: tuple[float, float]
    axis: Axis

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        low, high = [0.0] * 3, [0.0] * 3
        k = "xyz".index(self.axis)
        low[k], high[k] = self.ends
        for axis, places in zip(ACROSS[self.axis], zip(*self.corners, strict=True), strict=True):
            low[axis], high[axis] = min(places), max(places)
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return abs(area(np.array(self.corners))) * (self.ends[1] - self.ends[0])

    def contains(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether places [m] are inside."""
        places = x, y, z
        first, second = (places[axis] for axis in ACROSS[self.axis])
        coordinate = places["xyz".index(self.axis)]
        is_between = (coordinate > self.ends[0]) & (coordinate < self.ends[1])
        return is_between & inside_polygon(first, second, np.array(self.corners))


@parameters
class FluidRegion(
    shape_keys.BoxKeys,
    shape_keys.CylinderKeys,
    shape_keys.TubeKeys,
    shape_keys.RoundKeys,
    shape_keys.MeshKeys,
):
    """A body of fluid.

    Parameters
    ----------
    shape
        In two dimensions a box, or a cylinder or prism along y.
    centre : m
        Of a sphere.
    radius : m
        Of a sphere or cylinder.
    corners : m
        Corners of a prism's polygon in order round it, on the two axes across: x and y of a prism
        along z, x and z along y, y and z along x. It need not be convex.
    axis
        Of a prism.
    ends : m
        Lower and upper end of a prism along its axis.
    hydrostatic
        Whether it starts under the pressure of fluid at rest below its highest point; what falls
        freely does not.
    """

    RENAMED: ClassVar = {
        "diameter": "radius, half of it",
        "height": "base and top",
        "position": "origin",
    }
    shape: Literal["box", "sphere", "cylinder", "prism", "mesh"] = "box"
    corners: Corners | None = None
    axis: Axis = "z"
    ends: tuple[Number, Number] | None = None
    hydrostatic: bool = True

    def __post_init__(self) -> None:
        shape_keys.require_keys(self, "fluid", NEEDS, MAY)
        if self.ends is not None and self.ends[0] >= self.ends[1]:
            raise ValueError(
                f"fluid: ends must be the lower and the upper end; found {self.ends} m. Exchange "
                "them."
            )
        if self.corners is not None:
            require_simple("fluid", self.corners)
        if self.shape not in ("box", "prism"):
            shape_keys.shape_of(self, "fluid")

    @property
    def geometry(self) -> Sphere | Cylinder | Mesh | Prism:
        """Its shape, where that is no box."""
        if self.corners is not None and self.ends is not None:
            return Prism(self.corners, self.ends, self.axis)
        shape = shape_keys.shape_of(self, "fluid")
        assert isinstance(shape, Sphere | Cylinder | Mesh)
        return shape

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m]."""
        if self.lowest is not None and self.highest is not None:
            return self.lowest, self.highest
        return self.geometry.bounds

    @property
    def volume(self) -> float:
        """Volume [m3] of a shape that is no box."""
        shape = self.geometry
        if isinstance(shape, Mesh | Prism):
            return shape.volume
        return shape.share * math.prod(b - a for a, b in zip(*shape.bounds, strict=True))


Fluid = tuple[FluidRegion, ...]


def named_boxes(fluid: Fluid) -> list[tuple[str, Bounds]]:
    """Boxes of fluid by their names in a scene."""
    named = enumerate(fluid)
    return [(f"fluid[{k}]", region.bounds) for k, region in named if region.shape == "box"]


def named_shapes(fluid: Fluid) -> list[tuple[str, FluidRegion]]:
    """Fluid in other shapes by its names in a scene."""
    return [(f"fluid[{k}]", region) for k, region in enumerate(fluid) if region.shape != "box"]
