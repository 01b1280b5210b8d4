"""What holds a structure, for pictures: rigid walls, clamped faces, planes of symmetry.

Where nodes are held all along a face this is drawn as one rectangle around it, seen from outside.
"""

from collections.abc import Sequence

import numpy as np

from quintet.components.fe_plate.meshes.mesh import Mesh, chosen
from quintet.components.fe_plate.meshes.selections import Fixed
from quintet.components.fe_plate.params import FePlateParams, RigidWall
from quintet.components.fe_plate.state import Array, Whole
from quintet.components.shared.geometry.face_projection import corners as closed
from quintet.interfaces.component import Fields
from quintet.interfaces.faces import CLAMPED, SYMMETRY, WALL, polygons

AXES = ("x", "y", "z")
FLAT = 1e-6  # of a normal: what of it may lie along other axes
REACH = 0.75  # of the structure's diagonal: how far a rigid wall is drawn from its foot
BEYOND = 0.15  # of the diagonal: how far a plane of symmetry is drawn beyond its face


def supports(params: FePlateParams, mesh: Mesh) -> Fields:
    """Polygons of rigid walls, clamped faces and planes of symmetry, and which is which."""
    low, high = mesh.node.min(axis=0), mesh.node.max(axis=0)
    size = float(np.linalg.norm(high - low))
    faces = [_patch(wall, 0.5 * (low + high), REACH * size) for wall in params.rigid_walls]
    kinds = [WALL] * len(faces)
    whole = ("x", "z") if params.dimensions == 2 else AXES
    for number, held in enumerate(params.fixed):
        clamped = set(whole) <= set(held.directions)
        axes = AXES if clamped else held.directions if len(held.directions) == 1 else ()
        rectangles = _held(mesh, held, f"fixed.{number}", axes, 0.0 if clamped else BEYOND * size)
        faces += rectangles
        kinds += [CLAMPED if clamped else SYMMETRY] * len(rectangles)
    return {**polygons(faces), "support": np.array(kinds, float)} if faces else {}


def _held(mesh: Mesh, held: Fixed, where: str, axes: Sequence[str], beyond: float) -> list[Array]:
    """Rectangles around outer faces whose nodes are all held, across some axes."""
    nodes = chosen(mesh, held, where)
    corners = _corners(mesh)[(nodes[mesh.side] | (mesh.side < 0)).all(axis=1)]  # (f, 4, 3)
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    unit = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    rectangles = []
    for axis in map(AXES.index, axes):
        for way in (-1.0, 1.0):
            mine = corners[unit[:, axis] * way > 1.0 - FLAT]
            places = np.unique(np.round(mine[:, 0, axis], 12))
            for place in places:
                flat = mine[np.isclose(mine[:, 0, axis], place, rtol=1e-9, atol=1e-12)]
                low, high = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
                rectangles.append(_rectangle(low - beyond, high + beyond, axis, place, way))
    return rectangles


def _corners(mesh: Mesh) -> Array:
    """Corners (f, 4, 3) m of the outer faces; edges of elements in a plane are 1 m wide."""
    side: Whole = mesh.side
    if len(side) and side[0, 2] < 0:
        first, last = mesh.node[side[:, 0]], mesh.node[side[:, 1]]
        along = np.array([0.0, 1.0, 0.0])
        return np.stack([last, first, first + along, last + along], axis=1)
    return np.asarray(mesh.node[closed(side)])


def _rectangle(low: Array, high: Array, axis: int, place: float, way: float) -> Array:
    """Corners (4, 3) m of a rectangle across an axis, around it from where `way` points to."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    corners = np.empty((4, 3))
    corners[:, axis] = place
    corners[:, u] = np.array([low, high, high, low])[:, u]
    corners[:, v] = np.array([low, low, high, high])[:, v]
    return corners if way > 0.0 else corners[::-1]


def _patch(wall: RigidWall, centre: Array, reach: float) -> Array:
    """Corners (4, 3) m of a square on a rigid wall, seen from the structure."""
    normal = np.array(wall.normal) / np.linalg.norm(wall.normal)
    foot = centre - normal * float(normal @ (centre - wall.point))
    along = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    return foot + reach * np.array(
        [-along - across, along - across, along + across, across - along]
    )
