"""Surfaces of triangles from files as walls: how deep a place lies behind one, and defects.

Imported only by a scene that has some. Places are compared with the triangles exactly; a tree of
small pieces of the triangles tells which of them are near.
"""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from quintet.components.shared.geometry import mesh_files
from quintet.components.sph_fluid.setup.boundary_meshes import BoundaryMesh
from quintet.interfaces.component import Array
from quintet.interfaces.rotation import matrix

Flags = NDArray[np.bool_]
Whole = NDArray[np.int64]
PIECE = 1.0  # spacings: longest edge of the pieces
CANDIDATES = 16  # pieces that are looked at for each place
CHUNK = 20000  # places that are looked at together
FAR = 1e6  # m, the depth of places that are far behind a surface; negative far before it
SAME = 1e-4  # of a spacing: distances and places that are the same; STL holds seven digits
ALONG = 0.9999  # cosine: what is behind an open rim and not beside it
OPPOSITE = -0.9  # cosine between faces of which one is the back of the other
RAYS = 400  # that measure thickness


class Triangles(NamedTuple):
    """A surface that is read and placed."""

    corner: Array  # (t, 3, 3) m, round the side at which the fluid is, anticlockwise
    volume: float  # m3 that a closed surface encloses; 0 of an open one
    rims: int  # edges that one triangle alone has


@lru_cache(maxsize=16)
def placed(mesh: BoundaryMesh) -> Triangles:
    """Read a surface and place it.

    Raises
    ------
    ValueError
        If it cannot be a wall: it has holes, overlaps itself, or is not turned consistently.
    """
    if mesh.surface == "closed":
        solid = mesh_files.read(mesh.path, mesh.scale or 1.0)
        corner, volume, rims = solid.triangles, solid.volume, 0
    else:
        corner, rims = _open_surface(mesh.path)
        corner, volume = (mesh.scale or 1.0) * corner, 0.0
    turn = matrix(np.array([mesh.orientation]))[0]
    corner = corner @ turn.T + np.array(mesh.origin or (0.0, 0.0, 0.0))
    if mesh.fluid_side == "back":
        corner = corner[:, ::-1]
    return Triangles(np.ascontiguousarray(corner), volume, rims)


def _open_surface(file: str) -> tuple[Array, int]:
    """Triangles (t, 3, 3) of an open surface, and its edges that one triangle alone has."""
    # Scenes without meshes do not import the reader of meshes.
    import trimesh

    name = Path(file).name
    try:
        mesh = trimesh.load_mesh(file)
        corner = np.asarray(mesh.triangles, np.float64)
        if not len(corner):
            raise ValueError("no triangles")
    except Exception as error:  # of any kind: each format has its own
        raise ValueError(
            f"file {name} must be a surface of triangles (STL, OBJ, PLY); reading it found "
            f"{type(error).__name__}: {error}. Convert it."
        ) from error
    _, count = np.unique(np.sort(mesh.edges, axis=1), axis=0, return_counts=True)
    if (count > 2).any():
        raise ValueError(
            f"file {name} must have one or two triangles at each edge; found "
            f"{int((count > 2).sum())} edges with more. Remove doubled triangles and inner walls."
        )
    if not mesh.is_winding_consistent:
        raise ValueError(
            f"file {name} must have triangles whose normals all point to the same side; found "
            "neighbours that do not. Turn them, as trimesh.repair.fix_normals can."
        )
    return corner, int((count == 1).sum())


class Surface:
    """How deep places lie behind a surface, for particles at a spacing.

    Parameters
    ----------
    mesh
        What the scene says.
    spacing : float, m
    reach : float, m
        Depth to which the fluid feels walls.
    dry : sequence of (axis, place [m])
        Planes of the tank's walls: triangles in these meet no fluid.
    """

    def __init__(
        self,
        mesh: BoundaryMesh,
        spacing: float,
        reach: float,
        dry: Sequence[tuple[int, float]] = (),
    ) -> None:
        self.mesh, self.triangles = mesh, placed(mesh)
        self.spacing, self.reach = spacing, reach + spacing
        corner, tolerance = self.triangles.corner, SAME * spacing
        is_dry = np.zeros(len(corner), bool)
        for axis, place in dry:
            is_dry |= (np.abs(corner[:, :, axis] - place) < tolerance).all(axis=1)
        self.corner, self.tolerance = corner[~is_dry], tolerance
        across = np.cross(
            self.corner[:, 1] - self.corner[:, 0], self.corner[:, 2] - self.corner[:, 0]
        )
        size = np.linalg.norm(across, axis=1)
        self.corner, across = self.corner[size > 0.0], across[size > 0.0]
        self.normal = across / np.linalg.norm(across, axis=1)[:, None]
        self.piece, self.owner = _pieces(self.corner, PIECE * spacing)
        self.tree = cKDTree(self.piece)
        self.rim = _rims(self.corner, self.triangles.rims, 1e-2 * tolerance)

    def depths(self, points: Array) -> tuple[Array, Array]:
        """Depths (n,) m of places (n, 3) m, negative before the surface, and normals (n, 3).

        A normal points to the nearest place of the surface. Where several faces are equally near,
        depth times the vector reaches all of them, so it may be longer than 1.
        """
        below, normal = np.empty(len(points)), np.zeros_like(points)
        distance, _ = self.tree.query(points, distance_upper_bound=self.reach + self.spacing)
        near_rows = np.flatnonzero(np.isfinite(distance))
        far_rows = np.flatnonzero(~np.isfinite(distance))
        below[far_rows] = self._far(points[far_rows])
        for begin in range(0, len(near_rows), CHUNK):
            rows = near_rows[begin : begin + CHUNK]
            below[rows], normal[rows] = self._near(points[rows])
        return below, normal

    def _far(self, points: Array) -> Array:
        """`FAR` behind a closed surface, and -`FAR` before it; of an open one always before."""
        if self.mesh.surface == "open":
            return np.full(len(points), -FAR)
        outwards = self.triangles.corner
        if self.mesh.fluid_side == "back":
            outwards = outwards[:, ::-1]
        is_inside = mesh_files.inside(points, outwards)
        return np.where(is_inside == (self.mesh.fluid_side == "front"), FAR, -FAR)

    def _near(self, points: Array) -> tuple[Array, Array]:
        # Scenes without meshes do not import the reader of meshes.
        from trimesh.triangles import closest_point

        count = min(CANDIDATES, len(self.piece))
        _, piece = self.tree.query(points, count)
        owner = self.owner[np.asarray(piece).reshape(len(points), count)]
        owner = np.sort(owner, axis=1)
        is_first = np.ones(owner.shape, bool)  # of the pieces of each face
        is_first[:, 1:] = owner[:, 1:] != owner[:, :-1]
        place, _ = np.nonzero(is_first)
        feet = np.full((*owner.shape, 3), np.inf)
        feet[is_first] = closest_point(self.corner[owner[is_first]], points[place])
        offset = points[:, None] - feet
        distance = np.linalg.norm(offset, axis=2)
        least = distance.min(axis=1)
        equal = distance <= least[:, None] + self.tolerance
        # Of faces that share the nearest edge the one that is seen least aslant tells the side.
        projection = np.zeros(owner.shape)
        projection[equal] = (offset[equal] * self.normal[owner[equal]]).sum(axis=1)
        column = np.abs(projection).argmax(axis=1)
        row = np.arange(len(points))
        face, side, to_foot = owner[row, column], projection[row, column], -offset[row, column]
        on_surface = least < self.tolerance
        below = np.where(side < 0.0, least, -least)
        outwards = np.where(side < 0.0, 1.0, -1.0)[:, None] * to_foot
        normal = outwards / np.maximum(least, self.tolerance)[:, None]
        normal[on_surface] = self.normal[face[on_surface]]
        is_other_place = (
            np.linalg.norm(offset - offset[row, column][:, None], axis=2) > 10.0 * self.tolerance
        )
        for k in np.flatnonzero((equal & is_other_place).any(axis=1) & ~on_surface):
            normal[k] = _to_all(-offset[k][equal[k]]) / least[k] * (1.0 if side[k] < 0.0 else -1.0)
        if self.triangles.rims:
            aslant = np.flatnonzero(np.abs(side) < ALONG * least)
            for candidate in range(count):
                rows = aslant[equal[aslant, candidate]]
                beside = self._on_rim(feet[rows, candidate], owner[rows, candidate])
                below[rows[beside]] = -FAR
        return below, normal

    def _on_rim(self, feet: Array, face: Whole) -> Flags:
        """Whether places (n, 3) m on faces (n,) lie on edges that one triangle alone has."""
        is_on_rim = np.zeros(len(feet), bool)
        for edge in range(3):
            begin, end = self.corner[face, edge], self.corner[face, (edge + 1) % 3]
            direction = (end - begin) / np.linalg.norm(end - begin, axis=1)[:, None]
            distance = np.linalg.norm(np.cross(feet - begin, direction), axis=1)
            is_on_rim |= self.rim[face, edge] & (distance < 10.0 * self.tolerance)
        return is_on_rim

    def thinnest(self) -> tuple[float, Array]:
        """Least thickness [m] of what is behind the surface, and where [m]; as rays find it."""
        chosen = np.unique(np.linspace(0, len(self.piece) - 1, RAYS).astype(int))
        start, face = self.piece[chosen], self.owner[chosen]
        least, thinnest_place = np.inf, start[0]
        a, b, c = self.triangles.corner.transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        for place, outwards in zip(start, self.normal[face], strict=True):
            facing = np.flatnonzero(normal @ outwards < OPPOSITE)
            distance = _along_ray(place, -outwards, self.triangles.corner[facing])
            distance = distance[distance > 100.0 * self.tolerance]
            if len(distance) and distance.min() < least:
                least, thinnest_place = float(distance.min()), place
        return least, thinnest_place


def _along_ray(place: Array, direction: Array, corner: Array) -> Array:
    """Distances (k,) m at which a ray meets triangles (t, 3, 3) m: Möller and Trumbore 1997."""
    edge_1, edge_2 = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    p = np.cross(direction, edge_2)
    determinant = (edge_1 * p).sum(axis=1)
    determinant = np.where(determinant == 0.0, np.nan, determinant)
    t = place - corner[:, 0]
    u = (t * p).sum(axis=1) / determinant
    q = np.cross(t, edge_1)
    v = (q @ direction) / determinant
    distance = (edge_2 * q).sum(axis=1) / determinant
    with np.errstate(invalid="ignore"):
        return distance[(u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)]


def _to_all(vectors: Array) -> Array:
    """Shortest way whose part along each of some ways (k, 3) m is that way's length."""
    length = np.linalg.norm(vectors, axis=1)
    inverse = np.linalg.pinv(vectors / length[:, None], rcond=1e-6)
    return np.asarray(inverse @ length)


def _pieces(corner: Array, longest: float) -> tuple[Array, Whole]:
    """Middles (p, 3) m of pieces of triangles (t, 3, 3) m, and the triangle of each."""
    owner, pieces, owners = np.arange(len(corner)), [], []
    while len(corner):
        edges = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
        is_small = edges.max(axis=1) <= longest
        pieces.append(corner[is_small])
        owners.append(owner[is_small])
        corner, owner, edges = corner[~is_small], owner[~is_small], edges[~is_small]
        longest_edge, row = edges.argmax(axis=1), np.arange(len(corner))
        begin, end, tip = (corner[row, (longest_edge + k) % 3] for k in range(3))
        middle = 0.5 * (begin + end)
        halves = [np.stack([begin, middle, tip], axis=1), np.stack([middle, end, tip], axis=1)]
        corner, owner = np.concatenate(halves), np.concatenate([owner, owner])
    order = np.argsort(np.concatenate(owners), kind="stable")
    return np.concatenate(pieces).mean(axis=1)[order], np.concatenate(owners)[order]


def _rims(corner: Array, rims: int, tolerance: float) -> Flags:
    """Which edges (t, 3) of triangles no other triangle has."""
    if not rims:
        return np.zeros((len(corner), 3), bool)
    _, number = np.unique(np.round(corner.reshape(-1, 3) / tolerance), axis=0, return_inverse=True)
    number = number.reshape(-1, 3)
    edge = np.sort(np.stack([number, np.roll(number, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, inverse, count = np.unique(edge, axis=0, return_inverse=True, return_counts=True)
    return np.asarray((count[inverse.reshape(-1)] == 1).reshape(-1, 3))
