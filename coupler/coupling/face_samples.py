"""Samples below the faces of a mesh that deforms, as a fluid asks for them."""

from dataclasses import dataclass

import numpy as np

from quintet.coupler.coupling.faces import bilinear, cells_of, corners, derivatives
from quintet.coupler.coupling.mapping import OffsetMap, ShapeMap
from quintet.coupler.coupling.rigid_samples import Sampling
from quintet.interfaces.component import Array

# Half of the metre along y that edges stand for, turned so that normals point out of the body.
PLANAR_SIDE = np.array([0.0, -0.5, 0.0])  # m
HALF = 0.5  # of a layer's thickness: a sample nearer by so much to another face is that one's
SAME_WAY = 0.7  # cosine of the angle between faces that go on from one another
ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class FaceSamples:
    """Samples of the faces of a mesh."""

    offset: OffsetMap
    normal: Array  # (n, 3) outward, at the start
    volume: Array  # (n,) m3
    room: float  # m, least distance of faces that look away from each other; ∞ if none are near
    thin: int  # number of a face behind which that is


@dataclass(frozen=True, slots=True)
class Columns:
    """Middles of equal cells of faces, below which samples lie one under another."""

    node: Array  # (n, 4) int
    face: Array  # (n,) int
    local: Array  # (n, 2) 1, ξ and η
    share: Array  # (n,) 1, of the face's area in ξ and η
    nodes: int
    side: Array  # (3,) m

    def offset(self, rows: Array, depth: Array) -> OffsetMap:
        """Map of points (n,) m below some of them."""
        node, face, local = self.node[rows], self.face[rows], self.local[rows].T
        weights = bilinear(*local), *derivatives(*local)
        surface, along, across = (ShapeMap(node, one, self.nodes, face) for one in weights)
        return OffsetMap(surface, along, across, depth, self.side)


def sample_faces(position: Array, face: Array, asked: Sampling) -> FaceSamples:
    """Sample the body below the faces (m, 4) of a mesh with its nodes at (nodes, 3) m.

    Each face is cut into cells of about the spacing, with a column of samples below the middle of
    each. Where faces that look the other way lie behind it, the columns of both sides meet in the
    middle between them; a sample that lies deeper below its own face than below another is left
    to that one, as at the edges of a body.
    """
    columns = _columns(position, face, asked)
    every = np.arange(len(columns.face))
    surface = columns.offset(every, np.zeros(len(every)))
    start, across = surface.surface.map_consistent(position), np.cross(*surface.tangents(position))
    length = np.linalg.norm(across, axis=1)
    normal = across / length[:, None]
    outward = _face_normals(position, face, columns.side)
    x = np.ascontiguousarray(position[corners(face)])
    room = _room(start, normal, columns.face, outward, x, asked)
    layers, thickness = _layers(room, asked)
    rows = np.repeat(every, layers)
    number = np.arange(len(rows)) - np.repeat(np.cumsum(layers) - layers, layers)
    thick = thickness[rows]
    depth = np.maximum(_shift(asked) + (number + 0.5) * thick, 0.0)
    place = start[rows] - depth[:, None] * normal[rows]
    kept = _own(place, normal[rows], columns.face[rows], depth, thick, outward, x)
    volume = (columns.share * length)[rows] * thick
    offset = columns.offset(rows[kept], depth[kept])
    least = int(np.argmin(room))
    thin = int(columns.face[least])
    return FaceSamples(offset, normal[rows[kept]], volume[kept], float(room[least]), thin)


def _columns(position: Array, face: Array, asked: Sampling) -> Columns:
    # Kernels, and numba with them, are left out of reading scenes, and of those without meshes.
    from quintet.coupler.coupling.face_kernels import write_columns

    corner = corners(face)
    x = position[corner]
    edge = np.linalg.norm(x - np.roll(x, -1, axis=1), axis=2)  # (m, 4) m: ab, bc, cd, da
    sides = np.stack([edge[:, [0, 2]].max(axis=1), edge[:, [1, 3]].max(axis=1)], axis=1)
    count = np.maximum(np.rint(sides / asked.spacing).astype(np.int64), 1)
    if asked.planar:
        count[:, 1] = 1
    total = int(count.prod(axis=1).sum())
    owner, local, share = np.zeros(total, np.int64), np.zeros((total, 2)), np.zeros(total)
    write_columns(count, owner, local, share)
    side = PLANAR_SIDE if asked.planar else np.zeros(3)
    return Columns(corner[owner], owner, local, share, len(position), side)


def _face_normals(position: Array, face: Array, side: Array) -> Array:
    """Outward normals (m, 3) at the middles of faces."""
    corner, count = corners(face), len(face)
    every, nothing = np.arange(count), np.zeros(count)
    middles = Columns(corner, every, np.zeros((count, 2)), nothing, len(position), side)
    return middles.offset(every, nothing).normals(position)


def _room(
    start: Array, normal: Array, own: Array, outward: Array, x: Array, asked: Sampling
) -> Array:
    """How far (n,) m it is from columns to where the body ends behind them; ∞ if that is far."""
    # Late as in `_columns`.
    from quintet.coupler.coupling.face_kernels import opposite_faces

    room, reach = np.full(len(start), np.inf), 2.0 * (asked.inset + asked.depth)
    opposite_faces(start, -normal, own, reach, cells_of(x), outward, room)
    return room


def _shift(asked: Sampling) -> float:
    """How far [m] below a face the first layer of one spacing begins."""
    return asked.inset - 0.5 * asked.spacing


def _layers(room: Array, asked: Sampling) -> tuple[Array, Array]:
    """Number (n,) of the samples in columns, and the thickness (n,) m that each stands for."""
    most = max(1, int(np.ceil(asked.depth / asked.spacing - 0.5 - ROUNDING)))
    half = 0.5 * room - _shift(asked)
    deep = half > (1.0 - ROUNDING) * most * asked.spacing
    half = np.where(deep, most * asked.spacing, half)
    layers = np.clip(np.rint(half / asked.spacing).astype(np.int64), 1, most)
    return layers, half / layers


def _own(
    place: Array, normal: Array, own: Array, depth: Array, thick: Array, outward: Array, x: Array
) -> Array:
    """Numbers of the samples that lie below their own faces, and not rather below others."""
    # Late as in `_columns`.
    from quintet.coupler.coupling.face_kernels import Rivals, nearest_faces

    count = len(place)
    rival, local, gap = np.zeros(count, np.int64), np.zeros((count, 2)), np.zeros(count)
    rivals = Rivals(normal, outward, SAME_WAY, float((depth + thick).max(initial=0.0)))
    nearest_faces(np.ascontiguousarray(place), cells_of(x), rivals, rival, local, gap)
    further = gap - depth > HALF * thick
    alike = np.abs(gap - depth) <= HALF * thick
    return np.flatnonzero(further | (alike & (own < rival)))
