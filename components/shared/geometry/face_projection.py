"""Faces of a mesh: their shape functions, and the nearest one to a point."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.shared.geometry.face_kernels import Cells

MOST_CELLS = 4.0  # per face, of the cells by which faces are found
THIN = 1e-12  # of the length of its first tangent: a second one that adds nothing to it


@dataclass(frozen=True, slots=True)
class Projection:
    """Points projected onto the faces of a mesh."""

    node: Array  # (n, 4) corners of the face on which each point lies
    weight: Array  # (n, 4) 1, shape functions there; each row sums to one
    face: Array  # (n,) number of that face
    gap: Array  # (n,) m, distance to the nearest point of a face
    size: Array  # (n,) m, longest side of that face
    beyond: Array  # (n,) m, of that distance, what lies in the plane of the face: 0 above it


def bilinear(xi: Array, eta: Array) -> Array:
    """Shape functions (n, 4) of a quadrilateral at local coordinates (n,) from -1 to 1."""
    return 0.25 * np.stack(
        [(1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)],
        axis=1,
    )


def derivatives(xi: Array, eta: Array) -> tuple[Array, Array]:
    """Derivatives (n, 4) of the shape functions along xi and eta."""
    along = [-(1 - eta), 1 - eta, 1 + eta, -(1 + eta)]
    across = [-(1 - xi), -(1 + xi), 1 + xi, 1 - xi]
    return 0.25 * np.stack(along, axis=1), 0.25 * np.stack(across, axis=1)


def corners(face: Array) -> Array:
    """Corners (m, 4) with faces closed: the last of a triangle stands twice, both of an edge."""
    face = np.asarray(face, dtype=np.int64)
    third = np.where(face[:, 2] < 0, face[:, 1], face[:, 2])
    fourth = np.where(face[:, 2] < 0, face[:, 0], np.where(face[:, 3] < 0, third, face[:, 3]))
    return np.stack([face[:, 0], face[:, 1], third, fourth], axis=1)


def at_points(weight: Array, values: Array) -> Array:
    """Values (n, k) at points, of weights (n, 4) and values (n, 4, k) at corners."""
    return np.einsum("nc,nck->nk", weight, values)


def project(points: Array, position: Array, face: Array) -> Projection:
    """Hang points (n, 3) on the faces they lie nearest to, by bilinear shape functions."""
    # Kernels, and numba with them, are left out of reading scenes, and of those without meshes.
    from quintet.components.shared.geometry.face_kernels import Rivals, nearest_faces

    corner, count = corners(face), len(points)
    x = np.ascontiguousarray(position[corner])
    owner, local, gap = np.zeros(count, np.int64), np.zeros((count, 2)), np.zeros(count)
    every = Rivals(np.zeros((count, 3)), np.zeros((len(x), 3)), math.inf, math.inf)
    nearest_faces(np.ascontiguousarray(points), cells_of(x), every, owner, local, gap)
    quads = x[owner]
    weight = bilinear(*local.T)
    foot = at_points(weight, quads)
    side = np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    along, across = (at_points(slope, quads) for slope in derivatives(*local.T))
    beyond = _in_plane(points - foot, along, across)
    return Projection(corner[owner], weight, owner, gap, side, beyond)


def _in_plane(away: Array, along: Array, across: Array) -> Array:
    """Size (n,) m of the part of vectors (n, 3) that lies in the plane of two tangents."""
    length, width = (np.linalg.norm(tangent, axis=1)[:, None] for tangent in (along, across))
    first = np.divide(along, length, out=np.zeros_like(along), where=length > 0.0)
    rest = across - (across * first).sum(axis=1)[:, None] * first
    size = np.linalg.norm(rest, axis=1)[:, None]
    thin = size <= THIN * np.maximum(length, width)
    second = np.divide(rest, size, out=np.zeros_like(rest), where=~thin)
    return np.hypot((away * first).sum(axis=1), (away * second).sum(axis=1))


def cells_of(x: Array) -> "Cells":
    """Put faces (m, 4, 3) m into cells."""
    # Late as in `project`.
    from quintet.components.shared.geometry.face_kernels import Cells, fill_cells

    low, extent = x.min(axis=(0, 1)), np.ptp(x, axis=(0, 1))
    size = max(float(np.median(np.ptp(x, axis=1).max(axis=1))), 1e-6 * float(extent.max()), 1e-300)
    while np.prod(np.floor(extent / size) + 1.0) > max(64.0, MOST_CELLS * len(x)):
        size *= 1.25
    count = np.floor(extent / size).astype(np.int64) + 1
    return Cells(x, low, size, count, *fill_cells(x, low, size, count))
