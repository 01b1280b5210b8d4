"""What a scene says about the parts of a structure: their shapes, meshes, materials."""

import math
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.meshes.files import least_edge, read
from quintet.components.shared.materials.params import Material, MaterialName, material
from quintet.interfaces.params import Count, DataFile, Positive, Vector, parameters

Flags = NDArray[np.bool_]
Direction = Literal["x", "y", "z"]


@parameters
class Cylinder:
    """A cylinder of elements: a rounded square in the middle, and rings around it.

    Parameters
    ----------
    base : m
        Middle of the disc with which it begins.
    axis
        Along which it extends from there.
    radius, length : m
        Of the cylinder.
    elements : 1
        Along half the width of the square in the middle, across the rings around it, and along
        the axis.
    quarter
        Only where both coordinates across the axis are beyond those of the base.
    """

    base: Vector = (0.0, 0.0, 0.0)
    axis: Direction = "z"
    radius: Positive
    length: Positive
    elements: tuple[Count, Count, Count]
    quarter: bool = False

    @property
    def count(self) -> int:
        """Number of its elements."""
        core, rings, layers = self.elements
        return (1 if self.quarter else 4) * core * (core + 2 * rings) * layers

    @property
    def edges(self) -> tuple[float, float, float]:
        """Edges [m] of its smallest elements, about."""
        core, rings, layers = self.elements
        half = 0.4 * self.radius
        return half / core, half / rings, self.length / layers


@parameters
class Cutout:
    """A box that is cut out of another.

    Parameters
    ----------
    lowest, highest : m
        Its corners; elements whose middle lies in it are left out.
    """

    lowest: Vector
    highest: Vector


@parameters
class MeshFile:
    """A mesh of 8-node solids from a file; others of its elements are left out.

    Parameters
    ----------
    file
        Beside the scene, in a format that meshio reads (Abaqus, Gmsh, Nastran, VTK, Exodus ...).
    scale : m
        That one unit of length in the file stands for.
    move : m
        By which the mesh is then moved.
    """

    file: DataFile
    scale: Positive = 1.0
    move: Vector = (0.0, 0.0, 0.0)

    @property
    def count(self) -> int:
        """Number of its elements."""
        return len(read(self.file).corner)


class Shape(Protocol):
    """What a mesh is made of: the keys that parts of any physics have."""

    @property
    def lowest(self) -> Vector | None:
        """Lowest corner [m] of a box."""

    @property
    def highest(self) -> Vector | None:
        """Highest corner [m] of a box."""

    @property
    def elements(self) -> tuple[int, int, int] | None:
        """How many elements a box has along x, y and z."""

    @property
    def cutout(self) -> Cutout | None:
        """What is left out of a box."""

    @property
    def cylinder(self) -> Cylinder | None:
        """In place of the box."""

    @property
    def mesh(self) -> MeshFile | None:
        """In place of the box."""


def require_shape(part: Shape) -> None:
    """Refuse a part that is not one of a box, a cylinder and a mesh."""
    box = (part.lowest, part.highest, part.elements)
    given = sum(one is not None for one in box)
    others = sum(one is not None for one in (part.cylinder, part.mesh))
    if (given, others) not in ((3, 0), (0, 1)):
        raise ValueError(
            "part: it must be a box, with lowest, highest and elements, a cylinder or a mesh; "
            f"found {given} keys of a box and {others} of the others. Give one."
        )
    if part.lowest is None or part.highest is None:
        if part.cutout is not None:
            raise ValueError("part: cutout is of a box; found none. Leave it out.")
        return
    if not all(a < b for a, b in zip(part.lowest, part.highest, strict=True)):
        raise ValueError(
            f"part: highest must be beyond lowest along every axis; found {part.lowest} and "
            f"{part.highest} m."
        )
    if count_elements(part) == 0:
        raise ValueError("part: cutout must leave an element; it leaves none. Make it smaller.")


def cut_out(part: Shape) -> tuple[Flags, Flags, Flags]:
    """Which elements of a box have a middle within its cutout, along each of x, y and z."""
    assert part.elements is not None and part.lowest is not None and part.highest is not None
    found = []
    for along, count in enumerate(part.elements):
        low, high = part.lowest[along], part.highest[along]
        middle = low + (high - low) * (np.arange(count) + 0.5) / count
        inside = np.zeros(count, bool)
        if part.cutout is not None:
            inside = (part.cutout.lowest[along] <= middle) & (middle <= part.cutout.highest[along])
        found.append(inside)
    return found[0], found[1], found[2]


def count_elements(part: Shape) -> int:
    """Number of a part's elements."""
    if part.cylinder is not None:
        return part.cylinder.count
    if part.mesh is not None:
        return part.mesh.count
    left_out = [int(one.sum()) for one in cut_out(part)]
    return math.prod(part.elements or ()) - math.prod(left_out)


@parameters
class Part:
    """A box of equal elements, a cylinder, or a mesh from a file.

    Parameters
    ----------
    lowest, highest : m
        Corners of a box.
    elements : 1
        How many along x, y and z.
    cutout
        What is left out of a box.
    cylinder, mesh
        In place of the box.
    material
        Name of a material of the library, or its table.
    velocity : m/s
        At the start.
    """

    lowest: Vector | None = None
    highest: Vector | None = None
    elements: tuple[Count, Count, Count] | None = None
    cutout: Cutout | None = None
    cylinder: Cylinder | None = None
    mesh: MeshFile | None = None
    material: MaterialName | Material
    velocity: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        require_shape(self)

    @property
    def count(self) -> int:
        """Number of its elements."""
        return count_elements(self)

    @property
    def expected_step(self) -> float:
        """Step [s] that its shortest edge bears."""
        made = material(self.material)
        bound = sum((1.0 / edge**2 for edge in self._edges()), 0.0)
        speed = math.sqrt((made.bulk + 4.0 / 3.0 * made.shear) / made.density)
        return 1.0 / (speed * math.sqrt(bound))

    def require_planar(self, where: str) -> None:
        """Refuse a part that is no slab of one element, 1 m deep along y."""
        if self.lowest is None or self.highest is None or self.elements is None:
            kind = "mesh of 8-node solids" if self.cylinder is None else "cylinder"
            raise ValueError(
                f"{where}: in two dimensions it must be a box, 1 m deep along y in one element; "
                f"found a {kind}, which has three. Make it a box, or set dimensions = 3."
            )
        deep, along = self.highest[1] - self.lowest[1], self.elements[1]
        if abs(deep - 1.0) > 1e-9 or along != 1:
            raise ValueError(
                f"{where}: in two dimensions it must be a box, 1 m deep along y in one element; "
                f"found {deep:g} m and {along} elements. Set both, or dimensions = 3."
            )

        if self.cutout is not None:
            raise ValueError(
                f"{where}: in two dimensions nothing is cut out; found a cutout. Leave it out, or "
                "set dimensions = 3."
            )

    def _edges(self) -> tuple[float, ...]:
        if self.cylinder is not None:
            return self.cylinder.edges
        if self.mesh is not None:
            return (self.mesh.scale * least_edge(read(self.mesh.file)),) * 3
        assert self.lowest is not None and self.highest is not None and self.elements is not None
        sides = zip(self.lowest, self.highest, self.elements, strict=True)
        return tuple((b - a) / n for a, b, n in sides)
