"""Samples of any closed body: layers of equal thickness below its surface.

Cells of a lattice whose centres lie in the body are its samples. Each is moved along its normal to
the middle of the layer in which it lies, so that the outermost are equally deep everywhere, and
stands for an equal share of the body's volume.
"""

from collections.abc import Callable

import numpy as np

from quintet.interfaces.component import Array

CLOSE = 0.5  # spacings: samples of one place, of which one stands for all
# Points (n, 3) m -> how deep (n,) m they lie in the body, negative outside, and outward normals.
Depths = Callable[[Array], tuple[Array, Array]]
Samples = tuple[Array, Array, Array, Array]  # arm, normal, volume, image


def fill_closed(
    depths: Depths,
    low: Array,
    high: Array,
    volume: float,
    spacing: float,
    depth: float,
    less: float,
) -> tuple[Samples, float]:
    """Sample a closed body, to a depth below its surface.

    Parameters
    ----------
    depths : function
        Of points in the body's frame.
    low, high : (3,) float arrays, m
        Corners of the box that holds the body.
    volume : float, m3
        Of the body.
    spacing, depth : float, m
        Distance of samples; how far below the outermost they reach.
    less : float, m
        By how much deeper than half a spacing the outermost samples lie; what is less deep is
        left out.

    Returns
    -------
    samples, and the depth [m] of the deepest lattice place: about half the body's width
    """
    beyond = max(-less, 0.0)
    low, high = low - beyond, high + beyond
    count = np.maximum(np.ceil((high - low) / spacing).astype(int), 1)
    axes = [
        0.5 * (a + b) + (np.arange(n) - 0.5 * (n - 1)) * spacing
        for a, b, n in zip(low, high, count, strict=True)
    ]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    below, normal = depths(points)
    inside, filled = int((below > 0.0).sum()), below > less
    points, below, normal = points[filled], below[filled], normal[filled]
    if not inside or not len(points):
        nothing = np.zeros((0, 3))
        return (nothing, nothing, np.zeros(0), nothing), 0.0
    widest, share = float(below.max()), volume / inside
    near = below < less + depth + spacing
    points, below, normal = points[near], below[near], normal[near]
    wanted = less + (np.floor((below - less) / spacing) + 0.5) * spacing
    moved = points + (below - wanted)[:, None] * normal
    reached, turned = depths(moved)
    # At creases a move may lead past the nearest part of the surface: such points stay.
    sound = np.abs(reached - wanted) < 0.25 * spacing
    arm = np.where(sound[:, None], moved, points)
    below, normal = np.where(sound, reached, below), np.where(sound[:, None], turned, normal)
    parts = np.full(len(arm), share)
    keep = _apart(arm, parts, CLOSE * spacing)
    keep = keep[below[keep] < depth + less]
    image = arm + 2.0 * below[:, None] * normal
    return (arm[keep], normal[keep], parts[keep], image[keep]), widest


def _apart(points: Array, volume: Array, close: float) -> Array:
    """Numbers of points that are kept; those too near to one give it their volume."""
    # Left out of scenes without such bodies.
    from scipy.spatial import cKDTree

    kept = np.ones(len(points), bool)
    for i, j in sorted(cKDTree(points).query_pairs(close)):
        if kept[i] and kept[j]:
            kept[j] = False
            volume[i] += volume[j]
    return np.flatnonzero(kept)


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
