"""Shapes of bodies that stand in files: closed surfaces of triangles, and arrays of voxels.

Surfaces are read by trimesh (STL, OBJ, PLY and others); voxels are an array in a .npy file, its
axes x, y, z, what is not zero being solid. Nothing is imported unless a scene names a file.
"""

import itertools
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array

AWRY = 1e-8  # of a shape's size
RAYS = 32  # along either axis across those that look for overlapping shells
MOST_WRONG = 1e-3  # of the length within a surface that is not enclosed once
PAIRS = ((1, 2), (2, 0), (0, 1))  # the corners opposite each corner


class Solid(NamedTuple):
    """A closed surface of triangles that look outwards, and what it encloses."""

    triangles: Array  # (t, 3, 3) m
    volume: float  # m3
    centre: Array  # (3,) m, of mass
    inertia: Array  # (3, 3) m5, about it, at unit density
    turned: bool = False  # whether all triangles of the file look inwards


def read(file: str, scale: float) -> Solid:
    """Read a shape; one unit of length in the file, or one voxel, stands for `scale` [m]."""
    path = Path(file)
    return voxels(path, scale) if path.suffix == ".npy" else surface(path, scale)


def surface(path: Path, scale: float) -> Solid:
    """Read a closed surface of triangles; trimesh measures it exactly."""
    # Scenes without meshes do not import the reader of meshes.
    import trimesh

    try:
        mesh = trimesh.load_mesh(path)
        corners = np.asarray(mesh.triangles, np.float64)
        if not len(corners):
            raise ValueError("no triangles")
    except Exception as error:  # of any kind: each format has its own
        raise ValueError(
            f"file {path.name} must be a surface of triangles (STL, OBJ, PLY) or an array of "
            f"voxels (.npy); reading it found {type(error).__name__}: {error}. Convert it."
        ) from error
    if not (mesh.is_watertight and mesh.is_winding_consistent):
        raise ValueError(f"file {path.name} {wrong_edges(mesh)}")
    looks_inwards = bool(mesh.volume < 0.0)
    if looks_inwards:
        mesh.invert()
    corners = np.asarray(mesh.triangles, np.float64)
    _require_simple(path.name, corners)
    return Solid(
        scale * corners,
        scale**3 * float(mesh.volume),
        scale * np.asarray(mesh.center_mass),
        scale**5 * np.asarray(mesh.moment_inertia),
        looks_inwards,
    )


def _require_simple(name: str, triangles: Array) -> None:
    """Refuse shells that overlap or are flipped: their volume and inertia would be wrong."""
    lengths = winding_lengths(triangles)
    enclosed = sum(lengths.values())
    twice = sum(length for number, length in lengths.items() if number > 1)
    reverse = sum(length for number, length in lengths.items() if number < 0)
    if not enclosed > 0.0:
        raise ValueError(f"file {name} must enclose a volume; it encloses none. Correct it.")
    if max(twice, reverse) > MOST_WRONG * enclosed:
        raise ValueError(
            f"file {name} must enclose each part of its volume once; found {twice / enclosed:.1%} "
            f"of it in several shells that overlap, and {reverse / enclosed:.1%} in shells that "
            "are inside out. Unite solids that overlap; normals of a solid's triangles point out "
            "of it, and those of a cavity's into the cavity."
        )


def winding_lengths(triangles: Array) -> dict[int, float]:
    """Length within a closed surface (t, 3, 3), by how often it is enclosed, along some rays.

    What is enclosed once lies in one shell whose triangles look outwards, more often where shells
    overlap, and a negative number of times in a shell that is inside out.
    """
    low, high = triangles[:, :, 1:].min(axis=1), triangles[:, :, 1:].max(axis=1)
    lowest, highest = low.min(axis=0), high.max(axis=0)
    # Irrational offsets, so that no ray meets an edge of a regular mesh.
    lines = (np.arange(RAYS)[:, None] + np.sqrt([0.2, 0.3])) / RAYS * (highest - lowest) + lowest
    lengths: dict[int, float] = {}
    for y, z in itertools.product(*lines.T):
        place = np.array([y, z])
        met = triangles[((low <= place) & (place <= high)).all(axis=1)]
        x, outwards = _crossings(met, place)
        order = np.argsort(x)
        depth = np.cumsum(-outwards[order])[:-1]
        for number, length in zip(depth.tolist(), np.diff(x[order]).tolist(), strict=True):
            if number:
                lengths[int(number)] = lengths.get(int(number), 0.0) + length
    return lengths


def _crossings(triangles: Array, place: Array) -> tuple[Array, Array]:
    """Where a ray along x at y and z (2,) meets triangles, and 1 where it leaves, -1 it enters."""
    y, z = (triangles[:, :, 1:] - place).transpose(2, 0, 1)
    part = np.column_stack([y[:, i] * z[:, j] - z[:, i] * y[:, j] for i, j in PAIRS])
    whole = part.sum(axis=1)
    through = (part * whole[:, None] > 0.0).all(axis=1)
    x = (triangles[through, :, 0] * part[through]).sum(axis=1) / whole[through]
    return x, np.sign(whole[through])


def wrong_edges(mesh: Any) -> str:
    """Say which edges have no two triangles, or two with inconsistent orientation."""
    edges = np.asarray(mesh.edges, np.int64)
    _, first, number = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_inverse=True
    )
    number, way = number.reshape(-1), np.sign(edges[:, 1] - edges[:, 0])
    triangles = np.bincount(number)  # of each edge
    kinds = (
        (
            triangles == 1,
            "be a closed surface, each edge of two triangles",
            "with only one triangle",
            "Close it, as trimesh.repair.fill_holes can",
        ),
        (
            triangles > 2,
            "have edges of two triangles each",
            "with more than two triangles",
            "Separate the shells that touch there by a gap, or unite them",
        ),
        (
            np.bincount(number, way) != 0.0,
            "have triangles that all look outwards",
            "between faces with inconsistent orientation",
            "Turn some, as trimesh.repair.fix_normals can",
        ),
    )
    for is_wrong, rule, which, remedy in kinds:
        wrong = first[is_wrong]
        if len(wrong):
            middle = np.asarray(mesh.vertices)[edges[wrong[0]]].mean(axis=0)
            place = ", ".join(f"{x:.4g}" for x in middle)
            count = "1 edge" if len(wrong) == 1 else f"{len(wrong)} edges"
            return (
                f"must {rule}; found {count} {which}, among {len(mesh.faces)} triangles, as at "
                f"({place}) in the unit of the file. {remedy}."
            )
    return "must be a closed surface of triangles that all look outwards. Correct it."


def voxels(path: Path, width: float) -> Solid:
    """Read voxels of a width [m]; their sides towards what is not solid are the surface."""
    array = _voxel_array(path)
    solid = np.pad(array != 0, 1)
    squares = [
        sides(np.argwhere(solid & ~np.roll(solid, 1 - 2 * side, axis=axis)) - 1, axis, side)
        for axis in range(3)
        for side in (0, 1)
    ]
    corners = width * np.concatenate(squares).astype(np.float64)
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    middles, volume = width * (np.argwhere(array) + 0.5), width**3 * np.count_nonzero(array)
    centre = middles.mean(axis=0)
    second = (middles - centre).T @ (middles - centre) * width**3
    second = second + np.eye(3) * (width**2 / 12.0 * volume)  # of each about its own middle
    return Solid(triangles, volume, centre, np.trace(second) * np.eye(3) - second)


def _voxel_array(path: Path) -> Array:
    """Read an array of three axes, not all zero."""
    try:
        array = np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise ValueError(
            f"file {path.name} must be one array: {error}. Write it by numpy.save."
        ) from error
    if getattr(array, "ndim", 0) != 3 or array.dtype.kind not in "biuf" or not array.any():
        raise ValueError(
            f"file {path.name} must have three axes of numbers, of which not all are zero; found "
            f"shape {getattr(array, 'shape', None)}. Write it by numpy.save."
        )
    if wrong := int((~np.isfinite(array)).sum()):
        raise ValueError(
            f"file {path.name} must have finite numbers, 0 outside of the solid; found {wrong} of "
            f"{array.size} that are not. Write 0 in their place."
        )
    return np.asarray(array)


def sides(cells: Array, axis: int, side: int) -> Array:
    """Corners (n, 4, 3) of one side of each cell, turned so that it looks outwards."""
    ring = np.zeros((4, 3), np.int64)
    ring[:, (axis + 1) % 3] = [0, 1, 1, 0]
    ring[:, (axis + 2) % 3] = [0, 0, 1, 1]
    ring[:, axis] = side
    return cells[:, None] + (ring if side else ring[::-1])


def inside(points: Array, triangles: Array) -> NDArray[np.bool_]:
    """Whether points (n, 3) lie in a surface: a ray along x leaves it once more than it enters.

    Points with the same y and z share a ray.
    """
    low, high = triangles[:, :, 1:].min(axis=1), triangles[:, :, 1:].max(axis=1)
    # A little off the lattice, so that no ray meets an edge.
    aside = AWRY * float(np.ptp(triangles, axis=(0, 1)).max()) * np.sqrt([2.0, 3.0])
    contained = np.zeros(len(points), bool)
    order = np.lexsort(points.T[1:])
    starts = np.flatnonzero((np.diff(points[order, 1:], axis=0) != 0.0).any(axis=1)) + 1
    for rows in np.split(order, starts) if len(order) else ():
        place = points[rows[0], 1:] + aside
        met = triangles[((low <= place) & (place <= high)).all(axis=1)]
        x, outwards = _crossings(met, place)
        contained[rows] = ((x > points[rows, :1]) * outwards).sum(axis=1) > 0.0
    return contained


def nearest(points: Array, triangles: Array) -> Array:
    """Nearest point (n, 3) of a surface to each point."""
    # Scenes without meshes do not import the reader of meshes.
    from trimesh.triangles import closest_point

    middle = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
    feet = np.empty_like(points)
    for k, point in enumerate(points):
        distance = np.linalg.norm(middle - point, axis=1)
        near = triangles[
            distance - radius <= distance.min()
        ]  # no other can be nearer than a middle
        all_near = closest_point(near, np.broadcast_to(point, (len(near), 3)))
        feet[k] = all_near[np.argmin(((all_near - point) ** 2).sum(axis=1))]
    return feet
