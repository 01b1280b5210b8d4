"""Samples below the faces of a mesh that deforms, as a fluid asks for them."""

from dataclasses import dataclass

import numpy as np

from quintet.components.shared.geometry.face_projection import (
    at_points,
    bilinear,
    cells_of,
    corners,
    derivatives,
    project,
)
from quintet.components.shared.geometry.surface_samples import Sampling, sampling_of
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError

# Half of the metre along y that edges stand for, turned so that normals point out of the body.
PLANAR_SIDE = np.array([0.0, -0.5, 0.0])  # m
HALF = 0.5  # of a layer's thickness: a sample nearer by so much to another face is that one's
SAME_WAY = 0.7  # cosine of the angle between faces that go on from one another
ROUNDING = 1e-9
SAMPLES = ("node", "weight", "along", "across", "depth", "side", "normal", "volume")
PROJECTED = ("node", "weight", "face", "gap", "size", "beyond")


def mesh_answer(port: str, request: Fields, static: Fields) -> dict[str, Array]:
    """Samples below the faces of a mesh; or, of given points, where on its faces they hang.

    Parameters
    ----------
    port : str
        Through which the mesh is given.
    request : mapping of arrays
        As `Component.sample` gets it.
    static : mapping of arrays
        What the component describes: where nodes start, the corners of faces.
    """
    position, face = static[f"{port}.start"], static[f"{port}.corner"]
    if (points := request.get(f"{port}.points")) is not None:
        projection = project(points, position, face)
        return {
            f"{port}.{name}": np.asarray(getattr(projection, name), float) for name in PROJECTED
        }
    sampling = sampling_of(port, request)
    if sampling.planar != (static.get(f"{port}.dimensions", [3.0])[0] == 2.0):
        raise SceneError(
            "a mesh and its partner must have two dimensions or both three. Set dimensions = 2 in "
            "both, or 3 in both."
        )
    samples = sample_faces(position, face, sampling)
    if samples.room < sampling.least * (1.0 - ROUNDING):
        raise SceneError(
            f"a body must be at least {sampling.least:g} m thick between its faces to be sampled: "
            "a spacing of its partner, and twice the depth of the outermost samples that it asks "
            f"for; behind face {samples.thin} it is {samples.room:g} m. Refine the partner's "
            "spacing, or leave one of its sides out of its coupled faces."
        )
    return {f"{port}.{name}": np.asarray(getattr(samples, name), float) for name in SAMPLES}


@dataclass(frozen=True, slots=True)
class FaceSamples:
    """Samples of the faces of a mesh: points below it, along its normal as it moves.

    A sample lies at x(ξ, η) - d n, with n = t × s / |t × s| of the tangents t = ∂x/∂ξ, s = ∂x/∂η.
    """

    node: Array  # (n, 4) corners of the face of each sample
    weight: Array  # (n, 4) 1, shape functions at its foot
    along: Array  # (n, 4) 1, their derivatives by ξ
    across: Array  # (n, 4) 1, and by η
    depth: Array  # (n,) m below the face
    side: Array  # (n, 3) m, added to s: half of the depth along y where faces are edges, else none
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
    side: Array  # (3,) m

    def places(self, position: Array) -> tuple[Array, Array]:
        """Middles (n, 3) m, and t × s (n, 3) m2 there."""
        weight, corner = bilinear(*self.local.T), position[self.node]
        along, across = (at_points(slope, corner) for slope in derivatives(*self.local.T))
        return at_points(weight, corner), np.cross(along, across + self.side)


def sample_faces(position: Array, face: Array, sampling: Sampling) -> FaceSamples:
    """Sample the body below the faces (m, 4) of a mesh with its nodes at (nodes, 3) m.

    Each face is cut into cells of about the spacing, with a column of samples below the middle of
    each. Where faces that look the other way lie behind it, the columns of both sides meet in the
    middle between them; a sample that lies deeper below its own face than below another is left
    to that one, as at the edges of a body.
    """
    columns = _columns(position, face, sampling)
    start, across = columns.places(position)
    length = np.linalg.norm(across, axis=1)
    normal = across / length[:, None]
    outward = _face_normals(position, face, columns.side)
    x = np.ascontiguousarray(position[corners(face)])
    room = _room(start, normal, columns.face, outward, x, sampling)
    layers, thickness = _layers(room, sampling)
    rows = np.repeat(np.arange(len(start)), layers)
    number = np.arange(len(rows)) - np.repeat(np.cumsum(layers) - layers, layers)
    thick = thickness[rows]
    depth = np.maximum(_shift(sampling) + (number + 0.5) * thick, 0.0)
    place = start[rows] - depth[:, None] * normal[rows]
    below = _own(place, normal[rows], columns.face[rows], depth, thick, outward, x)
    volume = (columns.share * length)[rows] * thick
    least, rows = int(np.argmin(room)), rows[below]
    local = columns.local[rows].T
    return FaceSamples(
        columns.node[rows],
        bilinear(*local),
        *derivatives(*local),
        depth[below],
        np.tile(columns.side, (len(rows), 1)),
        normal[rows],
        volume[below],
        float(room[least]),
        int(columns.face[least]),
    )


def _columns(position: Array, face: Array, sampling: Sampling) -> Columns:
    # Kernels, and numba with them, are left out of reading scenes, and of those without meshes.
    from quintet.components.shared.geometry.face_kernels import write_columns

    corner = corners(face)
    x = position[corner]
    edge = np.linalg.norm(x - np.roll(x, -1, axis=1), axis=2)  # (m, 4) m: ab, bc, cd, da
    sides = np.stack([edge[:, [0, 2]].max(axis=1), edge[:, [1, 3]].max(axis=1)], axis=1)
    count = np.maximum(np.rint(sides / sampling.spacing).astype(np.int64), 1)
    if sampling.planar:
        count[:, 1] = 1
    total = int(count.prod(axis=1).sum())
    owner, local, share = np.zeros(total, np.int64), np.zeros((total, 2)), np.zeros(total)
    write_columns(count, owner, local, share)
    side = PLANAR_SIDE if sampling.planar else np.zeros(3)
    return Columns(corner[owner], owner, local, share, side)


def _face_normals(position: Array, face: Array, side: Array) -> Array:
    """Outward normals (m, 3) at the middles of faces."""
    corner, count = corners(face), len(face)
    middles = Columns(corner, np.arange(count), np.zeros((count, 2)), np.zeros(count), side)
    across = middles.places(position)[1]
    return np.asarray(across / np.linalg.norm(across, axis=1)[:, None])


def _room(
    start: Array, normal: Array, face: Array, outward: Array, x: Array, sampling: Sampling
) -> Array:
    """How far (n,) m it is from columns to where the body ends behind them; ∞ if that is far."""
    # Late as in `_columns`.
    from quintet.components.shared.geometry.face_kernels import opposite_faces

    room, reach = np.full(len(start), np.inf), 2.0 * (sampling.inset + sampling.depth)
    opposite_faces(start, -normal, face, reach, cells_of(x), outward, room)
    return room


def _shift(sampling: Sampling) -> float:
    """How far [m] below a face the first layer of one spacing begins."""
    return sampling.inset - 0.5 * sampling.spacing


def _layers(room: Array, sampling: Sampling) -> tuple[Array, Array]:
    """Number (n,) of the samples in columns, and the thickness (n,) m that each stands for."""
    most = max(1, int(np.ceil(sampling.depth / sampling.spacing - 0.5 - ROUNDING)))
    half = 0.5 * room - _shift(sampling)
    deep = half > (1.0 - ROUNDING) * most * sampling.spacing
    half = np.where(deep, most * sampling.spacing, half)
    layers = np.clip(np.rint(half / sampling.spacing).astype(np.int64), 1, most)
    return layers, half / layers


def _own(
    place: Array, normal: Array, face: Array, depth: Array, thick: Array, outward: Array, x: Array
) -> Array:
    """Numbers of the samples that lie below their own faces, and not rather below others."""
    # Late as in `_columns`.
    from quintet.components.shared.geometry.face_kernels import Rivals, nearest_faces

    count = len(place)
    rival, local, gap = np.zeros(count, np.int64), np.zeros((count, 2)), np.zeros(count)
    rivals = Rivals(normal, outward, SAME_WAY, float((depth + thick).max(initial=0.0)))
    nearest_faces(np.ascontiguousarray(place), cells_of(x), rivals, rival, local, gap)
    further = gap - depth > HALF * thick
    alike = np.abs(gap - depth) <= HALF * thick
    return np.flatnonzero(further | (alike & (face < rival)))
