"""What a scene says about the parts of a structure: their shapes, meshes, materials."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.meshes.elements import require_sound
from quintet.components.fe_plate.meshes.files import FileMesh, least_edge, read
from quintet.components.shared.materials.params import Material, MaterialName, material
from quintet.interfaces.params import Count, DataFile, Positive, Vector, parameters

Flags = NDArray[np.bool_]
SMALL, LARGE = 1e-4, 5.0  # m: meshes beyond are asked whether their unit is right
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
    """A mesh of 8-node solids from a file; other solids, shells and beams are refused.

    Parameters
    ----------
    file
        Beside the scene, in a format that meshio reads (Abaqus, Gmsh, Nastran, VTK, Exodus ...).
    scale : m
        That one unit of length in the file stands for.
    move : m
        By which the mesh is then moved.
    coincident_nodes
        Nodes of different elements at the same place: "refuse" them, "join" them to one, or "keep"
        them apart, as at a crack.
    """

    file: DataFile
    scale: Positive = 1.0
    move: Vector = (0.0, 0.0, 0.0)
    coincident_nodes: Literal["refuse", "join", "keep"] = "refuse"

    @property
    def count(self) -> int:
        """Number of its elements, which are checked."""
        return len(self.placed().corner)

    def placed(self) -> FileMesh:
        """Nodes where they are [m], and elements, which are checked; with notes of both."""
        loaded, name = read(self.file, self.coincident_nodes), Path(self.file).name
        node = self.scale * loaded.node + self.move
        notes = [_size(name, node, len(loaded.corner), self.scale), *loaded.notes]
        notes += require_sound(f"mesh {name}", node, loaded.corner)
        return loaded._replace(node=node, notes=tuple(notes))


def _size(name: str, node: NDArray[np.float64], elements: int, scale: float) -> str:
    """How large a mesh is, and whether its unit of length may be another one."""
    extent = np.ptp(node, axis=0)
    x, y, z = extent.tolist()
    text = f"mesh {name}: {elements} elements, {len(node)} nodes, {x:.4g} x {y:.4g} x {z:.4g} m."
    if not SMALL < extent.max() < LARGE:
        text += (
            f" Is that meant? One unit of length in the file is taken for {scale:g} m; of a mesh "
            "in millimetres scale is 0.001."
        )
    return text


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
    keys = sum(value is not None for value in box)
    others = sum(value is not None for value in (part.cylinder, part.mesh))
    if (keys, others) not in ((3, 0), (0, 1)):
        raise ValueError(
            "part: it must be a box, with lowest, highest and elements, a cylinder or a mesh; "
            f"found {keys} keys of a box and {others} of the others. Give one."
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


def mesh_notes(parts: Sequence[Shape]) -> tuple[str, ...]:
    """Sizes of meshes from files, and what of them is left out."""
    meshes = [part.mesh.placed() for part in parts if part.mesh is not None]
    return tuple(note for mesh in meshes for note in mesh.notes)


def cut_out(part: Shape) -> tuple[Flags, Flags, Flags]:
    """Which elements of a box have a middle within its cutout, along each of x, y and z."""
    assert part.elements is not None and part.lowest is not None and part.highest is not None
    inside_along = []
    for along, count in enumerate(part.elements):
        low, high = part.lowest[along], part.highest[along]
        middle = low + (high - low) * (np.arange(count) + 0.5) / count
        inside = np.zeros(count, bool)
        if part.cutout is not None:
            inside = (part.cutout.lowest[along] <= middle) & (middle <= part.cutout.highest[along])
        inside_along.append(inside)
    return inside_along[0], inside_along[1], inside_along[2]


def count_elements(part: Shape) -> int:
    """Number of a part's elements."""
    if part.cylinder is not None:
        return part.cylinder.count
    if part.mesh is not None:
        return part.mesh.count
    left_out = [int(inside.sum()) for inside in cut_out(part)]
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
        law = material(self.material)
        bound = sum((1.0 / edge**2 for edge in self._edges()), 0.0)
        speed = math.sqrt((law.bulk + 4.0 / 3.0 * law.shear) / law.density)
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
            loaded = self.mesh.placed()
            return (least_edge(loaded.node, loaded.corner),) * 3
        assert self.lowest is not None and self.highest is not None and self.elements is not None
        sides = zip(self.lowest, self.highest, self.elements, strict=True)
        return tuple((b - a) / n for a, b, n in sides)
