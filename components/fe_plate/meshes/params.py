"""What a scene says about the parts of a structure: their shapes, meshes, materials."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.meshes.elements import require_sound
from quintet.components.fe_plate.meshes.files import FileMesh, least_edge, read
from quintet.components.fe_plate.meshes.tetrahedra import NODES as TETRAHEDRON
from quintet.components.fe_plate.meshes.tetrahedra import OF_BRICK
from quintet.components.shared.geometry.selections import ByBox
from quintet.components.shared.geometry.shape_keys import (
    BoxKeys,
    CylinderKeys,
    MeshKeys,
    shape_of,
)
from quintet.components.shared.geometry.shapes import Box, Cylinder, Mesh, Shape
from quintet.components.shared.materials.params import Material, MaterialName, material
from quintet.interfaces.params import Count, Positive, Vector, parameters

Flags = NDArray[np.bool_]
SMALL, LARGE = 1e-4, 5.0  # m: meshes beyond are asked whether their unit is right
Direction = Literal["x", "y", "z"]


@parameters
class Cutout(ByBox):
    """A box that is cut out of another: elements whose middle lies in it are left out."""


@parameters
class MeshedPart(BoxKeys, CylinderKeys, MeshKeys):
    """A box of equal elements, a cylinder of them, or a mesh of solids from a file.

    Parameters
    ----------
    shape
        What it is; only a box in two dimensions.
    radius : m
        Of a cylinder: a rounded square in the middle, and rings around it.
    file
        A mesh beside the scene: LS-DYNA keywords (.k, .key), or a format that meshio reads (Abaqus,
        Gmsh, Nastran, VTK, Exodus ...), of 8-node hexahedra, or of tetrahedra with 10 nodes, or
        with 4, which get 6 more; shells, beams and other solids in it are refused.
    scale : m
        What one unit of length in the file stands for; 1 if not given.
    elements : 1
        Of a box along x, y and z; of a cylinder along half the width of the square, across the
        rings, and along the axis.
    tetrahedra
        Whether each element of a box is cut into six tetrahedra with ten nodes.
    cutout
        What is left out of a box.
    quarter
        Whether a cylinder is only where both coordinates across the axis are beyond the base's.
    coincident_nodes
        Nodes of different elements of a mesh at the same place: "refuse" them, "join" them to one,
        or "keep" them apart, as at a crack.
    parts : 1
        Of a mesh: the parts that are read, by their numbers or titles in an LS-DYNA file, or by
        names of sets of elements; all if none are given.
    """

    RENAMED: ClassVar = {
        "cylinder": 'shape = "cylinder", with base, top, radius, elements and quarter beside it',
        "mesh": 'shape = "mesh", with file, scale, coincident_nodes and origin, once move, beside',
    }
    shape: Literal["box", "cylinder", "mesh"] = "box"
    elements: tuple[Count, Count, Count] | None = None
    tetrahedra: bool = False
    cutout: Cutout | None = None
    quarter: bool = False
    coincident_nodes: Literal["refuse", "join", "keep"] = "refuse"
    parts: tuple[int | str, ...] = ()

    def __post_init__(self) -> None:
        shape = self.geometry
        if (self.elements is None) != isinstance(shape, Mesh):
            if self.elements is None:
                raise ValueError(
                    f"parts: a {self.shape} needs elements, three numbers of elements; found none. "
                    "Add elements, as in [4, 4, 2]."
                )
            raise ValueError(
                "parts: elements is for a box or a cylinder, and a mesh has those of its file; "
                f"found {list(self.elements)}. Leave it out."
            )
        if self.cutout is not None and not isinstance(shape, Box):
            raise ValueError(
                f"parts: cutout is for a box alone; found a {self.shape}. Leave it out."
            )
        if self.tetrahedra and not isinstance(shape, Box):
            raise ValueError(
                f"parts: tetrahedra = true is for a box; found a {self.shape}. Leave it out, and "
                "mesh other shapes with tetrahedra in a file."
            )
        if self.parts and not isinstance(shape, Mesh):
            raise ValueError(
                f"parts: parts is for a mesh from a file; found {list(self.parts)} with a "
                f"{self.shape}. Leave it out."
            )
        for key, is_given, kind in (
            ("quarter", self.quarter, "cylinder"),
            ("coincident_nodes", self.coincident_nodes != "refuse", "mesh"),
            ("time_scale", getattr(self, "time_scale", 1.0) != 1.0, "mesh"),
        ):
            if is_given and self.shape != kind:
                raise ValueError(
                    f"parts: {key} is for a {kind}; found a {self.shape}. Leave it out."
                )
        if isinstance(shape, Box) and self.count == 0:
            raise ValueError(
                "parts: cutout must leave an element; it leaves none. Make it smaller."
            )

    @property
    def geometry(self) -> Shape:
        """The shape that the keys describe."""
        return shape_of(self, "parts")

    @property
    def has_tetrahedra(self) -> bool:
        """Whether its elements are tetrahedra with ten nodes."""
        shape = self.geometry
        if not isinstance(shape, Mesh):
            return self.tetrahedra
        return read(shape.file, self.coincident_nodes, self.parts).corner.shape[1] == TETRAHEDRON

    @property
    def counts(self) -> tuple[int, int, int]:
        """Its elements, as `elements` gives them; of a mesh none."""
        return self.elements or (0, 0, 0)

    @property
    def count(self) -> int:
        """Number of its elements; those of a mesh are checked."""
        a, b, c = self.counts
        if self.shape == "cylinder":
            return (1 if self.quarter else 4) * a * (a + 2 * b) * c
        if self.shape == "mesh":
            return len(self.placed().corner)
        bricks = a * b * c - math.prod(end - begin for begin, end in self._cut_out_ranges())
        return len(OF_BRICK) * bricks if self.tetrahedra else bricks

    def placed(self) -> FileMesh:
        """Nodes where they are [m], and elements, which are checked; with notes of both."""
        shape = self.geometry
        assert isinstance(shape, Mesh)
        loaded, name = read(shape.file, self.coincident_nodes, self.parts), Path(shape.file).name
        node = shape.scale * loaded.node + shape.origin
        notes = [_size(name, node, len(loaded.corner), shape.scale), *loaded.notes]
        notes += require_sound(f"mesh {name}", node, loaded.corner)
        return loaded._replace(node=node, notes=tuple(notes))

    def cut_out(self) -> tuple[Flags, Flags, Flags]:
        """Which elements of a box have a middle within its cutout, along each of x, y and z."""
        inside_along = [np.zeros(count, bool) for count in self.counts]
        for inside, (begin, end) in zip(inside_along, self._cut_out_ranges(), strict=True):
            inside[begin:end] = True
        return inside_along[0], inside_along[1], inside_along[2]

    def _cut_out_ranges(self) -> list[tuple[int, int]]:
        """Ranges of these elements along each axis, however many there are."""
        if self.cutout is None:
            return [(0, 0)] * 3
        low, high = self.geometry.bounds
        ranges = []
        for along, count in enumerate(self.counts):
            begins, extent = low[along], high[along] - low[along]

            def middle(
                k: int, begins: float = begins, extent: float = extent, n: int = count
            ) -> float:
                return begins + extent * (k + 0.5) / n

            places = range(count)
            begin = bisect_left(places, self.cutout.lowest[along], key=middle)
            end = bisect_right(places, self.cutout.highest[along], key=middle)
            ranges.append((begin, max(begin, end)))
        return ranges

    def edges(self) -> tuple[float, ...]:
        """Edges [m] of its smallest elements; of a cylinder about."""
        shape = self.geometry
        if isinstance(shape, Mesh):
            loaded = self.placed()
            return (least_edge(loaded.node, loaded.corner),) * 3
        if isinstance(shape, Cylinder):
            lengths = 0.4 * shape.radius, 0.4 * shape.radius, shape.length
            return tuple(length / n for length, n in zip(lengths, self.counts, strict=True))
        sides = zip(*shape.bounds, self.counts, strict=True)
        halves = 2.0 if self.tetrahedra else 1.0  # nodes stand in the middles of edges too
        return tuple((b - a) / n / halves for a, b, n in sides)


def _size(name: str, node: NDArray[np.float64], elements: int, scale: float) -> str:
    """How large a mesh is, and whether its unit of length may be another one."""
    extent = np.ptp(node, axis=0)
    x, y, z = extent.tolist()
    text = f"mesh {name}: {elements} elements, {len(node)} nodes, {x:.4g} x {y:.4g} x {z:.4g} m."
    if not SMALL < extent.max() < LARGE:
        text += (
            f" Is that meant? One unit of length in the file is taken for {scale:g} m; for a file "
            "in millimetres set scale = 0.001."
        )
    return text


def mesh_notes(parts: Sequence[MeshedPart]) -> tuple[str, ...]:
    """Sizes of meshes from files, and what of them is left out."""
    meshes = [part.placed() for part in parts if part.shape == "mesh"]
    return tuple(note for mesh in meshes for note in mesh.notes)


@parameters
class Part(MeshedPart):
    """A box of equal elements, a cylinder of them, or a mesh of solids from a file.

    Parameters
    ----------
    material
        Name of a material of the library, or its table.
    velocity : m/s
        At the start; without it, that of the nodes in an LS-DYNA file, or none.
    time_scale : s
        What one unit of time in an LS-DYNA file stands for, whose initial velocities are used.
    """

    material: MaterialName | Material
    velocity: Vector | None = None
    time_scale: Positive = 1.0

    def placed(self) -> FileMesh:
        """Nodes where they are [m], and elements, which are checked; with velocities [m/s]."""
        loaded = MeshedPart.placed(self)
        if loaded.velocity is None:
            return loaded
        name = f"mesh {Path(self.file or '').name}"
        moving = int(loaded.velocity.any(axis=1).sum())
        if self.velocity is not None:
            note = (
                f"{name}: initial velocities of {moving} nodes are not used, for the scene gives "
                "the part's velocity."
            )
            return loaded._replace(velocity=None, notes=(*loaded.notes, note))
        velocity = (self.scale or 1.0) / self.time_scale * loaded.velocity
        fastest = float(np.linalg.norm(velocity, axis=1).max())
        note = (
            f"{name}: initial velocities of {moving} nodes are the file's, up to {fastest:.4g} m/s."
        )
        return loaded._replace(velocity=velocity, notes=(*loaded.notes, note))

    @property
    def expected_step(self) -> float:
        """Stable step [s] of its shortest edge."""
        law = material(self.material)
        bound = sum((1.0 / edge**2 for edge in self.edges()), 0.0)
        speed = math.sqrt((law.bulk + 4.0 / 3.0 * law.shear) / law.density)
        return (0.5 if self.has_tetrahedra else 1.0) / (speed * math.sqrt(bound))

    def require_planar(self, where: str) -> None:
        """Refuse a part that is no slab of one element, 1 m deep along y."""
        if self.shape != "box":
            kind = "cylinder" if self.shape == "cylinder" else "mesh from a file"
            raise ValueError(
                f"{where}: in two dimensions it must be a box, 1 m deep along y in one element; "
                f"found a {kind}. Make it a box, or set dimensions = 3."
            )
        (_, low, _), (_, high, _) = self.geometry.bounds
        deep, along = high - low, self.counts[1]
        if abs(deep - 1.0) > 1e-9 or along != 1:
            raise ValueError(
                f"{where}: in two dimensions it must be a box, 1 m deep along y in one element; "
                f"found {deep:g} m and {along} elements. Set both, or dimensions = 3."
            )
        if self.tetrahedra:
            raise ValueError(
                f"{where}: in two dimensions there are no tetrahedra; found tetrahedra = true. "
                "Leave it out, or set dimensions = 3."
            )
        if self.velocity is not None and self.velocity[1] != 0.0:
            raise ValueError(
                f"{where}: in two dimensions a velocity must be along x and z; found "
                f"{self.velocity[1]:g} m/s along y. Set it to 0, or dimensions = 3."
            )
        if self.cutout is not None:
            raise ValueError(
                f"{where}: in two dimensions nothing is cut out; found a cutout. Leave it out, or "
                "set dimensions = 3."
            )
