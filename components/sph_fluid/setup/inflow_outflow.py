"""Faces of a tank through which fluid comes and goes."""

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.components.sph_fluid.setup.expressions import Expression, values_at
from quintet.components.sph_fluid.setup.geometry import Face
from quintet.interfaces.component import Array
from quintet.interfaces.params import DataFile, Number, parameters

if TYPE_CHECKING:
    from quintet.components.sph_fluid.setup.field_table import FieldTable

LISTED = 1.2  # of a kernel's radius, how far neighbour lists reach at most
LOOKED = np.linspace(0.1, 0.9, 9)  # of a face along each axis, where its speed is looked at


@parameters
class Inflow:
    """An open face of the tank through which fluid enters.

    The first layers behind the face, as deep as pairs act and a spacing, are a buffer: its
    particles move straight into the tank with the speed given, and are fluid from its end on.

    Parameters
    ----------
    face
        Of the tank, one of boundary.open_faces.
    speed : m/s
        Into the tank, a number or an expression of x, y and z [m]; this or a table.
    table
        Name of a table beside the scene, as of `initial.table`: of x, y, z those that it depends
        on, and u [m/s], into the tank.
    level : m
        Height of the surface, below which fluid enters; without it through the whole face.
    density
        Of the buffer: that of the fluid before it at the same height, or that of fluid at rest
        below `level`.
    """

    face: Face
    speed: Expression | None = None
    table: DataFile | None = None
    level: Number | None = None
    density: Literal["extrapolated", "hydrostatic"] = "extrapolated"

    def speed_at(self, points: Array) -> Array:
        """Speed (n,) m/s into the tank at points (n, 3) m."""
        if self.speed is not None:
            return values_at(self.speed, points, f"boundary.inflow {self.face}: speed")
        table = self._read_table()
        assert table is not None
        return table.at(points, "u")

    def check(self) -> None:
        """Refuse an inflow whose speed is not given once."""
        table = self._read_table()
        if (self.speed is None) == (table is None):
            raise ValueError(
                f"boundary.inflow {self.face} must have either speed or table; found "
                f"{'neither' if table is None else 'both'}. Give one of them."
            )
        if table is not None and not table.has("u"):
            raise ValueError(
                f"boundary.inflow {self.face}: table must have a column u [m/s], into the tank; "
                "found none. Name it so."
            )

    def check_speed(self, points: Array) -> None:
        """Refuse speeds out of the tank at the places (n, 3) m where fluid enters."""
        speed = self.speed_at(points)
        worst = int(np.argmin(speed))
        if speed[worst] < 0.0 or not speed.any():
            x, y, z = points[worst].tolist()
            raise ValueError(
                f"boundary.inflow {self.face}: speed must be 0 or more, into the tank, and "
                f"somewhere more; found {speed[worst]:.4g} m/s at ({x:.4g}, {y:.4g}, {z:.4g}) m. "
                "Correct it, or use an outflow."
            )

    def _read_table(self) -> "FieldTable | None":
        if self.table is None:
            return None
        # Left out of scenes without a table.
        from quintet.components.sph_fluid.setup.field_table import read_table

        return read_table(self.table)


@parameters
class Outflow:
    """An open face of the tank through which fluid leaves.

    The last layers before the face, as deep as pairs act and a spacing, are a buffer: particles
    that enter it have left the fluid. They move straight out with the velocity of the fluid before
    the buffer at the same height, and have its density too, unless level or pressure is given.

    Parameters
    ----------
    face
        Of the tank, one of boundary.open_faces.
    level : m
        Height of the surface beyond the face: the buffer has the pressure of fluid at rest below.
    pressure : Pa
        Of the buffer, in place of level.
    """

    face: Face
    level: Number | None = None
    pressure: Number | None = None


def buffer_layers(smoothing: float) -> int:
    """Layers of a buffer: as far as pairs are listed, and one that comes or goes."""
    return math.ceil(LISTED * 2.0 * smoothing) + 1


def check_flow(
    inflow: tuple[Inflow, ...], outflow: tuple[Outflow, ...], tank: Bounds | None,
    open_faces: tuple[Face, ...], dimensions: int,
) -> None:  # fmt: skip
    """Fluid comes and goes through open faces of a tank, each with one rule."""
    names = [f"boundary.inflow {passage.face}" for passage in inflow]
    names += [f"boundary.outflow {passage.face}" for passage in outflow]
    used_faces: set[str] = set()
    passages: list[Inflow | Outflow] = [*inflow, *outflow]
    for name, passage in zip(names, passages, strict=True):
        face = passage.face
        if tank is None or face not in open_faces:
            raise ValueError(
                f"{name} must be an open face of the tank; found walls {tank} and open_faces "
                f"{open_faces}. Give walls, and add the face to boundary.open_faces."
            )
        if dimensions == 2 and face[0] == "y":
            raise ValueError(
                f"{name} must be across x or z in two dimensions, where nothing moves along y. "
                "Choose another face."
            )
        if face in used_faces:
            raise ValueError(
                f"{name} must be the only inflow or outflow of its face; found another. Remove one."
            )
        used_faces.add(face)
        low, high = tank[0][2], tank[1][2]
        if passage.level is not None and face[0] == "z":
            raise ValueError(
                f"{name}: level is for a face across x or y; found it at a face across z. Remove "
                "level."
            )
        if passage.level is not None and not low < passage.level <= high:
            raise ValueError(
                f"{name}: level must be a height in the tank, above {low:g} and up to {high:g} m; "
                f"found {passage.level:g} m. Correct it, or remove it."
            )
    for entrance in inflow:
        entrance.check()
        assert tank is not None
        entrance.check_speed(_places(entrance, tank))
    for exit_ in outflow:
        if exit_.level is not None and exit_.pressure is not None:
            raise ValueError(
                f"boundary.outflow {exit_.face} must have level or pressure, or neither; found "
                "both. Remove one."
            )


def _places(inflow: Inflow, tank: Bounds) -> Array:
    """Some places (n, 3) m in the face of an inflow, below its level."""
    (low, high), axis = (np.array(corner) for corner in tank), "xyz".index(inflow.face[0])
    if inflow.level is not None:
        high[2] = inflow.level
    axes = [a + LOOKED * (b - a) for a, b in zip(low, high, strict=True)]
    axes[axis] = np.array([(high if inflow.face[1] == "+" else low)[axis]])
    return lattice_points(axes)
