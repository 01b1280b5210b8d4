"""Keys by which tables of a scene describe a shape; a table derives from those that it allows."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from quintet.components.shared.geometry import planar_shapes, shapes
from quintet.components.shared.geometry.bounds import Corners
from quintet.components.shared.geometry.shapes import Shape
from quintet.interfaces.params import DataFile, Positive, Vector, parameters

CLASSES: Mapping[str, Any] = {
    "box": shapes.Box,
    "sphere": shapes.Sphere,
    "cylinder": shapes.Cylinder,
    "disc": planar_shapes.Disc,
    "polygon": planar_shapes.Polygon,
    "mesh": shapes.Mesh,
}
NEEDS = {
    "box": ("lowest", "highest"),
    "sphere": ("centre", "radius"),
    "cylinder": ("base", "top", "radius"),
    "disc": ("centre", "radius"),
    "polygon": ("corners",),
    "mesh": ("file",),
}
MAY = {"cylinder": ("inner_radius",), "polygon": ("origin",), "mesh": ("scale", "origin")}
RENAMED = {
    "diameter": "radius, half of it",
    "inner_diameter": "inner_radius, half of it",
    "size": "lowest and highest of a box, radius of a sphere or disc",
    "position": "centre of a sphere or disc, lowest and highest of a box, else origin",
    "height": "base and top",
    "axis": "base and top",
}


@parameters
class BoxKeys:
    """Keys of a box.

    Parameters
    ----------
    lowest, highest : m
        Corners of a box.
    """

    lowest: Vector | None = None
    highest: Vector | None = None


@parameters
class RoundKeys:
    """Keys of a sphere or disc.

    Parameters
    ----------
    centre, radius : m
        Of a sphere or disc.
    """

    centre: Vector | None = None
    radius: Positive | None = None


@parameters
class CylinderKeys:
    """Keys of a cylinder.

    Parameters
    ----------
    base, top : m
        Centres of a cylinder's ends, which lie along x, y or z from each other.
    radius : m
        Of a sphere or cylinder.
    """

    base: Vector | None = None
    top: Vector | None = None
    radius: Positive | None = None


@parameters
class TubeKeys:
    """Keys of a cylinder that may be hollow, beside the others of a cylinder.

    Parameters
    ----------
    inner_radius : m
        Of a cylinder that is a tube.
    """

    inner_radius: Positive | None = None


@parameters
class PolygonKeys:
    """Keys of a polygon.

    Parameters
    ----------
    corners : m
        x and z of a polygon's corners, three or more, in order round it, either way.
    origin : m
        Where the origin of the corners is; that of the world if not given.
    """

    corners: Corners | None = None
    origin: Vector | None = None


@parameters
class MeshKeys:
    """Keys of a mesh.

    Parameters
    ----------
    file
        Closed surface of a mesh: STL, OBJ, PLY, or voxels as .npy; named from the scene's folder
        on.
    scale : m
        What one unit of length in the file, or one voxel, stands for; 1 if not given.
    origin : m
        Where the origin of the file is; that of the world if not given.
    """

    file: DataFile | None = None
    scale: Positive | None = None
    origin: Vector | None = None


def shape_of(table: Any, where: str) -> Shape:
    """Return the shape that a table describes; refuse one that lacks a key or has one too many."""
    require_keys(table, where, NEEDS, MAY)
    names = (*NEEDS[table.shape], *MAY.get(table.shape, ()))
    values = {name: getattr(table, name, None) for name in names}
    values = {name: value for name, value in values.items() if value is not None}
    try:
        shape: Shape = CLASSES[table.shape](**values)
    except ValidationError as error:
        raise ValueError(f"{where}: {error.errors()[0]['ctx']['error']}") from None
    if isinstance(shape, shapes.Box) and not all(edge > 0.0 for edge in shape.size):
        raise ValueError(
            f"{where}: a box must go from its lowest to its highest corner along every axis; found "
            f"{shape.lowest} and {shape.highest} m. Correct them."
        )
    return shape


def require_keys(
    table: Any,
    where: str,
    needs: Mapping[str, tuple[str, ...]],
    may: Mapping[str, tuple[str, ...]],
) -> None:
    """Refuse a table that lacks a key of its shape, or has one of another."""
    needed, allowed = needs[table.shape], may.get(table.shape, ())
    known = {name for names in (*needs.values(), *may.values()) for name in names}
    present = sorted(name for name in known if getattr(table, name, None) is not None)
    if sorted(needed) != [name for name in present if name not in allowed]:
        also = f" (it may have {' and '.join(allowed)})" if allowed else ""
        raise ValueError(
            f"{where}: a {table.shape} is described by {' and '.join(needed)} alone{also}; found "
            f"{', '.join(present) or 'none'}. Give {' and '.join(needed)}."
        )
