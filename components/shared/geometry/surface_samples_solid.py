"""Samples of boxes and spheres: lattices and shells, at the spacing that is asked for."""

import math
from itertools import pairwise

import numpy as np

from quintet.interfaces.component import Array

# Shares of the cubes in a shell that its samples are, tried one after the other; 1 first.
SHELL_FACTORS = (1.0, *(1.0 + sign * 0.005 * k for k in range(1, 17) for sign in (1, -1)))


def fill_box(
    size: Array, spacing: float, depth: float, inset: float | None = None
) -> tuple[Array, Array, Array]:
    """Sample a box on a lattice, to a depth below its surface.

    Parameters
    ----------
    size : (3,) float array, m
        Edges.
    spacing, depth : float, m
        Distance of samples; how far below the outermost they reach (deeper ones act on nothing).
    inset : float, m
        How far below the surface the outermost samples lie; half a spacing if not given.

    Returns
    -------
    arm (n, 3) m from the centre, outward normal (n, 3), volume (n,) m3
    """
    return box_lattice(size - _less(spacing, inset), spacing, depth)


def fill_sphere(
    diameter: float, spacing: float, depth: float, inset: float | None = None
) -> tuple[Array, Array, Array]:
    """Sample a sphere [m] by shells, as `fill_box` does a box."""
    diameter -= _less(spacing, inset)
    radius, cubes = 0.5 * diameter, math.pi / 6 * (diameter / spacing) ** 3
    # Water finds the body as large as its samples' cubes together: their number must be right.
    tries = [_rings(radius, spacing, factor) for factor in SHELL_FACTORS]
    rings = min(tries, key=lambda shells: abs(sum(count for _, _, count in shells) - cubes))
    points = np.concatenate([_ring(*ring, 0.5 * (k % 2)) for k, ring in enumerate(rings)])
    distance = np.linalg.norm(points, axis=1)
    keep = radius - distance < depth
    normal = points[keep] / np.maximum(distance[keep], 1e-12 * radius)[:, None]
    normal[~normal.any(axis=1)] = (0.0, 0.0, 1.0)
    volume = math.pi / 6 * diameter**3 / len(points)
    return points[keep], normal, np.full(int(keep.sum()), volume)


def _less(spacing: float, inset: float | None) -> float:
    """By how much [m] a body is smaller whose outermost samples lie half a spacing deep."""
    return 0.0 if inset is None else 2.0 * (inset - 0.5 * spacing)


def box_lattice(
    size: Array, spacing: float, depth: float, planar: bool = False
) -> tuple[Array, Array, Array]:
    """Arms, normals and volumes on a lattice whose cells divide a box; `planar`: one along y."""
    cells = np.maximum(1, np.rint(size / spacing)).astype(int)
    if planar:
        cells[1] = 1
    step = size / cells
    axes = [(np.arange(n) - 0.5 * (n - 1)) * s for n, s in zip(cells, step, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    below = 0.5 * size - np.abs(points)  # distance to the faces of each axis
    if planar:
        below[:, 1] = np.inf
    near = below.min(axis=1)
    keep = near < depth
    # On edges and corners the normal points between the faces, as a mirror there needs it.
    nearest = below <= (near * (1 + 1e-9))[:, None] + 1e-9 * step.max()
    normal = np.where(nearest, np.sign(points), 0.0)[keep]
    # The cell at the centre of an odd count has no side; any normal serves that deep.
    normal[~normal.any(axis=1)] = (0.0, 0.0, 1.0)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return points[keep], normal, np.full(int(keep.sum()), float(step.prod()))


def _rings(radius: float, spacing: float, factor: float) -> list[tuple[float, float, int]]:
    """Rings of a sphere's shells: distance from its axis [m], height [m], number of points.

    A shell has about as many as it holds cubes of the spacing. On a lattice the outermost would
    lie at all depths down to a spacing, and the sphere be larger than it is.
    """
    edges = [*np.arange(radius, 0.0, -spacing).tolist(), 0.0]
    rings: list[tuple[float, float, int]] = []
    for outer, inner in pairwise(edges):
        count = factor * 4.0 * math.pi / 3.0 * (outer**3 - inner**3) / spacing**3
        if count < 1.5:
            rings.append((0.0, 0.0, 1))
            continue
        middle = 0.5 * (outer + inner)
        bands = max(2, round(math.pi * middle / spacing))
        for k in range(bands):
            top, bottom = (math.cos(math.pi * (k + end) / bands) for end in (0, 1))
            angle = math.pi * (k + 0.5) / bands
            some = max(2, round(0.5 * (top - bottom) * count))
            rings.append((middle * math.sin(angle), middle * math.cos(angle), some))
    return rings


def _ring(aside: float, height: float, count: int, turn: float) -> Array:
    angle = 2.0 * math.pi * (np.arange(count) + turn) / count
    x, y = aside * np.cos(angle), aside * np.sin(angle)
    return np.stack([x, y, np.full(count, height)], axis=1)


def sphere_images(diameter: float, arm: Array, normal: Array) -> Array:
    """Images (n, 3) m of samples of a sphere or disc, mirrored in its surface."""
    below = 0.5 * diameter - np.linalg.norm(arm, axis=1)
    return np.asarray(arm + 2.0 * below[:, None] * normal)


def box_images(size: Array, arm: Array, normal: Array) -> Array:
    """Images (n, 3) m of samples of a box, mirrored in its surface."""
    # On edges and corners the nearest surface point is as far along each of the faces' normals.
    below = (0.5 * size - np.abs(arm)).min(axis=1) * np.sqrt((normal != 0.0).sum(axis=1))
    return np.asarray(arm + 2.0 * below[:, None] * normal)
