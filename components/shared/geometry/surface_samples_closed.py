"""Samples of any closed body: layers of equal thickness below its surface.

Cells of a lattice whose centres lie in the body are its samples. Each is moved along its normal to
the middle of the layer in which it lies, so that the outermost are equally deep everywhere, and
stands for an equal share of the body's volume.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

CLOSE = 0.5  # spacings: samples of one place, of which one stands for all
FINER = 0.01  # by which the pitch of the lattice shrinks until there are enough samples
TRIES = 12
MOST = 1e8  # places of a lattice: 2.4 GB
ROUNDING = 1e-9
# Points (n, 3) m -> how deep (n,) m they lie in the body, negative outside, and outward normals.
Depths = Callable[[Array], tuple[Array, Array]]
Samples = tuple[Array, Array, Array, Array]  # arm, normal, volume, image


class Body(NamedTuple):
    """A closed body in its own frame."""

    depths: Depths
    low: Array  # (3,) m, corners of the box that holds it; of no extent along y: a slice 1 m deep
    high: Array
    volume: float  # m3

    @property
    def dimensions(self) -> int:
        """Along how many axes it extends."""
        return int((self.high > self.low).sum())


class Layers(NamedTuple):
    """Samples of a whole body."""

    arm: Array  # (n, 3) m
    below: Array  # (n,) m, their depths
    normal: Array  # (n, 3)
    filled: float  # share of the body
    deepest: float  # m, of the lattice that they come from: about half the body's width


def fill_closed(body: Body, spacing: float, depth: float, less: float) -> tuple[Samples, float]:
    """Sample a closed body, to a depth below its surface.

    Each sample acts as a particle of the fluid, which finds the body as large as their cubes
    together: the lattice is made finer until they are as many as the body holds, or some more, of
    which those nearest to others are left out.

    Parameters
    ----------
    body : Body
    spacing, depth : float, m
        Distance of samples; how far below the outermost they reach.
    less : float, m
        By how much deeper than half a spacing the outermost samples lie; what is less deep is
        left out.

    Returns
    -------
    samples, and the depth [m] of the deepest lattice place: about half the body's width
    """
    layers, wanted = _layers(body, spacing, spacing, less), body.volume / spacing**body.dimensions
    excess = len(layers.arm) / max(wanted * layers.filled, 1.0)
    pitch = spacing * max(1.0, excess ** (1.0 / body.dimensions))
    for _ in range(TRIES):
        if pitch != spacing:
            layers = _layers(body, spacing, pitch, less)
        if len(layers.arm) >= round(wanted * layers.filled):
            break
        pitch *= 1.0 - FINER
    rows = _most_apart(layers.arm, round(wanted * layers.filled))
    volume = body.volume * layers.filled / max(len(rows), 1)
    rows = rows[layers.below[rows] < depth + less]
    arm, normal = layers.arm[rows], layers.normal[rows]
    image = arm + 2.0 * layers.below[rows, None] * normal
    return (arm, normal, np.full(len(arm), volume), image), layers.deepest


def _layers(body: Body, spacing: float, pitch: float, less: float) -> Layers:
    """Layers one spacing thick, of the places that a lattice with a pitch [m] has in a body."""
    points = _lattice(body, pitch, max(-less, 0.0))
    below, normal = body.depths(points)
    inside, filled = int((below > 0.0).sum()), below > less
    points, below, normal = points[filled], below[filled], normal[filled]
    if not inside or not len(points):
        return Layers(points[:0], below[:0], normal[:0], 0.0, 0.0)
    deepest = float(below.max())
    wanted = less + (np.floor((below - less) / spacing) + 0.5) * spacing
    moved = points + (below - wanted)[:, None] * normal
    reached, turned = body.depths(moved)
    # At creases a move may lead past the nearest part of the surface: such points stay.
    sound = np.abs(reached - wanted) < 0.25 * spacing
    arm = np.where(sound[:, None], moved, points)
    below, normal = np.where(sound, reached, below), np.where(sound[:, None], turned, normal)
    keep = _apart(arm, CLOSE * spacing)
    return Layers(arm[keep], below[keep], normal[keep], len(points) / inside, deepest)


def _lattice(body: Body, pitch: float, beyond: float = 0.0) -> Array:
    """Places (n, 3) m about the middle of a body and so far [m] beyond it."""
    around = np.where(body.high > body.low, beyond, 0.0)
    low, high = body.low - around, body.high + around
    count = np.maximum(np.ceil((high - low) / pitch - ROUNDING).astype(int), 1)
    if np.prod(count, dtype=float) > MOST:
        edges = " x ".join(f"{edge:.4g}" for edge in body.high - body.low)
        raise SceneError(
            f"a body must have at most {MOST:.0e} places for samples; found "
            f"{np.prod(count, dtype=float):.2g} of one of {edges} m, {pitch:.4g} m apart. Correct "
            "its size or scale, or the spacing of its partner."
        )
    axes = [
        0.5 * (a + b) + (np.arange(n) - 0.5 * (n - 1)) * pitch
        for a, b, n in zip(low, high, count, strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _apart(points: Array, close: float) -> Array:
    """Numbers of points that are kept: of those too near to each other the first."""
    # Left out of scenes without such bodies.
    from scipy.spatial import cKDTree

    stays = np.ones(len(points), bool)
    for i, j in sorted(cKDTree(points).query_pairs(close)):
        if stays[i] and stays[j]:
            stays[j] = False
    return np.flatnonzero(stays)


def _most_apart(points: Array, most: int) -> Array:
    """Numbers of so many points; left out are those nearest to others."""
    # Left out of scenes without such bodies.
    from scipy.spatial import cKDTree

    surplus, stays = len(points) - most, np.ones(len(points), bool)
    if surplus <= 0:
        return np.flatnonzero(stays)
    distance, nearest = cKDTree(points).query(points, 2)
    for i in np.argsort(distance[:, 1], kind="stable"):
        if surplus and stays[nearest[i, 1]]:
            stays[i] = False
            surplus -= 1
    return np.flatnonzero(stays)


def depths_in_spheres(centres: Array, radii: Array) -> Depths:
    """Depths in a union of spheres (k, 3) m, (k,) m: those below the sphere that holds most."""

    def depths(points: Array) -> tuple[Array, Array]:
        away = points[:, None] - centres
        distance = np.linalg.norm(away, axis=2)
        nearest = (radii - distance).argmax(axis=1)
        rows = np.arange(len(points))
        length = distance[rows, nearest]
        normal = away[rows, nearest] / np.maximum(length, 1e-300)[:, None]
        normal[length < 1e-12 * radii[nearest]] = (0.0, 0.0, 1.0)
        return radii[nearest] - length, normal

    return depths


def depths_in_mesh(triangles: Array) -> Depths:
    """Depths in a closed surface of triangles (t, 3, 3) m that look outwards."""
    # Left out of scenes without meshes.
    from quintet.components.shared.geometry.mesh_files import inside, nearest

    def depths(points: Array) -> tuple[Array, Array]:
        out = points - nearest(points, triangles)
        distance = np.linalg.norm(out, axis=1)
        within = inside(points, triangles)
        normal = out / np.maximum(distance, 1e-300)[:, None]
        return np.where(within, distance, -distance), np.where(within[:, None], -normal, normal)

    return depths
